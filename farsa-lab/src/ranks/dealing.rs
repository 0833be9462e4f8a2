//! Blocks of evaluations between rank 0 and the others: asked for when none is in reserve, given at once.

use std::thread;
use std::time::{Duration, Instant};

use crate::error::Error;
use crate::ranks::numbers::{AssignedBlocks, Numbers};
use crate::ranks::port::Ranks;

/// A rank wants a block: how many evaluations it takes at once. The answer is the first number of the block and the one after it;
/// an empty block is the last.
const WANTED: u64 = 1;
/// A rank wants no more in this generation, because it was told to stop or has an error. There is no answer.
const ENOUGH: u64 = 2;

/// The shortest and the longest pause between two looks for messages.
const PAUSES: [Duration; 2] = [Duration::from_micros(20), Duration::from_millis(4)];
/// How often a rank that has blocks looks whether its round cannot be finished.
const LOOK: Duration = Duration::from_millis(10);

/// A pause that grows with the time that was waited already: quick answers come soon, long waits cost nothing.
pub(crate) fn pause(since: Instant) -> Duration {
    (since.elapsed() / 8).clamp(PAUSES[0], PAUSES[1])
}

/// Rank 0 gives blocks to the others until all have had enough. Once `ended` says that the round cannot be finished, here or on
/// another rank, nothing more is given.
pub(crate) fn give(ranks: &dyn Ranks, numbers: &Numbers, ended: &dyn Fn() -> bool) -> Result<(), Error> {
    let mut others = ranks.size() - 1;
    let mut latest = Instant::now();
    while others > 0 {
        if ended() {
            numbers.close();
        }
        match ranks.receive()? {
            Some((from, [WANTED, most])) => {
                let most = usize::try_from(most).unwrap_or(usize::MAX);
                let block = numbers.block(most, ranks.size());
                others -= usize::from(block.is_empty());
                ranks.send(from, [block.start as u64, block.end as u64])?;
                latest = Instant::now();
            }
            Some((_, [ENOUGH, _])) => {
                others -= 1;
                numbers.close();
            }
            Some((from, [kind, _])) => return Err(Error::Other(format!("rank {from} sent a message of kind {kind}"))),
            None => thread::sleep(pause(latest)),
        }
    }
    Ok(())
}

/// Another rank takes blocks of at most `most` evaluations until rank 0 has no more, or `ended` says that the round cannot be
/// finished.
pub(crate) fn take(
    ranks: &dyn Ranks,
    given: &AssignedBlocks,
    most: usize,
    ended: &dyn Fn() -> bool,
) -> Result<(), Error> {
    while !ended() {
        if !given.wants(LOOK) {
            continue;
        }
        ranks.send(0, [WANTED, most as u64])?;
        let asked = Instant::now();
        let [first, last] = loop {
            match ranks.receive()? {
                Some((_, block)) => break block,
                None => thread::sleep(pause(asked)),
            }
        };
        given.fill(first as usize..last as usize);
        if first == last {
            return Ok(());
        }
    }
    given.fill(0..0);
    ranks.send(0, [ENOUGH, 0])
}
