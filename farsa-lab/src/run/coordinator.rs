//! What ranks do around the generations of a run: rank 0 gives the run to the others, and all meet before each generation.

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

/// What the other ranks need to go on with a run; none where there are no others.
///
/// # Errors
/// Those of [`RunRecord::content`] and [`Plan::to_toml`].
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

/// What must be the same on all ranks of a run.
///
/// # Errors
/// Those of [`Plan::identity`].
pub(crate) fn facts(plan: &Plan<'_>) -> Result<Facts, Error> {
    Ok(facts::of_run(&plan.identity()?, plan.definition().name(), plan.generations()?))
}

/// Has the other ranks follow, if there is an command for them, while `work` leads; however it ends, they hear of it.
///
/// # Errors
/// Those of `work`, and [`Error::Rank`].
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

/// The meeting before a generation: whether all ranks go on.
///
/// # Errors
/// [`Unfinished::Stopped`] when one does not, [`Unfinished::Error`] when one has failed.
pub(crate) fn barrier(pool: &Pool<'_>, stop: &AtomicBool) -> Result<(), Unfinished> {
    let exchange = pool.exchange();
    if exchange.is_alone() {
        return Ok(());
    }
    let own = if stop.load(Ordering::Relaxed) { Status::Stop } else { Status::GoOn };
    match exchange.status(&own)? {
        Status::GoOn => Ok(()),
        _ => Err(Unfinished::Stopped),
    }
}

/// Takes part in the meetings that the other ranks still expect of one that goes on no more.
///
/// # Errors
/// Those of the ranks' messages; that of another rank is not repeated.
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
