//! Runs shared by any number of processes. Each process takes the next unclaimed run.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use crate::error::{Error, FileFault};
use crate::escaped::{OneLine, escaped};
use crate::run::begin;
use crate::run::evolve;
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::progress::{ProgressOptions, Study};
use crate::run::record_file::RunRecord;
use crate::run::records::{Champions, Checkpoint};
use crate::run::summary::{Summary, Winner, finished_already};
use crate::shell::again;
use crate::store::directory::{Directory, vacant};
use crate::store::identity::Identity;
use crate::store::lock::Lock;

/// One of the runs.
pub(crate) struct Member<'e> {
    pub(crate) plan: Plan<'e>,
    /// Directory of the run.
    pub(crate) path: PathBuf,
    /// Name of the run in messages.
    pub(crate) name: String,
}

/// Runs in their order.
pub(crate) struct Queue<'q, 'e> {
    pub(crate) count: usize,
    /// Returns the run of a number below `count`.
    pub(crate) member: &'q dyn Fn(usize) -> Result<Member<'e>, Error>,
    pub(crate) pool: &'q dyn Fn(&Plan<'e>) -> Result<Pool<'e>, Error>,
    /// Called with the summary of a run that this process has finished, while the run is claimed.
    pub(crate) after: &'q dyn Fn(&mut Summary) -> Result<(), Error>,
    /// Name of this program.
    pub(crate) program: &'q str,
    pub(crate) quiet: bool,
}

/// State of a run.
#[derive(Debug)]
pub(crate) enum State {
    Finished {
        summary: Box<Summary>,
        /// True if all generations were finished before this process began.
        skipped: bool,
    },
    /// Another process has claimed the run.
    Elsewhere(PathBuf),
}

impl Queue<'_, '_> {
    /// Checks that every directory has the expected run, or none, and returns the individuals that are left of each run.
    ///
    /// # Errors
    /// The errors of [`Work::of_run`] and of the member.
    pub(crate) fn check(&self) -> Result<Vec<u64>, Error> {
        // Runs in one folder differ in their seeds, so their generations have one size.
        let mut size: Option<(PathBuf, u64)> = None;
        let left = (0..self.count).map(|number| {
            let Member { plan, path, .. } = (self.member)(number)?;
            let Work::Left { generations } = Work::of_run(&plan, &path)? else { return Ok(0) };
            let folder = path.parent().unwrap_or(&path).to_path_buf();
            let size = match &size {
                Some((other, size)) if *other == folder => *size,
                _ => size.insert((folder, plan.strategy()?.individuals() as u64)).1,
            };
            Ok(u64::from(generations) * size)
        });
        left.collect()
    }

    /// Begins, continues or skips each run in order, until all are finished or claimed by other processes. `left` holds the
    /// individuals that are left of each run.
    ///
    /// # Errors
    /// [`Error::Interrupted`] after `stop` became true, and the errors of [`evolve::continue_run`]. The runs before the failed
    /// one are saved, and those after it are not begun.
    pub(crate) fn work(&self, left: &[u64], stop: &AtomicBool) -> Result<Vec<State>, Error> {
        let mut states: Vec<State> = Vec::new();
        let (started, mut before) = (Instant::now(), 0);
        for number in 0..self.count {
            let after = left.iter().skip(number + 1).sum();
            let study = Study { before, elapsed: started.elapsed(), after };
            let state = self.turn(number, Some(study).filter(|_| self.count > 1), stop)?;
            if matches!(state, State::Finished { skipped: false, .. }) {
                before += left[number];
            }
            states.push(state);
        }
        // A process that had claimed a run may have been killed.
        loop {
            let mut changed = false;
            for (number, state) in states.iter_mut().enumerate().filter(|(_, state)| state.is_elsewhere()) {
                *state = self.turn(number, None, stop)?;
                changed |= matches!(state, State::Finished { skipped: false, .. });
            }
            if !changed {
                return Ok(states);
            }
        }
    }

    /// Begins, continues, skips or leaves one run.
    fn turn(&self, number: usize, study: Option<Study>, stop: &AtomicBool) -> Result<State, Error> {
        let Member { plan, path, name } = (self.member)(number)?;
        let place = OneLine(path.display());
        let skip = |summary: Box<Summary>| {
            self.tell(&format!("{name}: {place}: {}", finished_already(summary.generations)));
            Ok(State::Finished { summary, skipped: true })
        };
        if let Work::Done(summary) = Work::of_run(&plan, &path)? {
            return skip(summary);
        }
        if stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted { resume: again(self.program) });
        }
        let (directory, new) = opened(&plan, &path)?;
        let Some(lock) = Lock::of_free_run(&path)? else {
            self.tell(&format!("{name}: {place}: another process is at it"));
            return Ok(State::Elsewhere(path));
        };
        // Checked again, because another process may have finished the run before it released the lock.
        if let Work::Done(summary) = Work::of_run(&plan, &path)? {
            return skip(summary);
        }
        self.tell(&format!("{name}: {place}{}", if new { "" } else { ": continues" }));
        let pool = (self.pool)(&plan)?;
        let options = ProgressOptions { quiet: self.quiet, study };
        let summary = evolve::continue_locked(&lock, &plan, &directory, pool, stop, self.program, options);
        let tested = summary.and_then(|mut summary| (self.after)(&mut summary).map(|()| summary));
        let summary = tested.map_err(|error| match error {
            Error::Interrupted { .. } => Error::Interrupted { resume: again(self.program) },
            error => error,
        })?;
        self.tell(&summary.text());
        Ok(State::Finished { summary: Box::new(summary), skipped: false })
    }

    fn tell(&self, line: &str) {
        if !self.quiet {
            // A closed error stream is no error.
            let _ = writeln!(io::stderr(), "{}", escaped(line));
        }
    }

    /// Prints the number of runs claimed by other processes.
    pub(crate) fn tell_of_others(&self, states: &[State]) {
        match states.iter().filter(|state| state.is_elsewhere()).count() {
            0 => {}
            1 => self.tell("another process is at 1 run: repeat the command for the result"),
            runs => {
                self.tell(&format!("other processes are at {runs} runs: repeat the command for the results"));
            }
        }
    }
}

impl State {
    pub(crate) fn is_elsewhere(&self) -> bool {
        matches!(self, Self::Elsewhere(_))
    }
}

/// Opens the directory of a run, and returns whether this process has created it.
fn opened(plan: &Plan<'_>, path: &Path) -> Result<(Directory, bool), Error> {
    if let Ok(directory) = Directory::open(path) {
        return Ok((directory, false));
    }
    match begin::create(plan, path) {
        // Another process has created it at the same time.
        Err(Error::File { fault: FileFault::Occupied, .. }) if path.join("config.toml").is_file() => {
            Ok((Directory::open(path)?, false))
        }
        made => Ok((made?, true)),
    }
}

/// Finished or remaining work of a run.
#[derive(Debug)]
pub(crate) enum Work {
    /// All generations are finished.
    Done(Box<Summary>),
    /// The run is to be begun or continued.
    Left { generations: u32 },
}

impl Work {
    /// Reads the progress of a run, which may not have begun.
    ///
    /// # Errors
    /// [`Error::File`] by other files, [`Error::Usage`] by another run or one with more generations,
    /// and any error that prevents the run from being continued.
    pub(crate) fn of_run(plan: &Plan<'_>, path: &Path) -> Result<Self, Error> {
        let asked = plan.generations()?;
        let directory = match Directory::open(path) {
            Ok(directory) => directory,
            Err(_) => match vacant(path) {
                // Another process has created it in between.
                Err(Error::File { fault: FileFault::Occupied, .. }) if path.join("config.toml").is_file() => {
                    Directory::open(path)?
                }
                vacant => return vacant.map(|()| Self::Left { generations: asked }),
            },
        };
        let file = directory.checkpoint();
        let checkpoint = Checkpoint::read(plan, &directory)?;
        let (identity, done) = (&checkpoint.identity, checkpoint.generation);
        identity.same_values(&plan.identity()?, &file)?;
        if done < asked {
            return Ok(Self::Left { generations: asked - done });
        }
        if done > asked {
            return Err(Error::Usage(format!("{}: has finished {done} generations already", path.display())));
        }
        let champions = Champions::read(plan, &directory)?;
        let names = if champions.best.len() > 1 { plan.evaluator()?.info().populations } else { Vec::new() };
        let champions = Winner::from_champions(&champions, &names);
        let failed = RunRecord::read(plan, &directory, &checkpoint)?.failed();
        let Identity { experiment, condition, seed, .. } = checkpoint.identity;
        Ok(Self::Done(Box::new(Summary {
            directory: path.into(),
            experiment,
            condition,
            seed,
            generations: done,
            evaluations: 0,
            failed,
            seconds: 0.0,
            test: None,
            combined: String::new(),
            champion: champions.first().cloned(),
            champions: if champions.len() > 1 { champions } else { Vec::new() },
        })))
    }
}
