//! What all ranks tell each other, in an order that none can leave.
//!
//! Between the order that begins a run and the status that ends it, ranks meet twice in each generation: with a status before it,
//! and with the outcomes of their trials in it. Who has an error says so at the next meeting, so nobody waits for one who has left.

use std::cell::Cell;
use std::fs;

use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::experiment::outcome::Outcome;
use crate::ranks::facts::{self, Facts};
use crate::ranks::port::{Alone, Ranks};
use crate::ranks::wire::{Outcomes, from_bytes, to_bytes};

/// Ranks, and where they will meet next.
pub(crate) struct Exchange<'r> {
    ranks: &'r dyn Ranks,
    next: Cell<SyncPoint>,
    /// A fingerprint of what this rank evaluates, to be compared when outcomes are exchanged.
    fingerprint: Cell<Option<u64>>,
    /// Whether nothing was compared yet in this run.
    fresh: Cell<bool>,
}

/// Where ranks meet next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SyncPoint {
    /// They wait for an order of rank 0.
    WorkerCommand,
    Status,
    Outcomes,
}

/// How a rank is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Status {
    /// It wants to go on.
    GoOn,
    /// The user or the system has asked it to stop.
    Stop,
    /// The run is over, says rank 0.
    Over,
    /// It has an error: the exit code and the message.
    Failed(u8, String),
}

impl Status {
    /// That of a rank on which something went wrong.
    pub(crate) fn failed(error: &Error) -> Self {
        Self::Failed(error.exit_code(), error.to_string())
    }
}

/// What rank 0 wants of the others.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum WorkerCommand {
    /// A run from where its files say that it is.
    Run {
        /// The run's directory, for messages.
        directory: String,
        /// The content of `config.toml`.
        config: String,
        /// The content of `checkpoint.bin`.
        checkpoint: Vec<u8>,
        /// The content of `record.bin`, up to the checkpoint.
        record: Vec<u8>,
    },
    /// To end with this exit code.
    End(u8),
}

/// The outcomes of a rank, or why there are too few.
#[derive(Serialize, Deserialize)]
struct Report {
    status: Status,
    fingerprint: Option<u64>,
    outcomes: Outcomes,
}

/// Outcomes with their numbers, in any order; none for an evaluation that was left out.
pub(crate) type Numbered = (usize, Option<Outcome>);

impl Default for Exchange<'_> {
    fn default() -> Self {
        Self::new(&Alone)
    }
}

impl<'r> Exchange<'r> {
    /// Ranks that have not begun anything.
    pub(crate) fn new(ranks: &'r dyn Ranks) -> Self {
        Self { ranks, next: Cell::new(SyncPoint::WorkerCommand), fingerprint: Cell::new(None), fresh: Cell::new(true) }
    }

    pub(crate) fn ranks(&self) -> &'r dyn Ranks {
        self.ranks
    }

    /// Whether there is nobody to exchange anything with.
    pub(crate) fn is_alone(&self) -> bool {
        self.ranks.size() == 1
    }

    /// Whether this rank does what rank 0 says.
    pub(crate) fn is_follower(&self) -> bool {
        self.ranks.rank() > 0
    }

    /// Where the others are expected next.
    pub(crate) fn next(&self) -> SyncPoint {
        self.next.get()
    }

    fn gather<T: Serialize + for<'a> Deserialize<'a>>(&self, own: &T) -> Result<Vec<T>, Error> {
        let all = self.ranks.all_gather(&to_bytes(own)?)?;
        all.iter().enumerate().map(|(rank, bytes)| from_bytes(rank, bytes)).collect()
    }

    /// How many ranks share the processors of this one, itself included: those of its machine that may run on the same ones.
    ///
    /// # Errors
    /// Those of the ranks' messages.
    pub(crate) fn sharing(&self) -> Result<usize, Error> {
        if self.is_alone() {
            return Ok(1);
        }
        let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
        let status = read("/proc/self/status");
        let processors = status.lines().find(|line| line.starts_with("Cpus_allowed_list:")).unwrap_or_default();
        let own = format!("{}{processors}", read("/proc/sys/kernel/hostname"));
        Ok(self.gather(&own)?.into_iter().filter(|other| *other == own).count())
    }

    /// Says whether a command can begin here, and with which facts.
    ///
    /// # Errors
    /// [`Error::Rank`] for the first rank that cannot, or has other facts than rank 0; on the rank itself its own error.
    pub(crate) fn begin(&self, own: Result<Facts, Error>) -> Result<(), Error> {
        if self.is_alone() {
            return own.map(drop);
        }
        let next = self.next.replace(SyncPoint::WorkerCommand);
        let (status, facts) = match &own {
            Ok(facts) => (Status::GoOn, facts.clone()),
            Err(error) => (Status::failed(error), Facts::new()),
        };
        let all: Vec<(Status, Facts)> = self.gather(&(status, facts))?;
        let (statuses, facts): (Vec<Status>, Vec<Facts>) = all.into_iter().unzip();
        own?;
        first_failed(&statuses)?;
        facts::same(&facts)?;
        self.next.set(next);
        Ok(())
    }

    /// Gives everybody the order of rank 0.
    pub(crate) fn command(&self, own: Option<&WorkerCommand>) -> Result<WorkerCommand, Error> {
        let bytes = own.map(to_bytes).transpose()?.unwrap_or_default();
        let all = self.ranks.all_gather(&bytes)?;
        let order = from_bytes(0, all.first().map_or(&[], Vec::as_slice))?;
        self.fresh.set(true);
        self.next.set(if matches!(order, WorkerCommand::Run { .. }) {
            SyncPoint::Status
        } else {
            SyncPoint::WorkerCommand
        });
        Ok(order)
    }

    /// Says how this rank is, and returns how all are: all want to go on, one wants to stop, or rank 0 says that the run is over.
    ///
    /// # Errors
    /// [`Error::Rank`] for the first rank that failed. Then, and unless all go on, everybody waits for an order.
    pub(crate) fn status(&self, own: &Status) -> Result<Status, Error> {
        self.next.set(SyncPoint::WorkerCommand);
        let all = self.gather(own)?;
        first_failed(&all)?;
        let said = |status: Status| all.contains(&status).then_some(status);
        let found = said(Status::Over).or_else(|| said(Status::Stop)).unwrap_or(Status::GoOn);
        if found == Status::GoOn {
            self.next.set(SyncPoint::Outcomes);
        }
        Ok(found)
    }

    /// In the first generation of a run and in every so many, has a fingerprint compared with those of the others when outcomes are
    /// exchanged.
    pub(crate) fn compare_first_and_every(&self, generation: u32, each: u32, fingerprint: impl FnOnce() -> u64) {
        if self.fresh.take() || generation.is_multiple_of(each) {
            self.fingerprint.set(Some(fingerprint()));
        }
    }

    /// Gives everybody the outcomes of all; none when one rank was told to stop.
    ///
    /// # Errors
    /// [`Error::Rank`] for the first rank that failed or evaluated something else than rank 0; on the rank itself its own error.
    pub(crate) fn outcomes(
        &self,
        own: Result<Vec<Numbered>, Error>,
        stop: bool,
    ) -> Result<Option<Vec<Numbered>>, Error> {
        self.next.set(SyncPoint::Status);
        let status = match &own {
            Ok(_) if stop => Status::Stop,
            Ok(_) => Status::GoOn,
            Err(error) => Status::failed(error),
        };
        let fingerprint = self.fingerprint.take();
        let outcomes = Outcomes::from_numbered(own.as_deref().unwrap_or_default());
        let own_rank = self.ranks.rank();
        let all = self.gather(&Report { status, fingerprint, outcomes })?;
        let own = own?;
        let statuses: Vec<Status> = all.iter().map(|report| report.status.clone()).collect();
        first_failed(&statuses)?;
        let first = all.first().and_then(|report| report.fingerprint);
        if let Some(rank) = all.iter().position(|report| report.fingerprint != first) {
            let why = "its individuals or their opponents are not those of rank 0".into();
            return Err(Error::Rank { rank, code: 1, why });
        }
        if statuses.contains(&Status::Stop) {
            return Ok(None);
        }
        let mut numbered = own;
        for (rank, report) in all.into_iter().enumerate().filter(|(rank, _)| *rank != own_rank) {
            let why = "said what this program cannot read: a note without a name, or observations that are none".into();
            numbered.extend(report.outcomes.into_numbered().ok_or(Error::Rank { rank, code: 1, why })?);
        }
        Ok(Some(numbered))
    }

    /// Says that this rank has no outcomes, and why.
    ///
    /// # Errors
    /// Those of the ranks' messages.
    pub(crate) fn no_outcomes(&self, status: &Status) -> Result<(), Error> {
        self.next.set(SyncPoint::Status);
        let report =
            Report { status: status.clone(), fingerprint: self.fingerprint.take(), outcomes: Outcomes::default() };
        self.ranks.all_gather(&to_bytes(&report)?).map(drop)
    }
}

/// The error of the first rank that has one.
fn first_failed(all: &[Status]) -> Result<(), Error> {
    let failed = all.iter().enumerate().find_map(|(rank, status)| match status {
        Status::Failed(code, why) => Some(Error::Rank { rank, code: *code, why: why.clone() }),
        _ => None,
    });
    failed.map_or(Ok(()), Err)
}
