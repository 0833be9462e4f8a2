//! Blocks of evaluations between rank 0 and the workers.

use std::thread;
use std::time::{Duration, Instant};

use crate::error::Error;
use crate::ranks::numbers::{AssignedBlocks, Numbers};
use crate::ranks::port::Ranks;

/// A request for a block, with the number of evaluations that the rank runs at once. The answer is the first number of the block
/// and the number after its last. An empty block is the last.
const WANTED: u64 = 1;
/// End of a rank's requests in this generation, after a stop or an error. There is no answer.
const ENOUGH: u64 = 2;

/// Shortest and longest pause between two checks for messages.
const PAUSES: [Duration; 2] = [Duration::from_micros(20), Duration::from_millis(4)];
/// Interval at which a rank with blocks checks whether its round has to end.
const LOOK: Duration = Duration::from_millis(10);

/// Returns a pause that grows with the time waited. Quick answers arrive soon, and long waits cost little.
pub(crate) fn pause(since: Instant) -> Duration {
    (since.elapsed() / 8).clamp(PAUSES[0], PAUSES[1])
}

/// Assigns blocks to the workers until none requests more. After `ended` returns true, no more blocks are assigned.
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

/// Requests blocks of at most `most` evaluations until rank 0 has no more, or `ended` returns true.
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
