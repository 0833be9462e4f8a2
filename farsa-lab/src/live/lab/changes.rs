//! Changes that a request asks of the folder. Each runs the command, or replaces or moves one file.

use std::fs;
use std::io::Write as _;

use hyper::body::Bytes;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::json;

use crate::live::lab::calls::{Bench, JSON, Reply};
use crate::live::lab::command_line::{
    ExportRequest, KeepRequest, KeptKind, PageRequest, ResumeRequest, RunRequest, TestRequest, about, continued,
};
use crate::live::lab::folder::{EXPORTS, PAGES, RUNS};
use crate::live::lab::names::{Refusal, file_name, name};
use crate::live::lab::queue::{Job, Kind};
use crate::run::laboratory::MAX_BYTES;
use crate::store::bounded::read_regular_text;
use crate::store::lock::Lock;
use crate::store::replace::replace;

/// Text of an experiment file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct TextRequest {
    name: String,
    text: String,
    /// Text that the page has edited. It is absent for a check.
    before: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct NewRequest {
    name: String,
    template: String,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct StopRequest {
    run: String,
}

/// Request to move something to the trash.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
enum TrashRequest {
    #[serde(rename = "run")]
    Run(String),
    #[serde(rename = "file")]
    File(String),
}

/// Parses the body of a request.
fn parsed<T: DeserializeOwned>(body: &Bytes) -> Result<T, Refusal> {
    serde_json::from_slice(body).map_err(|error| Refusal::invalid(format!("the body: {error}")))
}

impl Bench {
    /// Makes a change.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn change(&self, path: &str, body: &Bytes) -> Result<Reply, Refusal> {
        match path {
            "/api/new" => self.new_file(&parsed(body)?),
            "/api/save" => self.save(&parsed(body)?),
            "/api/run" => self.start_runs(&parsed(body)?),
            "/api/resume" => self.resume(&parsed(body)?),
            "/api/test" => self.test_champion(&parsed(body)?),
            "/api/stop" => self.stop(&parsed(body)?),
            "/api/page" => self.page(&parsed(body)?),
            "/api/export" => self.export(&parsed(body)?),
            "/api/keep" => self.keep(&parsed(body)?),
            "/api/trash" => self.trash(parsed(body)?),
            _ => Err(Refusal::new(404, "no such change")),
        }
    }

    /// Checks a text in place of the file of its name.
    ///
    /// # Errors
    /// [`Refusal`] with the errors of the text.
    pub(super) fn check(&self, body: &Bytes) -> Result<Reply, Refusal> {
        let TextRequest { name, text, .. } = parsed(body)?;
        self.printed(&about("check", file_name(&name)?, None, None, &["--stdin", "--json"])?, Some(&text), JSON)
    }

    fn new_file(&self, NewRequest { name: file, template }: &NewRequest) -> Result<Reply, Refusal> {
        let stem = name(file.strip_suffix(".toml").unwrap_or(file))?;
        let file = format!("{stem}.toml");
        self.folder.place(&[&file])?;
        let words = ["new", stem, "--from", name(template)?].map(str::to_owned);
        self.program.output(&words, None)?;
        Reply::json(&json!({ "name": file, "command": self.line(&words) }))
    }

    /// Replaces an experiment file, if its text is still the one that was edited.
    fn save(&self, TextRequest { name, text, before }: &TextRequest) -> Result<Reply, Refusal> {
        let path = self.folder.experiment(name)?;
        if text.len() as u64 > MAX_BYTES {
            return Err(Refusal::invalid(format!("the text has more than {MAX_BYTES} bytes")));
        }
        let now = read_regular_text(&path, MAX_BYTES).map_err(|error| Refusal::new(422, error))?;
        if before.as_ref().is_none_or(|before| *before != now) {
            return Err(Refusal::conflict(format!("{name} was changed by another program: reload it before you save")));
        }
        replace(&path, text.as_bytes()).map_err(|error| Refusal::new(500, error))?;
        Reply::json(&json!({ "name": name }))
    }

    fn start_runs(&self, request: &RunRequest) -> Result<Reply, Refusal> {
        request.check()?;
        self.folder.no_link(&request.experiment)?;
        self.folder.made(&[RUNS])?;
        let mut planned = Vec::new();
        for &seed in &request.seeds {
            let run = self.unused(&request.run(seed)?)?;
            planned.push((request.words(seed, &run)?, run));
        }
        let mut jobs = Vec::new();
        for (words, run) in planned {
            jobs.push(self.queue.add(Kind::Run, &run, words)?);
        }
        self.started(&jobs)
    }

    /// Returns the name of a run, with a number if it exists or waits.
    fn unused(&self, run: &str) -> Result<String, Refusal> {
        let open = self.queue.open_jobs();
        for number in 1_u32.. {
            let text = if number == 1 { run.to_owned() } else { format!("{run}.{number}") };
            let is_free = fs::symlink_metadata(self.folder.place(&[RUNS])?.join(name(&text)?)).is_err();
            if is_free && open.iter().all(|job| job.run != text) {
                return Ok(text);
            }
        }
        Err(Refusal::conflict("all names are in use"))
    }

    /// Answers with the runs of jobs and their command lines.
    fn started(&self, jobs: &[Job]) -> Result<Reply, Refusal> {
        let lines: Vec<String> = jobs.iter().map(|job| self.line(&job.words)).collect();
        let runs: Vec<&str> = jobs.iter().map(|job| job.run.as_str()).collect();
        Reply::json(&json!({ "runs": runs, "commands": lines }))
    }

    fn resume(&self, request: &ResumeRequest) -> Result<Reply, Refusal> {
        self.folder.run(&request.run)?;
        self.started(&[self.queue.add(Kind::Run, &request.run, request.words())?])
    }

    fn test_champion(&self, request: &TestRequest) -> Result<Reply, Refusal> {
        self.folder.run(&request.run)?;
        self.started(&[self.queue.add(Kind::Test, &request.run, request.words()?)?])
    }

    fn stop(&self, StopRequest { run }: &StopRequest) -> Result<Reply, Refusal> {
        self.queue.stop(name(run)?)?;
        Reply::json(&json!({ "run": run }))
    }

    fn page(&self, request: &PageRequest) -> Result<Reply, Refusal> {
        request.check()?;
        for run in &request.runs {
            self.folder.run(run)?;
        }
        self.folder.made(&[PAGES])?;
        let (file, mut words) = (request.file(), request.words());
        if request.is_live() {
            words = self.program.with_module(words);
        }
        self.folder.place(&[PAGES, &file])?;
        self.program.output(&words, None)?;
        Reply::json(&json!({ "file": format!("{PAGES}/{file}"), "command": self.line(&words) }))
    }

    fn export(&self, request: &ExportRequest) -> Result<Reply, Refusal> {
        self.folder.run(&request.run)?;
        let (stem, end) = request.file();
        let file = self.new_export(&stem, end)?;
        let words = request.words(&file);
        self.program.output(&words, None)?;
        Reply::json(&json!({ "file": format!("{EXPORTS}/{file}"), "command": self.line(&words) }))
    }

    /// Returns an unused name of a file in the folder of exports.
    fn new_export(&self, stem: &str, end: &str) -> Result<String, Refusal> {
        let folder = self.folder.made(&[EXPORTS])?;
        let numbers = std::iter::once(String::new()).chain((2_u32..).map(|number| format!("-{number}")));
        let mut files = numbers.map(|number| format!("{stem}{number}{end}"));
        let file = files.find(|file| fs::symlink_metadata(folder.join(file)).is_err());
        file.ok_or_else(|| Refusal::conflict("all names are in use"))
    }

    /// Saves a text of an interactive page under a new name. A run is evolved by its own process, up to the page's generation.
    fn keep(&self, request: &KeepRequest) -> Result<Reply, Refusal> {
        let KeepRequest { kind, run, text } = request;
        self.folder.run(run)?;
        let file = self.new_export(run, request.extension())?;
        let path = self.folder.place(&[EXPORTS, name(&file)?])?;
        let mut new = fs::File::create_new(&path).map_err(|error| Refusal::new(500, error))?;
        new.write_all(text.as_bytes()).map_err(|error| Refusal::new(500, error))?;
        let file_in_folder = format!("{EXPORTS}/{file}");
        if *kind != KeptKind::Run {
            return Reply::json(&json!({ "file": file_in_folder }));
        }
        let run = self.unused(run)?;
        let job = self.queue.add(Kind::Run, &run, continued(&file, &run))?;
        Reply::json(&json!({ "file": file_in_folder, "run": run, "command": self.line(&job.words) }))
    }

    fn trash(&self, request: TrashRequest) -> Result<Reply, Refusal> {
        let moved = match request {
            TrashRequest::Run(run) => {
                let path = self.folder.run(&run)?;
                if self.queue.open_jobs().iter().any(|job| job.run == run) {
                    return Err(Refusal::conflict(format!("a process works on {run}: stop it first")));
                }
                let _lock = Lock::of_run(&path).map_err(Refusal::conflict)?;
                self.folder.discard(&path)?
            }
            TrashRequest::File(file) => self.folder.discard(&self.folder.experiment(&file)?)?,
        };
        Reply::json(&json!({ "moved": moved }))
    }
}
