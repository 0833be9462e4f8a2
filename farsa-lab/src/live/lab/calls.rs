//! Requests of the page and their effects.

use std::collections::BTreeSet;
use std::sync::Arc;

use farsa_view::LabPage;
use hyper::body::Bytes;
use serde::Serialize;
use serde_json::json;
use tokio::sync::oneshot;

use crate::live::http::origin::parameter;
use crate::live::lab::command_line::about;
use crate::live::lab::facts::{Facts, RunFacts};
use crate::live::lab::folder::{EXPORTS, Folder, PAGES};
use crate::live::lab::names::{Refusal, decoded, name};
use crate::live::lab::program::{Program, ProgramFacts};
use crate::live::lab::queue::Queue;
use crate::run::laboratory::MAX_BYTES;
use crate::shell::quoted;
use crate::store::bounded::{read_regular, read_regular_text};

/// Bytes of the largest page or export that is served.
const MAX_FILE: u64 = 256 << 20;
/// Type of answers with data.
pub(super) const JSON: &str = "application/json";

/// A request with its answer.
pub(super) struct Task {
    pub(super) call: Call,
    pub(super) answer: oneshot::Sender<Reply>,
}

/// A request that was allowed.
#[derive(Debug)]
pub(super) enum Call {
    Get { path: String, query: String },
    Post { path: String, body: Bytes },
}

/// Answer of a request.
#[derive(Debug)]
pub(super) struct Reply {
    pub(super) status: u16,
    pub(super) kind: &'static str,
    pub(super) content: Bytes,
}

impl Reply {
    /// Answers with data.
    ///
    /// # Errors
    /// [`Refusal`] for data that has no JSON.
    pub(super) fn json(data: &impl Serialize) -> Result<Self, Refusal> {
        let content = serde_json::to_vec(data).map_err(|error| Refusal::new(500, error))?;
        Ok(Self { status: 200, kind: JSON, content: content.into() })
    }
}

impl From<Refusal> for Reply {
    fn from(refusal: Refusal) -> Self {
        let content = serde_json::to_vec(&refusal).unwrap_or_default();
        Self { status: refusal.status, kind: JSON, content: content.into() }
    }
}

/// Everything that an answer needs.
#[derive(Debug)]
pub(super) struct Bench {
    pub(super) folder: Folder,
    pub(super) program: Program,
    pub(super) about: ProgramFacts,
    pub(super) queue: Arc<Queue>,
    facts: Facts,
    pub(super) read_only: bool,
}

impl Bench {
    pub(super) fn new(
        folder: Folder,
        program: Program,
        about: ProgramFacts,
        queue: Arc<Queue>,
        read_only: bool,
    ) -> Self {
        Self { folder, program, about, queue, facts: Facts::default(), read_only }
    }

    /// Answers a request.
    pub(super) fn answer(&self, call: &Call) -> Reply {
        let answer = match call {
            Call::Get { path, query } => self.get(path, query),
            Call::Post { path, body } if path == "/api/check" => self.check(body),
            Call::Post { .. } if self.read_only => {
                Err(Refusal::new(403, "this laboratory was started with --read-only"))
            }
            Call::Post { path, body } => self.change(path, body),
        };
        answer.unwrap_or_else(Reply::from)
    }

    fn get(&self, path: &str, query: &str) -> Result<Reply, Refusal> {
        let given = |key: &str| match parameter(query, key) {
            None => Ok(None),
            Some(text) => decoded(text).map(Some).ok_or_else(|| Refusal::invalid(format!("{key} is no text"))),
        };
        let needed = |key: &str| given(key)?.ok_or_else(|| Refusal::invalid(format!("the request has no {key}")));
        match path {
            "/api/list" => self.list(),
            "/api/run" => self.run(&needed("name")?),
            "/api/info" => {
                let (condition, strategy) = (given("condition")?, given("strategy")?);
                self.folder.no_link(&needed("experiment")?)?;
                let words =
                    about("info", &needed("experiment")?, condition.as_deref(), strategy.as_deref(), &["--json"]);
                self.printed(&words?, None, JSON)
            }
            "/api/strategies" => self.printed(&["strategies".to_owned(), "--json".to_owned()], None, JSON),
            "/api/graph" => {
                self.folder.no_link(&needed("experiment")?)?;
                let words =
                    about("check", &needed("experiment")?, given("condition")?.as_deref(), None, &["--graph", "-"]);
                self.printed(&words?, None, "image/svg+xml")
            }
            "/api/file" => {
                let name = needed("name")?;
                let text = read_regular_text(&self.folder.experiment(&name)?, MAX_BYTES);
                Reply::json(&json!({ "name": name, "text": text.map_err(|error| Refusal::new(422, error))? }))
            }
            _ => self.file(path),
        }
    }

    /// Runs a command and answers with what it prints.
    pub(super) fn printed(&self, words: &[String], input: Option<&str>, kind: &'static str) -> Result<Reply, Refusal> {
        Ok(Reply { status: 200, kind, content: self.program.output(words, input)?.into() })
    }

    /// Returns a page or an export of the folder.
    fn file(&self, path: &str) -> Result<Reply, Refusal> {
        let absent = || Refusal::new(404, "no such page");
        let (folder, file) = path.strip_prefix("/files/").and_then(|rest| rest.split_once('/')).ok_or_else(absent)?;
        // Only in a query is a plus sign a space.
        let file = decoded(&file.replace('+', "%2B")).ok_or_else(absent)?;
        if ![PAGES, EXPORTS].contains(&folder) {
            return Err(absent());
        }
        let place = self.folder.place(&[folder, name(&file)?])?;
        if !place.is_file() {
            return Err(absent());
        }
        let content = read_regular(&place, MAX_FILE).map_err(|error| Refusal::new(500, error))?;
        let is_page = place.extension().is_some_and(|end| end == "html");
        let kind = if is_page { "text/html; charset=utf-8" } else { "application/octet-stream" };
        Ok(Reply { status: 200, kind, content: content.into() })
    }

    /// Lists experiments and runs.
    fn list(&self) -> Result<Reply, Refusal> {
        let runs = self.folder.runs();
        let mut facts: Vec<RunFacts> = runs.iter().filter_map(|run| self.facts_of(run)).collect();
        let listed: BTreeSet<&str> = runs.iter().map(String::as_str).collect();
        let open = self.queue.open_jobs();
        let new = open.iter().filter(|job| !listed.contains(job.run.as_str()));
        facts.extend(new.map(|job| RunFacts::without_files(job, &self.queue)));
        let files: Vec<_> = self.folder.experiments().into_iter().filter_map(|file| self.described(&file)).collect();
        let templates = self.about.templates.iter();
        let templates: Vec<_> = templates.map(|(name, summary)| json!({ "name": name, "summary": summary })).collect();
        Reply::json(&json!({
            "folder": self.folder.path().file_name().map(|name| name.to_string_lossy()),
            "program": self.about.name,
            "read_only": self.read_only,
            "experiments": self.about.experiments,
            "files": files,
            "templates": templates,
            "runs": facts,
        }))
    }

    /// Describes an experiment file by its summary. Sweeps and configurations of runs are left out.
    fn described(&self, file: &str) -> Option<serde_json::Value> {
        let text = read_regular_text(&self.folder.experiment(file).ok()?, MAX_BYTES).ok()?;
        match toml::from_str::<toml::Table>(&text) {
            Ok(table) => {
                let summary = table.get("summary").and_then(toml::Value::as_str)?;
                Some(json!({ "name": file, "summary": summary }))
            }
            Err(_) => Some(json!({ "name": file, "summary": "", "broken": true })),
        }
    }

    /// Summarizes a run of the folder or of the queue.
    fn facts_of(&self, run: &str) -> Option<RunFacts> {
        let path = self.folder.run(run).ok()?;
        self.facts.of(run, &path, &self.queue)
    }

    /// Returns the state of a run, also without its files.
    pub(super) fn state(&self, run: &str) -> Option<RunFacts> {
        let by_job = || Some(RunFacts::without_files(&self.queue.latest(run)?, &self.queue));
        self.facts_of(run).or_else(by_job)
    }

    /// Describes a run with its last process, its pages and its tests.
    fn run(&self, run: &str) -> Result<Reply, Refusal> {
        name(run)?;
        let job = self.queue.latest(run);
        let facts = self.state(run).ok_or_else(|| Refusal::new(404, format!("there is no run {run:?}")))?;
        let of_run = |folder: &str, file: &str| {
            let stem = file.split_once('-').map_or(file, |(_, rest)| rest);
            let stem = stem.strip_suffix(".html").unwrap_or(stem);
            match folder {
                PAGES => stem.split('+').any(|part| part == run),
                _ => file.strip_prefix(run).is_some_and(|rest| rest.starts_with(['.', '-'])),
            }
        };
        let files = |folder: &'static str| {
            let mut files = self.folder.files(folder);
            files.retain(|file| of_run(folder, file));
            files
        };
        Reply::json(&json!({
            "facts": facts,
            "command": job.as_ref().map(|job| self.line(&job.words)),
            "printed": job.as_ref().map(|job| self.queue.printed(job)),
            "pages": files(PAGES),
            "exports": files(EXPORTS),
            "test": self.test(run),
            "protocols": self.protocols(run),
        }))
    }

    /// Reads the description of a run's test.
    fn test(&self, run: &str) -> Option<serde_json::Value> {
        let path = self.folder.place(&["runs", run, "test.json"]).ok()?;
        serde_json::from_str(&read_regular_text(&path, MAX_BYTES).ok()?).ok()
    }

    /// Lists the protocols by which a run was tested.
    fn protocols(&self, run: &str) -> Vec<String> {
        let files = self.folder.files(&format!("runs/{run}/protocols"));
        files.iter().filter_map(|file| file.strip_suffix(".json")).map(str::to_owned).collect()
    }

    /// Formats a command line, as it can be repeated in the folder.
    pub(super) fn line(&self, words: &[String]) -> String {
        let all = std::iter::once(&self.about.name).chain(words);
        all.map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
    }

    /// Returns a file of the browser's part.
    pub(super) fn asset(path: &str) -> Option<Reply> {
        let (kind, text) = LabPage::file(path)?;
        Some(Reply { status: 200, kind, content: Bytes::from_static(text.as_bytes()) })
    }
}
