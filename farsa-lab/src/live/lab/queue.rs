//! Processes that wait, run and have ended. Their files are in `.lab/jobs`, so that a later server finds them.
//!
//! The standard error of a process is a locked file, which the process inherits. The lock ends with the process, also without a
//! server.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Child;
use std::sync::{Mutex, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::live::lab::command_line::is_of_request;
use crate::live::lab::folder::Folder;
use crate::live::lab::names::Refusal;
use crate::live::lab::program::Program;
use crate::store::bounded::{read_regular_part, read_regular_text};
use crate::store::lock::is_held;
use crate::store::replace::replace;

/// Bytes of the largest description of a job.
const MAX_BYTES: u64 = 1 << 20;
/// Bytes at the end of a log that a page shows.
const TAIL: u64 = 4000;

/// Kind of a process.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Kind {
    /// Evolves, from the start or from a checkpoint.
    Run,
    /// Tests a champion.
    Test,
}

/// Process of the command for a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Job {
    pub(super) number: u64,
    pub(super) kind: Kind,
    pub(super) run: String,
    /// Arguments of the command.
    pub(super) words: Vec<String>,
    /// Time of the request in seconds since 1970, UTC.
    pub(super) created: u64,
    /// Identifier of the process.
    pub(super) pid: Option<u32>,
    pub(super) has_started: bool,
    pub(super) has_ended: bool,
}

/// Jobs of a folder.
#[derive(Debug)]
pub(super) struct Queue {
    place: PathBuf,
    program: Program,
    most: usize,
    read_only: bool,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    /// Jobs that wait or run, by number.
    open: BTreeMap<u64, Job>,
    /// Last job of each run.
    latest: BTreeMap<String, Job>,
    next: u64,
    /// Processes that this one has started. The system keeps ended ones until they are waited for.
    children: BTreeMap<u64, Child>,
}

impl Queue {
    /// Opens the jobs of a folder, with those that an earlier server has left.
    ///
    /// # Errors
    /// [`Error::Usage`] and [`Error::Io`].
    pub(super) fn open(folder: &Folder, program: Program, most: usize, read_only: bool) -> Result<Self, Error> {
        let refused = |refusal: Refusal| Error::Usage(refusal.why);
        let parts = [".lab", "jobs"];
        let place = if read_only { folder.place(&parts) } else { folder.made(&parts) }.map_err(refused)?;
        let mut state = State { next: 1, ..State::default() };
        for name in folder.files(".lab/jobs") {
            // Outputs and damaged descriptions are no jobs.
            let path = place.join(name);
            if path.extension().is_none_or(|end| end != "json") {
                continue;
            }
            let text = read_regular_text(&path, MAX_BYTES).unwrap_or_default();
            let Ok(mut job) = serde_json::from_str::<Job>(&text) else { continue };
            if !is_of_request(&job.run, &job.words) || path.file_stem() != Some(job.number.to_string().as_ref()) {
                continue;
            }
            state.next = state.next.max(job.number + 1);
            // The server may have ended between the start of the process and its description.
            job.has_started |= log_of(&place, job.number).is_file();
            if state.latest.get(&job.run).is_none_or(|other| other.number < job.number) {
                state.latest.insert(job.run.clone(), job.clone());
            }
            if !job.has_ended {
                state.open.insert(job.number, job);
            }
        }
        Ok(Self { place, program, most, read_only, state: Mutex::new(state) })
    }

    fn locked(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a process, which starts at once if there is room.
    ///
    /// # Errors
    /// [`Refusal`] if the run already has one.
    pub(super) fn add(&self, kind: Kind, run: &str, words: Vec<String>) -> Result<Job, Refusal> {
        let mut state = self.locked();
        if state.open.values().any(|job| job.run == run) {
            return Err(Refusal::conflict(format!("another process of {run} runs or waits")));
        }
        let created = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        let number = state.next;
        let job =
            Job { number, kind, run: run.into(), words, created, pid: None, has_started: false, has_ended: false };
        self.save(&job).map_err(|error| Refusal::new(500, error))?;
        state.next += 1;
        state.latest.insert(run.into(), job.clone());
        state.open.insert(number, job.clone());
        drop(state);
        self.advance();
        Ok(job)
    }

    fn save(&self, job: &Job) -> Result<(), Error> {
        let text = serde_json::to_vec(job).map_err(|error| Error::Other(error.to_string()))?;
        replace(&self.place.join(format!("{}.json", job.number)), &text)
    }

    /// Notes ended processes and starts waiting ones.
    pub(super) fn advance(&self) {
        if self.read_only {
            return;
        }
        let mut state = self.locked();
        state.children.retain(|_, child| matches!(child.try_wait(), Ok(None)));
        let State { open, children, .. } = &*state;
        let is_over =
            |job: &Job| job.has_started && !children.contains_key(&job.number) && !is_held(&self.log(job.number));
        let over: Vec<Job> = open.values().filter(|job| is_over(job)).cloned().collect();
        for job in over {
            self.end(&mut state, job);
        }
        while state.open.values().filter(|job| job.has_started).count() < self.most {
            let Some(job) = state.open.values().find(|job| !job.has_started).cloned() else { return };
            self.start(&mut state, job);
        }
    }

    fn start(&self, state: &mut State, mut job: Job) {
        let log = self.log(job.number);
        let started = File::create_new(&log).and_then(|file| {
            file.lock()?;
            let out = File::create_new(log.with_extension("out"))?;
            self.program.start(&job.words, out, file)
        });
        job.has_started = true;
        match started {
            Ok(child) => {
                job.pid = Some(child.id());
                state.children.insert(job.number, child);
                self.note(state, job);
            }
            Err(error) => {
                let _ = fs::write(&log, format!("error: cannot start the process: {error}\n"));
                self.end(state, job);
            }
        }
    }

    fn end(&self, state: &mut State, mut job: Job) {
        job.has_ended = true;
        self.note(state, job);
    }

    /// Replaces a job. If its file cannot be written, a later server finds it by its log.
    fn note(&self, state: &mut State, job: Job) {
        let _ = self.save(&job);
        if job.has_ended {
            state.open.remove(&job.number);
        } else {
            state.open.insert(job.number, job.clone());
        }
        if state.latest.get(&job.run).is_none_or(|other| other.number <= job.number) {
            state.latest.insert(job.run.clone(), job);
        }
    }

    /// Interrupts the process of a run as a terminal does, or removes it from the queue.
    ///
    /// # Errors
    /// [`Refusal`] for a run without a process of this laboratory.
    pub(super) fn stop(&self, run: &str) -> Result<(), Refusal> {
        let mut state = self.locked();
        let job = state.open.values().find(|job| job.run == run).cloned();
        let Some(job) = job else {
            return Err(Refusal::conflict(format!("no process of this laboratory works on {run}")));
        };
        if !job.has_started {
            self.end(&mut state, job);
            return Ok(());
        }
        // The identifier is that of the process as long as it holds its lock.
        match job.pid.filter(|_| state.children.contains_key(&job.number) || is_held(&self.log(job.number))) {
            Some(pid) => interrupt(pid),
            None => Err(Refusal::conflict("the process has no identifier: stop it where it was started")),
        }
    }

    /// Lists the jobs that wait or run, in the order of their start.
    pub(super) fn open_jobs(&self) -> Vec<Job> {
        self.locked().open.values().cloned().collect()
    }

    /// Returns the last job of a run.
    pub(super) fn latest(&self, run: &str) -> Option<Job> {
        let mut job = self.locked().latest.get(run).cloned()?;
        // A server that changes nothing does not note ends.
        job.has_ended |= self.read_only && job.has_started && !is_held(&self.log(job.number));
        Some(job)
    }

    /// Reads the end of what the last process of a run has printed, its errors and progress.
    pub(super) fn printed(&self, job: &Job) -> String {
        let log = self.log(job.number);
        let size = fs::metadata(&log).map_or(0, |metadata| metadata.len());
        let bytes = read_regular_part(&log, size.saturating_sub(TAIL), TAIL).unwrap_or_default();
        String::from_utf8_lossy(&bytes).into_owned()
    }

    fn log(&self, number: u64) -> PathBuf {
        log_of(&self.place, number)
    }
}

/// Returns the path of what a process prints.
fn log_of(place: &Path, number: u64) -> PathBuf {
    place.join(format!("{number}.log"))
}

/// Sends the signal after which a run is saved and ends, also if the process ignores Ctrl-C.
#[cfg(unix)]
fn interrupt(pid: u32) -> Result<(), Refusal> {
    use rustix::process::{Pid, Signal, kill_process_group};
    let group = i32::try_from(pid).ok().and_then(Pid::from_raw);
    let group = group.ok_or_else(|| Refusal::conflict("the process has no identifier"))?;
    kill_process_group(group, Signal::TERM).map_err(|error| Refusal::conflict(format!("cannot stop it: {error}")))
}

#[cfg(not(unix))]
fn interrupt(_: u32) -> Result<(), Refusal> {
    Err(Refusal::conflict("this system has no signals: end the process in its task manager, then resume the run"))
}
