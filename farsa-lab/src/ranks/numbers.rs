//! Which evaluations a rank does: all that are left, or the blocks that rank 0 gives it.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The numbers of evaluations, each drawn once by one of the threads of all ranks.
pub(crate) enum Numbers {
    /// From 0 to a count: in one process, and on rank 0, where blocks of them are given away.
    Counted { count: usize, drawn: AtomicUsize },
    /// Those of the blocks that rank 0 has given.
    Assigned(AssignedBlocks),
}

/// Two blocks, and who waits for them.
#[derive(Default)]
pub(crate) struct AssignedBlocks {
    blocks: Mutex<Blocks>,
    /// A block has come, or none will.
    filled: Condvar,
    /// There is room for a block.
    wanted: Condvar,
}

/// The block that is drawn from, and one in reserve: while an answer is awaited nobody has to wait for it.
#[derive(Default)]
struct Blocks {
    left: Range<usize>,
    reserve: Range<usize>,
    /// Whether no other will come.
    last: bool,
}

impl Numbers {
    /// All numbers below a count.
    pub(crate) fn counted(count: usize) -> Self {
        Self::Counted { count, drawn: AtomicUsize::new(0) }
    }

    /// The next number, waiting for it if it must; none when nothing is left.
    pub(crate) fn draw(&self) -> Option<usize> {
        match self {
            Self::Counted { count, drawn } => {
                Some(drawn.fetch_add(1, Ordering::Relaxed)).filter(|number| number < count)
            }
            Self::Assigned(given) => given.draw(),
        }
    }

    /// A block of at most `wanted` numbers to give away, empty when nothing is left. Towards the end blocks become smaller, so
    /// that `ranks` of them finish at about the same time.
    pub(crate) fn block(&self, wanted: usize, ranks: usize) -> Range<usize> {
        let Self::Counted { count, drawn } = self else { return 0..0 };
        let left = count.saturating_sub(drawn.load(Ordering::Relaxed));
        let size = (left / (4 * ranks.max(1))).clamp(1, wanted.max(1));
        let first = drawn.fetch_add(size, Ordering::Relaxed).min(*count);
        first..(first + size).min(*count)
    }

    /// Nobody draws another number.
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
        // Blocks are whole at any time.
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

    /// Waits until there is room for a block, for a time at most, and says whether there is.
    pub(crate) fn wants(&self, longest: Duration) -> bool {
        let blocks = self.lock();
        if blocks.reserve.is_empty() {
            return true;
        }
        let waited = self.wanted.wait_timeout(blocks, longest).unwrap_or_else(PoisonError::into_inner);
        waited.0.reserve.is_empty()
    }

    /// Takes a block for which there is room; an empty one is the last.
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
        // Another one in reserve.
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
