//! Requests of the page and their effects.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex, TryLockError};
use std::thread;
use std::time::{Duration, UNIX_EPOCH};

use farsa_view::LabPage;
use hyper::body::Bytes;
use serde::Serialize;
use serde_json::json;
use serde_json::value::RawValue;
use tokio::sync::oneshot;

use crate::live::http::answer::{absence, event};
use crate::live::http::origin::parameter;
use crate::live::lab::command_line::{about, served};
use crate::live::lab::facts::{Facts, RunFacts};
use crate::live::lab::folder::{EXPORTS, Folder, GALLERY, PAGES, RUNS};
use crate::live::lab::names::{Refusal, decoded, name};
use crate::live::lab::program::{Program, ProgramFacts};
use crate::live::lab::queue::Queue;
use crate::live::run_mark::FileMark;
use crate::run::laboratory::MAX_BYTES;
use crate::shell::quoted;
use crate::store::bounded::{read_regular, read_regular_text};

/// Bytes of the largest page or export that is served.
const MAX_FILE: u64 = 256 << 20;
/// Most runs whose last event is stored.
const MAX_EVENTS: usize = 64;
/// First part of the addresses of champions' pages.
const CHAMPION: &str = "champion";
/// Repeated attempts to read a champion while its run replaces files, and the time between them.
const TRIES: usize = 2;
/// Time after which a page without a champion asks again [s]. Each answer takes a process.
const RETRY: u32 = 10;
const INTERVAL: Duration = Duration::from_millis(300);
/// Types of answers with a page and with data.
const HTML: &str = "text/html; charset=utf-8";
pub(super) const JSON: &str = "application/json";

/// A request with its answer.
pub(super) struct Task {
    pub(super) call: Call,
    pub(super) answer: oneshot::Sender<Reply>,
}

/// A request that was allowed.
#[derive(Debug)]
pub(super) enum Call {
    Get {
        path: String,
        query: String,
    },
    Post {
        path: String,
        body: Bytes,
    },
    /// Reads the present champions of a run for its events.
    Champions {
        run: String,
    },
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
    /// Last event with champions of each run, with the mark of its checkpoint.
    champions: Mutex<BTreeMap<String, (FileMark, Bytes)>>,
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
        Self { folder, program, about, queue, facts: Facts::default(), champions: Mutex::default(), read_only }
    }

    /// Answers a request.
    pub(super) fn answer(&self, call: &Call) -> Reply {
        let answer = match call {
            Call::Get { path, query } => self.get(path, query),
            Call::Champions { run } => self.champions(run),
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

    /// Returns a page or an export of the folder, or the page of a run's present champion.
    fn file(&self, path: &str) -> Result<Reply, Refusal> {
        let absent = || Refusal::new(404, "no such page");
        let (folder, file) = path.strip_prefix("/files/").and_then(|rest| rest.split_once('/')).ok_or_else(absent)?;
        // Only in a query is a plus sign a space.
        let file = decoded(&file.replace('+', "%2B")).ok_or_else(absent)?;
        if folder == CHAMPION {
            return self.champion(name(&file)?);
        }
        if ![PAGES, EXPORTS, GALLERY].contains(&folder) {
            return Err(absent());
        }
        let place = self.folder.place(&[folder, name(&file)?])?;
        if !place.is_file() {
            return Err(absent());
        }
        let content = read_regular(&place, MAX_FILE).map_err(|error| Refusal::new(500, error))?;
        let kind = if is_page(&place) { HTML } else { "application/octet-stream" };
        Ok(Reply { status: 200, kind, content: content.into() })
    }

    /// Returns the page of a run's present champion, or a page with the reason for its absence.
    fn champion(&self, run: &str) -> Result<Reply, Refusal> {
        self.folder.run(run)?;
        let words = self.program.with_module(served(run, "page"));
        let mut page = self.program.output(&words, None);
        for _ in 0..TRIES {
            if page.is_ok() {
                break;
            }
            // The files of a running run may just have been replaced.
            thread::sleep(INTERVAL);
            page = self.program.output(&words, None);
        }
        let (status, content) = match page {
            Ok(content) => (200, content.into()),
            Err(Refusal { status, why }) => (status, absence(&why, RETRY).into()),
        };
        Ok(Reply { status, kind: HTML, content })
    }

    /// Reads the mark of a run's last checkpoint.
    pub(super) fn checkpoint(&self, run: &str) -> Option<FileMark> {
        FileMark::read(&self.folder.place(&[RUNS, run, "checkpoint.bin"]).ok()?)
    }

    /// Returns the event with the present champions of a run. Only one worker reads champions at a time.
    fn champions(&self, run: &str) -> Result<Reply, Refusal> {
        let mut events = match self.champions.try_lock() {
            Ok(events) => events,
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            Err(TryLockError::WouldBlock) => return Err(Refusal::new(503, "champions are being read")),
        };
        let mark = self.checkpoint(run).ok_or_else(|| Refusal::new(404, "no generation is finished yet"))?;
        let stored = events.get(run).filter(|(known, _)| *known == mark).map(|(_, event)| event.clone());
        let content = if let Some(event) = stored {
            event
        } else {
            let words = self.program.with_module(served(run, "champions"));
            let text = String::from_utf8_lossy(&self.program.output(&words, None)?).into_owned();
            let data = RawValue::from_string(text).map_err(|error| Refusal::new(500, error))?;
            event("champions", None, &data).map_err(|error| Refusal::new(500, error))?
        };
        if events.len() >= MAX_EVENTS {
            events.clear();
        }
        events.insert(run.to_owned(), (mark, content.clone()));
        Ok(Reply { status: 200, kind: "text/event-stream", content })
    }

    /// Lists experiments, pages of the gallery and runs.
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
            "gallery": self.gallery(),
            "templates": templates,
            "runs": facts,
        }))
    }

    /// Describes an experiment file by its summary. Sweeps and configurations of runs are left out.
    fn described(&self, file: &str) -> Option<serde_json::Value> {
        let path = self.folder.experiment(file).ok()?;
        let text = read_regular_text(&path, MAX_BYTES).ok()?;
        match toml::from_str::<toml::Table>(&text) {
            Ok(table) => {
                let summary = table.get("summary").and_then(toml::Value::as_str)?;
                Some(json!({ "name": file, "summary": summary, "modified": modified(&path) }))
            }
            Err(_) => Some(json!({ "name": file, "summary": "", "broken": true, "modified": modified(&path) })),
        }
    }

    /// Lists the pages of the gallery, except the one that shows them all.
    fn gallery(&self) -> Vec<serde_json::Value> {
        let mut files = self.folder.files(GALLERY);
        files.retain(|file| is_page(Path::new(file)) && file != "index.html");
        let page = |file: &String| {
            let path = self.folder.place(&[GALLERY, file]).ok()?;
            Some(json!({ "name": file, "modified": modified(&path) }))
        };
        files.iter().filter_map(page).collect()
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

/// Checks if a file is a page.
fn is_page(path: &Path) -> bool {
    path.extension().is_some_and(|end| end == "html")
}

/// Returns the time of a file's last change [s since 1970].
fn modified(path: &Path) -> Option<u64> {
    let changed = fs::metadata(path).ok()?.modified().ok()?;
    changed.duration_since(UNIX_EPOCH).ok().map(|time| time.as_secs())
}
