//! What ranks do around the generations of a run: rank 0 gives the run to the others, and all meet before each generation.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::Error;
use crate::ranks::exchange::{Meeting, Order, Status};
use crate::ranks::facts::{self, Facts};
use crate::run::evaluations::Unfinished;
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::records::Checkpoint;
use crate::run::told::Told;
use crate::store::directory::Directory;
use crate::store::sealed;

/// What the other ranks need to go on with a run; none where there are no others.
///
/// # Errors
/// Those of [`Told::content`] and [`Plan::to_toml`].
pub(crate) fn order(
    plan: &Plan<'_>,
    directory: &Directory,
    pool: &Pool<'_>,
    checkpoint: &Checkpoint,
) -> Result<Option<Order>, Error> {
    if pool.exchange().is_alone() {
        return Ok(None);
    }
    Ok(Some(Order::Run {
        directory: directory.path().display().to_string(),
        config: plan.to_toml()?,
        checkpoint: sealed::to_bytes(&directory.checkpoint(), checkpoint)?,
        record: Told::content(directory, checkpoint)?,
    }))
}

/// What must be the same on all ranks of a run.
///
/// # Errors
/// Those of [`Plan::identity`].
pub(crate) fn facts(plan: &Plan<'_>) -> Result<Facts, Error> {
    Ok(facts::of_run(&plan.identity()?, plan.definition().name(), plan.generations()?))
}

/// Has the other ranks follow, if there is an order for them, while `work` leads; however it ends, they hear of it.
///
/// # Errors
/// Those of `work`, and [`Error::Rank`].
pub(crate) fn lead<'e>(
    pool: &mut Pool<'e>,
    order: Option<Order>,
    facts: Facts,
    work: impl FnOnce(&mut Pool<'e>) -> Result<(), Error>,
) -> Result<(), Error> {
    let Some(order) = order else { return work(pool) };
    let exchange = pool.exchange();
    exchange.order(Some(&order))?;
    drop(order);
    let result = exchange.begin(Ok(facts)).and_then(|()| work(pool));
    let status = match &result {
        Ok(()) | Err(Error::Interrupted { .. }) => Status::Over,
        Err(error) => Status::failed(error),
    };
    leave(pool, &status).and(result)
}

/// The meeting before a generation: whether all ranks go on.
///
/// # Errors
/// [`Unfinished::Stopped`] when one does not, [`Unfinished::Error`] when one has failed.
pub(crate) fn meet(pool: &Pool<'_>, stop: &AtomicBool) -> Result<(), Unfinished> {
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
pub(crate) fn leave(pool: &Pool<'_>, status: &Status) -> Result<(), Error> {
    let exchange = pool.exchange();
    if exchange.next() == Meeting::Outcomes {
        pool.withdraw(status)?;
    }
    if exchange.next() == Meeting::Status {
        return match exchange.status(status) {
            Err(Error::Rank { .. }) | Ok(_) => Ok(()),
            Err(error) => Err(error),
        };
    }
    Ok(())
}
