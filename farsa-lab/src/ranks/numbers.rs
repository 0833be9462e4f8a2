//! Evaluations of a rank: all that are left, or the blocks assigned by rank 0.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Numbers of evaluations. Each number is drawn once by one thread of all ranks.
pub(crate) enum Numbers {
    /// From 0 to a count, in a single process and on rank 0, which assigns blocks of them.
    Counted { count: usize, drawn: AtomicUsize },
    /// Numbers of assigned blocks.
    Assigned(AssignedBlocks),
}

/// Two assigned blocks, with the threads that wait for them.
#[derive(Default)]
pub(crate) struct AssignedBlocks {
    blocks: Mutex<Blocks>,
    /// Signals a new block, or that there is no other.
    filled: Condvar,
    /// Signals space for a block.
    wanted: Condvar,
}

/// Current block and one in reserve, so that threads work while the next block is requested.
#[derive(Default)]
struct Blocks {
    left: Range<usize>,
    reserve: Range<usize>,
    /// True if this is the last block.
    last: bool,
}

impl Numbers {
    /// Returns all numbers below a count.
    pub(crate) fn counted(count: usize) -> Self {
        Self::Counted { count, drawn: AtomicUsize::new(0) }
    }

    /// Draws the next number and waits for it if necessary. The result is `None` when no number is left.
    pub(crate) fn draw(&self) -> Option<usize> {
        match self {
            Self::Counted { count, drawn } => {
                Some(drawn.fetch_add(1, Ordering::Relaxed)).filter(|number| number < count)
            }
            Self::Assigned(given) => given.draw(),
        }
    }

    /// Takes a block of at most `wanted` numbers to assign, empty when no number is left. Blocks become smaller towards the end,
    /// so that `ranks` ranks finish at about the same time.
    pub(crate) fn block(&self, wanted: usize, ranks: usize) -> Range<usize> {
        let Self::Counted { count, drawn } = self else { return 0..0 };
        let left = count.saturating_sub(drawn.load(Ordering::Relaxed));
        let size = (left / (4 * ranks.max(1))).clamp(1, wanted.max(1));
        let first = drawn.fetch_add(size, Ordering::Relaxed).min(*count);
        first..(first + size).min(*count)
    }

    /// Ends the drawing of numbers.
    pub(crate) fn close(&self) {
        match self {
            Self::Counted { count, drawn } => drawn.store(*count, Ordering::Relaxed),
            Self::Assigned(given) => {
                let mut blocks = given.lock();
                *blocks = Blocks { last: true, ..Blocks::default() };
                drop(blocks);
                given.filled.notify_all();
            }
        }
    }
}

impl AssignedBlocks {
    fn lock(&self) -> MutexGuard<'_, Blocks> {
        // Blocks are consistent at any time, so a poisoned lock is valid.
        self.blocks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn draw(&self) -> Option<usize> {
        let mut blocks = self.lock();
        loop {
            let found = blocks.left.next();
            if blocks.left.is_empty() && !blocks.reserve.is_empty() {
                blocks.left = std::mem::take(&mut blocks.reserve);
                self.wanted.notify_all();
            }
            if found.is_some() || blocks.last && blocks.left.is_empty() {
                return found;
            }
            if blocks.left.is_empty() {
                blocks = self.filled.wait(blocks).unwrap_or_else(PoisonError::into_inner);
            }
        }
    }

    /// Waits for space for a block, up to a time limit, and returns whether there is space.
    pub(crate) fn wants(&self, longest: Duration) -> bool {
        let blocks = self.lock();
        if blocks.reserve.is_empty() {
            return true;
        }
        let waited = self.wanted.wait_timeout(blocks, longest).unwrap_or_else(PoisonError::into_inner);
        waited.0.reserve.is_empty()
    }

    /// Adds a block. An empty block is the last.
    pub(crate) fn fill(&self, next: Range<usize>) {
        let mut blocks = self.lock();
        blocks.last |= next.is_empty();
        if blocks.left.is_empty() {
            blocks.left = next;
        } else {
            blocks.reserve = next;
        }
        drop(blocks);
        self.filled.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread;

    #[test]
    fn every_number_is_drawn_once() {
        let numbers = Numbers::counted(1000);
        let mut all: Vec<usize> = thread::scope(|scope| {
            let own: Vec<_> = (0..3).map(|_| scope.spawn(|| std::iter::from_fn(|| numbers.draw()).collect())).collect();
            let mut all: Vec<Vec<usize>> = vec![Vec::new()];
            loop {
                let block = numbers.block(16, 2);
                if block.is_empty() {
                    break;
                }
                all[0].extend(block);
            }
            all.extend(own.into_iter().map(|thread| thread.join().unwrap()));
            all.concat()
        });
        all.sort_unstable();
        assert_eq!(all, (0..1000).collect::<Vec<_>>());
        assert!(numbers.block(16, 2).is_empty() && numbers.draw().is_none());
    }

    #[test]
    fn blocks_become_smaller_towards_the_end() {
        let numbers = Numbers::counted(100);
        let sizes: Vec<usize> =
            std::iter::from_fn(|| Some(numbers.block(16, 2).len()).filter(|size| *size > 0)).collect();
        assert_eq!(
            sizes,
            [12, 11, 9, 8, 7, 6, 5, 5, 4, 4, 3, 3, 2, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]
        );
        assert_eq!(sizes.iter().sum::<usize>(), 100);
        assert_eq!(Numbers::counted(0).block(16, 2), 0..0);
    }

    #[test]
    fn what_is_given_is_drawn_and_then_asked_for() {
        let given = AssignedBlocks::default();
        assert!(given.wants(Duration::ZERO));
        given.fill(4..7);
        // One more block is in reserve.
        assert!(given.wants(Duration::ZERO));
        given.fill(8..9);
        assert!(!given.wants(Duration::ZERO));
        let numbers = Numbers::Assigned(given);
        let drawn = thread::scope(|scope| {
            let thread = scope.spawn(|| std::iter::from_fn(|| numbers.draw()).collect::<Vec<_>>());
            let Numbers::Assigned(given) = &numbers else { unreachable!() };
            while !given.wants(Duration::from_millis(1)) {}
            given.fill(9..10);
            while !given.wants(Duration::from_millis(1)) {}
            given.fill(0..0);
            thread.join().unwrap()
        });
        assert_eq!(drawn, [4, 5, 6, 8, 9]);
        let closed = Numbers::Assigned(AssignedBlocks::default());
        closed.close();
        assert_eq!(closed.draw(), None);
    }
}
