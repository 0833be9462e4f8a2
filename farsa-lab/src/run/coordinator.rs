//! Rank 0 of a run: it sends commands to the workers and synchronizes all ranks.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::Error;
use crate::ranks::exchange::{Status, SyncPoint, WorkerCommand};
use crate::ranks::facts::{self, Facts};
use crate::run::evaluation_backend::Unfinished;
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::record_file::RunRecord;
use crate::run::records::Checkpoint;
use crate::store::checksummed;
use crate::store::directory::Directory;

/// Returns the command that continues a run on the workers, or `None` without workers.
///
/// # Errors
/// The errors of [`RunRecord::content`] and [`Plan::to_toml`].
pub(crate) fn run_command(
    plan: &Plan<'_>,
    directory: &Directory,
    pool: &Pool<'_>,
    checkpoint: &Checkpoint,
) -> Result<Option<WorkerCommand>, Error> {
    if pool.exchange().is_alone() {
        return Ok(None);
    }
    Ok(Some(WorkerCommand::Run {
        directory: directory.path().display().to_string(),
        config: plan.to_toml()?,
        checkpoint: checksummed::to_bytes(&directory.checkpoint(), checkpoint)?,
        record: RunRecord::content(plan, directory, checkpoint)?,
    }))
}

/// Returns the values of a run that must be equal on all ranks.
///
/// # Errors
/// The errors of [`Plan::identity`].
pub(crate) fn facts(plan: &Plan<'_>) -> Result<Facts, Error> {
    Ok(facts::of_run(&plan.identity()?, plan.definition().name(), plan.generations()?))
}

/// Runs `work` while the workers execute a command, if there is one, and sends them the final status.
///
/// # Errors
/// The errors of `work`, and [`Error::Rank`].
pub(crate) fn coordinate<'e>(
    pool: &mut Pool<'e>,
    command: Option<WorkerCommand>,
    facts: Facts,
    work: impl FnOnce(&mut Pool<'e>) -> Result<(), Error>,
) -> Result<(), Error> {
    let Some(command) = command else { return work(pool) };
    let exchange = pool.exchange();
    exchange.command(Some(&command))?;
    drop(command);
    let result = exchange.begin(Ok(facts)).and_then(|()| work(pool));
    let status = match &result {
        Ok(()) | Err(Error::Interrupted { .. }) => Status::Over,
        Err(error) => Status::failed(error),
    };
    shut_down(pool, &status).and(result)
}

/// Synchronizes all ranks before a generation.
///
/// # Errors
/// [`Unfinished::Stopped`] when a rank stops, [`Unfinished::Error`] when one has failed.
pub(crate) fn barrier(pool: &Pool<'_>, stop: &AtomicBool) -> Result<(), Unfinished> {
    let exchange = pool.exchange();
    if exchange.is_alone() {
        return Ok(());
    }
    let status = if stop.load(Ordering::Relaxed) { Status::Stop } else { Status::GoOn };
    match exchange.status(&status)? {
        Status::GoOn => Ok(()),
        _ => Err(Unfinished::Stopped),
    }
}

/// Passes the synchronization points at which other ranks still expect this one, with its final status.
///
/// # Errors
/// The errors of the ranks' messages. The error of another rank is not repeated.
pub(crate) fn shut_down(pool: &Pool<'_>, status: &Status) -> Result<(), Error> {
    let exchange = pool.exchange();
    if exchange.next() == SyncPoint::Outcomes {
        pool.withdraw(status)?;
    }
    if exchange.next() == SyncPoint::Status {
        return match exchange.status(status) {
            Err(Error::Rank { .. }) | Ok(_) => Ok(()),
            Err(error) => Err(error),
        };
    }
    Ok(())
}
