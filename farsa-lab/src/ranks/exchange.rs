//! Messages of all ranks, in a fixed order.
//!
//! A run begins with a command and ends with a status. In each generation all ranks synchronize twice: they exchange a status
//! before it and the outcomes of their trials in it. A rank with an error reports it at the next synchronization point, so no
//! rank waits for one that has ended.

use std::cell::Cell;
use std::fs;

use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::experiment::outcome::Outcome;
use crate::ranks::facts::{self, Facts};
use crate::ranks::port::{Alone, Ranks};
use crate::ranks::wire::{Outcomes, from_bytes, to_bytes};

/// Ranks and their next synchronization point.
pub(crate) struct Exchange<'r> {
    ranks: &'r dyn Ranks,
    next: Cell<SyncPoint>,
    /// A fingerprint of the evaluations of this rank, compared when outcomes are exchanged.
    fingerprint: Cell<Option<u64>>,
    /// True if no fingerprint was compared yet in this run.
    fresh: Cell<bool>,
}

/// A synchronization point of all ranks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SyncPoint {
    /// The workers wait for a command of rank 0.
    WorkerCommand,
    Status,
    Outcomes,
}

/// Status of a rank.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Status {
    /// The rank is ready for another generation.
    GoOn,
    /// The user or the system has asked the rank to stop.
    Stop,
    /// The run is over. Only rank 0 sends this status.
    Over,
    /// An error, with the exit code and the message.
    Failed(u8, String),
}

impl Status {
    /// Creates the status of a rank with an error.
    pub(crate) fn failed(error: &Error) -> Self {
        Self::Failed(error.exit_code(), error.to_string())
    }
}

/// A command of rank 0.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum WorkerCommand {
    /// Continues a run from its checkpoint.
    Run {
        /// Run's directory, for messages.
        directory: String,
        /// Content of `config.toml`.
        config: String,
        /// Content of `checkpoint.bin`.
        checkpoint: Vec<u8>,
        /// Content of `record.bin`, up to the checkpoint.
        record: Vec<u8>,
    },
    /// Ends with this exit code.
    End(u8),
}

/// Outcomes of a rank, or the reason for missing ones.
#[derive(Serialize, Deserialize)]
struct Report {
    status: Status,
    fingerprint: Option<u64>,
    outcomes: Outcomes,
}

/// Outcomes with their numbers, in any order. `None` is an evaluation that was left out.
pub(crate) type Numbered = (usize, Option<Outcome>);

impl Default for Exchange<'_> {
    fn default() -> Self {
        Self::new(&Alone)
    }
}

impl<'r> Exchange<'r> {
    /// Creates the exchange of ranks before their first command.
    pub(crate) fn new(ranks: &'r dyn Ranks) -> Self {
        Self { ranks, next: Cell::new(SyncPoint::WorkerCommand), fingerprint: Cell::new(None), fresh: Cell::new(true) }
    }

    pub(crate) fn ranks(&self) -> &'r dyn Ranks {
        self.ranks
    }

    /// Checks whether there is only one rank.
    pub(crate) fn is_alone(&self) -> bool {
        self.ranks.size() == 1
    }

    /// Checks whether this rank is a worker.
    pub(crate) fn is_follower(&self) -> bool {
        self.ranks.rank() > 0
    }

    /// Gets the next synchronization point.
    pub(crate) fn next(&self) -> SyncPoint {
        self.next.get()
    }

    fn gather<T: Serialize + for<'a> Deserialize<'a>>(&self, local: &T) -> Result<Vec<T>, Error> {
        let gathered = self.ranks.all_gather(&to_bytes(local)?)?;
        gathered.iter().enumerate().map(|(rank, bytes)| from_bytes(rank, bytes)).collect()
    }

    /// Returns the number of ranks that share the processors of this one, itself included.
    ///
    /// # Errors
    /// The errors of the ranks' messages.
    pub(crate) fn sharing(&self) -> Result<usize, Error> {
        if self.is_alone() {
            return Ok(1);
        }
        let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
        let status = read("/proc/self/status");
        let processors = status.lines().find(|line| line.starts_with("Cpus_allowed_list:")).unwrap_or_default();
        let local = format!("{}{processors}", read("/proc/sys/kernel/hostname"));
        Ok(self.gather(&local)?.into_iter().filter(|other| *other == local).count())
    }

    /// Reports whether a command can begin on this rank, and with which facts.
    ///
    /// # Errors
    /// [`Error::Rank`] for the first rank that cannot begin or has other facts than rank 0. On that rank its own error.
    pub(crate) fn begin(&self, local: Result<Facts, Error>) -> Result<(), Error> {
        if self.is_alone() {
            return local.map(drop);
        }
        let next = self.next.replace(SyncPoint::WorkerCommand);
        let (status, facts) = match &local {
            Ok(facts) => (Status::GoOn, facts.clone()),
            Err(error) => (Status::failed(error), Facts::new()),
        };
        let gathered: Vec<(Status, Facts)> = self.gather(&(status, facts))?;
        let (statuses, facts): (Vec<Status>, Vec<Facts>) = gathered.into_iter().unzip();
        local?;
        first_failed(&statuses)?;
        facts::same(&facts)?;
        self.next.set(next);
        Ok(())
    }

    /// Sends the command of rank 0 to all ranks.
    pub(crate) fn command(&self, local: Option<&WorkerCommand>) -> Result<WorkerCommand, Error> {
        let bytes = local.map(to_bytes).transpose()?.unwrap_or_default();
        let gathered = self.ranks.all_gather(&bytes)?;
        let order = from_bytes(0, gathered.first().map_or(&[], Vec::as_slice))?;
        self.fresh.set(true);
        self.next.set(if matches!(order, WorkerCommand::Run { .. }) {
            SyncPoint::Status
        } else {
            SyncPoint::WorkerCommand
        });
        Ok(order)
    }

    /// Reports the status of this rank and returns that of all: `Over` if rank 0 reports it, else `Stop` if any rank does, else
    /// `GoOn`.
    ///
    /// # Errors
    /// [`Error::Rank`] for the first rank that failed. Unless all ranks continue, the next synchronization point is a command.
    pub(crate) fn status(&self, local: &Status) -> Result<Status, Error> {
        self.next.set(SyncPoint::WorkerCommand);
        let gathered = self.gather(local)?;
        first_failed(&gathered)?;
        let reported = |status: Status| gathered.contains(&status).then_some(status);
        let status = reported(Status::Over).or_else(|| reported(Status::Stop)).unwrap_or(Status::GoOn);
        if status == Status::GoOn {
            self.next.set(SyncPoint::Outcomes);
        }
        Ok(status)
    }

    /// Sets a fingerprint to compare at the next exchange of outcomes, in the first generation of a run and in every `each`th.
    pub(crate) fn compare_first_and_every(&self, generation: u32, each: u32, fingerprint: impl FnOnce() -> u64) {
        if self.fresh.take() || generation.is_multiple_of(each) {
            self.fingerprint.set(Some(fingerprint()));
        }
    }

    /// Exchanges the outcomes of all ranks. The result is `None` if a rank was stopped.
    ///
    /// # Errors
    /// [`Error::Rank`] for the first rank that failed or evaluated other individuals than rank 0. On that rank its own error.
    pub(crate) fn outcomes(
        &self,
        local: Result<Vec<Numbered>, Error>,
        stop: bool,
    ) -> Result<Option<Vec<Numbered>>, Error> {
        self.next.set(SyncPoint::Status);
        let status = match &local {
            Ok(_) if stop => Status::Stop,
            Ok(_) => Status::GoOn,
            Err(error) => Status::failed(error),
        };
        let fingerprint = self.fingerprint.take();
        let outcomes = Outcomes::from_numbered(local.as_deref().unwrap_or_default());
        let own_rank = self.ranks.rank();
        let gathered = self.gather(&Report { status, fingerprint, outcomes })?;
        let local = local?;
        let statuses: Vec<Status> = gathered.iter().map(|report| report.status.clone()).collect();
        first_failed(&statuses)?;
        let first = gathered.first().and_then(|report| report.fingerprint);
        if let Some(rank) = gathered.iter().position(|report| report.fingerprint != first) {
            let why = "its individuals or their opponents are not those of rank 0".into();
            return Err(Error::Rank { rank, code: 1, why });
        }
        if statuses.contains(&Status::Stop) {
            return Ok(None);
        }
        let mut numbered = local;
        for (rank, report) in gathered.into_iter().enumerate().filter(|(rank, _)| *rank != own_rank) {
            let why = "said what this program cannot read: a note without a name, or observations that are none".into();
            numbered.extend(report.outcomes.into_numbered().ok_or(Error::Rank { rank, code: 1, why })?);
        }
        Ok(Some(numbered))
    }

    /// Reports that this rank has no outcomes, with the reason.
    ///
    /// # Errors
    /// The errors of the ranks' messages.
    pub(crate) fn no_outcomes(&self, status: &Status) -> Result<(), Error> {
        self.next.set(SyncPoint::Status);
        let report =
            Report { status: status.clone(), fingerprint: self.fingerprint.take(), outcomes: Outcomes::default() };
        self.ranks.all_gather(&to_bytes(&report)?).map(drop)
    }
}

/// Returns the error of the first rank that has one.
fn first_failed(all: &[Status]) -> Result<(), Error> {
    let failed = all.iter().enumerate().find_map(|(rank, status)| match status {
        Status::Failed(code, why) => Some(Error::Rank { rank, code: *code, why: why.clone() }),
        _ => None,
    });
    failed.map_or(Ok(()), Err)
}
