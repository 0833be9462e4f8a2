//! Summaries of runs, read from small files. Unchanged files are not read again.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;

use crate::experiment::settings::Value;
use crate::figures::proportion::Proportion;
use crate::live::lab::queue::{Job, Kind, Queue};
use crate::live::log_tail::{LogTail, Part};
use crate::live::run_mark::FileMark;
use crate::run::config_file::ConfigFile;
use crate::store::bounded::read_regular_text;
use crate::store::directory::Directory;
use crate::store::lock::{RUN_LOCK, is_held};
use crate::store::manifest::Manifest;
use crate::strategy::settings::GENERATIONS;

/// Most points of a small curve.
const POINTS: usize = 96;
/// Bytes of the largest table of a test that is read.
const MAX_TABLE: u64 = 16 << 20;

/// State of a run, in the words of the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum RunState {
    Waiting,
    Running,
    Testing,
    Stopped,
    Failed,
    Finished,
}

/// Success of the champion's test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Success {
    successes: usize,
    of: usize,
    /// Wilson's interval of 95 %.
    interval: [f64; 2],
}

/// Summary of a run.
#[derive(Debug, Clone, Serialize)]
pub(super) struct RunFacts {
    pub(super) name: String,
    pub(super) state: RunState,
    pub(super) experiment: String,
    pub(super) condition: String,
    pub(super) strategy: String,
    pub(super) seed: u64,
    pub(super) generations: u64,
    /// Finished generations.
    pub(super) done: usize,
    /// Best fitness of all generations and of the last one.
    best: Option<f64>,
    last: Option<f64>,
    /// Best fitness of every n-th generation.
    curve: Vec<Option<f64>>,
    success: Option<Success>,
    /// Start of the run in seconds since 1970, UTC.
    started: u64,
    /// Expected seconds until the last generation.
    pub(super) left: Option<f64>,
    bytes: u64,
    /// False if another program continues the run.
    pub(super) is_stoppable: bool,
    error: Option<String>,
}

/// Parts of the files of a run that were read, with the marks of the files.
#[derive(Debug, Default)]
struct Files {
    marks: [Option<FileMark>; 3],
    experiment: String,
    condition: String,
    strategy: String,
    seed: u64,
    generations: u64,
    started: u64,
    /// Start and first generation of the last process.
    session: Option<(u64, u32)>,
    success: Option<Success>,
    log: Option<Curve>,
    error: Option<String>,
}

/// Log of fitness so far, thinned to few points.
#[derive(Debug)]
struct Curve {
    tail: LogTail,
    done: usize,
    best: Option<f64>,
    last: Option<f64>,
    stride: usize,
    points: Vec<Option<f64>>,
}

impl Curve {
    fn new(directory: &Directory) -> Self {
        let tail = LogTail::new(directory.log(), 0);
        Self { tail, done: 0, best: None, last: None, stride: 1, points: Vec::new() }
    }

    /// Reads new lines. False if this is another log.
    fn read(&mut self) -> bool {
        // A log that is being written is read at the next look.
        while let Ok(part) = self.tail.read() {
            let Part::Rows(rows, more) = part else { return false };
            for row in rows {
                let best = row.best();
                self.last = best;
                self.best = best.into_iter().chain(self.best).reduce(f64::max);
                if self.done.is_multiple_of(self.stride) {
                    self.points.push(best);
                }
                self.done += 1;
                if self.points.len() > POINTS {
                    self.stride *= 2;
                    self.points = self.points.iter().copied().step_by(2).collect();
                }
            }
            if !more {
                break;
            }
        }
        true
    }
}

impl Files {
    /// Reads the files that have changed.
    fn refresh(&mut self, directory: &Directory) {
        let paths = [directory.config(), directory.manifest(), directory.test()];
        let marks = [0, 1, 2].map(|file| FileMark::read(&paths[file]));
        if marks[0] != self.marks[0] || marks[0].is_none() {
            *self = Self::default();
            self.configure(directory);
        }
        if marks[1] != self.marks[1] {
            let sessions = Manifest::read(&paths[1]).map(|manifest| manifest.sessions).unwrap_or_default();
            self.started = sessions.first().map_or(self.started, |session| session.started_unix);
            self.session = sessions.last().map(|session| (session.started_unix, session.first_generation));
        }
        if marks[2] != self.marks[2] {
            self.success = read_regular_text(&paths[2], MAX_TABLE).ok().and_then(|text| success(&text));
        }
        self.marks = marks;
        let curve = self.log.get_or_insert_with(|| Curve::new(directory));
        if !curve.read() {
            let mut other = Curve::new(directory);
            other.read();
            self.log = Some(other);
        }
    }

    fn configure(&mut self, directory: &Directory) {
        let modified = fs::metadata(directory.config()).and_then(|metadata| metadata.modified()).ok();
        let modified = modified.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
        self.started = modified.map_or(0, |since| since.as_secs());
        match ConfigFile::read_regular(&directory.config()) {
            Ok(file) => {
                let generations = file.entries.iter().find(|(key, _)| key == GENERATIONS);
                if let Some(Value::Whole(count)) = generations.and_then(|(_, entry)| entry.value.clone()) {
                    self.generations = count.unsigned_abs();
                }
                self.experiment = file.experiment.map(|entry| entry.value).unwrap_or_default();
                self.condition = file.condition.map(|entry| entry.value).unwrap_or_default();
                self.strategy = file.strategy.map(|entry| entry.value).unwrap_or_default();
                self.seed = file.seed.map_or(1, |entry| entry.value);
            }
            Err(error) => self.error = Some(error.to_string()),
        }
    }
}

/// Counts the successful trials of a table, if its experiment has a criterion.
fn success(table: &str) -> Option<Success> {
    let mut lines = table.lines();
    let column = lines.next()?.split(',').position(|name| name == "success")?;
    let values: Vec<&str> = lines.filter_map(|line| line.split(',').nth(column)).collect();
    let of = values.iter().filter(|value| !value.is_empty()).count();
    let successes = values.iter().filter(|value| **value == "true").count();
    (of > 0).then(|| Success { successes, of, interval: Proportion { successes, of }.interval() })
}

/// Summaries of the runs of a folder.
#[derive(Debug, Default)]
pub(super) struct Facts(Mutex<BTreeMap<String, Files>>);

impl Facts {
    /// Summarizes a run.
    pub(super) fn of(&self, name: &str, path: &Path, queue: &Queue) -> Option<RunFacts> {
        let directory = Directory::at(path.into());
        let mut cache = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let files = cache.entry(name.into()).or_default();
        files.refresh(&directory);
        let log = files.log.as_ref()?;
        let job = queue.latest(name);
        let open = job.as_ref().filter(|job| !job.has_ended);
        let is_running = is_held(&path.join(RUN_LOCK));
        let mut error = files.error.clone();
        let state = match open {
            Some(job) if !job.has_started => RunState::Waiting,
            Some(Job { kind: Kind::Test, .. }) => RunState::Testing,
            Some(_) => RunState::Running,
            None if is_running => RunState::Running,
            None => {
                let is_done = log.done as u64 >= files.generations;
                // A run may have been continued in a terminal after its last process failed here.
                let is_of_page = job.as_ref().is_some_and(|job| job.words.get(1).is_some_and(|word| word == "--from"));
                let job = job.as_ref().filter(|job| !is_done || is_of_page || job.kind == Kind::Test);
                error = error.or_else(|| job.and_then(|job| failure(job, queue)));
                match (is_done, &error) {
                    // Its generations are not those of the page.
                    (true, Some(_)) if is_of_page => RunState::Failed,
                    (true, _) => RunState::Finished,
                    (false, Some(_)) => RunState::Failed,
                    (false, None) => RunState::Stopped,
                }
            }
        };
        Some(RunFacts {
            name: name.into(),
            state,
            experiment: files.experiment.clone(),
            condition: files.condition.clone(),
            strategy: files.strategy.clone(),
            seed: files.seed,
            generations: files.generations,
            done: log.done,
            best: log.best,
            last: log.last,
            curve: log.points.clone(),
            success: files.success.clone(),
            started: files.started,
            left: files.left(state),
            bytes: size(path),
            is_stoppable: open.is_some(),
            error,
        })
    }
}

impl Files {
    /// Estimates the time until the last generation from those of the current process.
    fn left(&self, state: RunState) -> Option<f64> {
        let ((started, first), log) = (self.session?, self.log.as_ref()?);
        let now = SystemTime::now().duration_since(UNIX_EPOCH).ok()?.as_secs_f64();
        let new = log.done.checked_sub(first as usize).filter(|new| *new > 0 && state == RunState::Running)?;
        let after = self.generations.saturating_sub(log.done as u64);
        Some((now - started as f64).max(0.0) * after as f64 / new as f64)
    }
}

/// Returns the error that ended a process.
fn failure(job: &Job, queue: &Queue) -> Option<String> {
    let printed = queue.printed(job);
    printed.lines().rev().find_map(|line| line.strip_prefix("error: ")).map(str::to_owned)
}

impl RunFacts {
    /// Describes a run by its process, before it has files or after it was refused.
    pub(super) fn without_files(job: &Job, queue: &Queue) -> Self {
        let error = if job.has_ended { failure(job, queue) } else { None };
        let state = match (job.has_started, job.has_ended, &error) {
            (_, true, Some(_)) => RunState::Failed,
            (_, true, None) => RunState::Stopped,
            (true, ..) => RunState::Running,
            (false, ..) => RunState::Waiting,
        };
        Self {
            name: job.run.clone(),
            state,
            experiment: String::new(),
            condition: String::new(),
            strategy: String::new(),
            seed: 0,
            generations: 0,
            done: 0,
            best: None,
            last: None,
            curve: Vec::new(),
            success: None,
            started: 0,
            left: None,
            bytes: 0,
            is_stoppable: !job.has_ended,
            error,
        }
    }
}

/// Adds the sizes of the files of a directory, two levels deep.
fn size(path: &Path) -> u64 {
    let entries = |path: &Path| fs::read_dir(path).into_iter().flatten().flatten();
    let of = |entry: &fs::DirEntry| entry.metadata().map_or(0, |metadata| metadata.len());
    let below = |entry: &fs::DirEntry| entry.file_type().is_ok_and(|kind| kind.is_dir());
    entries(path)
        .map(|entry| if below(&entry) { entries(&entry.path()).map(|inner| of(&inner)).sum() } else { of(&entry) })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_has_few_points_and_every_generation_counts() {
        let folder = tempfile::tempdir().unwrap();
        let directory = Directory::at(folder.path().into());
        let line = |generation: usize| format!("{generation},{}.0,0.0,-inf,4,0\n", (generation * 7) % 1000);
        let mut text = String::from("generation,best,mean,worst,evaluations,failed\n");
        text.extend((0..500).map(line));
        fs::write(directory.log(), &text).unwrap();
        let mut curve = Curve::new(&directory);
        assert!(curve.read());
        assert_eq!((curve.done, curve.best, curve.last), (500, Some(996.0), Some(493.0)));
        text.extend((500..900).map(line));
        fs::write(directory.log(), &text).unwrap();
        assert!(curve.read() && curve.points.len() <= POINTS);
        let expected: Vec<_> = (0..900).step_by(curve.stride).map(|at| Some(((at * 7) % 1000) as f64)).collect();
        assert_eq!((curve.done, &curve.points), (900, &expected));
        fs::write(directory.log(), text.replace("899,293.0", "899,294.0") + "900,1.0,1.0,1.0,4,0\n").unwrap();
        assert!(!curve.read());
    }

    #[test]
    fn a_test_has_a_share_with_an_interval() {
        let text = "index,trial,steps,success,fitness\n0,0,9,true,1.0\n1,1,9,false,0.5\n2,2,9,true,1.0\n";
        let found = success(text).unwrap();
        assert_eq!((found.successes, found.of), (2, 3));
        assert_eq!(found.interval, Proportion { successes: 2, of: 3 }.interval());
        assert_eq!(success("index,trial,steps,success,fitness\n0,0,9,,1.0\n"), None);
    }
}
