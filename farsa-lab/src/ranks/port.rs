//! Interface to a message-passing library, and its implementation for one process.

use crate::error::Error;

/// Processes that run one command together, each with a number.
///
/// [`all_gather`](Self::all_gather) and [`split`](Self::split) are collective: every rank calls them in the same order. Two small
/// messages between the same ranks arrive in order, and none is in transit when a collective call begins. All calls come from one
/// thread.
pub trait Ranks {
    /// Gets the number of this process, from 0.
    fn rank(&self) -> usize;

    /// Gets the number of processes, at least one.
    fn size(&self) -> usize;

    /// Sends the bytes of every rank to all ranks, in the order of their numbers. The call waits for the slowest rank without
    /// occupying a processor.
    ///
    /// # Errors
    /// [`Error::Other`] when a rank is lost, unless this process ends as well.
    fn all_gather(&self, bytes: &[u8]) -> Result<Vec<Vec<u8>>, Error>;

    /// Sends a small message to another rank and returns at once.
    ///
    /// # Errors
    /// As [`all_gather`](Self::all_gather).
    fn send(&self, to: usize, message: [u64; 2]) -> Result<(), Error>;

    /// Returns the next small message with its sender, if one has arrived.
    ///
    /// # Errors
    /// As [`all_gather`](Self::all_gather).
    fn receive(&self) -> Result<Option<(usize, [u64; 2])>, Error>;

    /// Returns the ranks with the same group number, numbered from 0 in their order.
    ///
    /// # Errors
    /// As [`all_gather`](Self::all_gather).
    fn split(&self, group: usize) -> Result<Box<dyn Ranks + '_>, Error>;
}

/// One process.
#[derive(Debug, Clone, Copy, Default)]
pub struct Alone;

impl Ranks for Alone {
    fn rank(&self) -> usize {
        0
    }
    fn size(&self) -> usize {
        1
    }
    fn all_gather(&self, bytes: &[u8]) -> Result<Vec<Vec<u8>>, Error> {
        Ok(vec![bytes.to_vec()])
    }
    fn send(&self, _: usize, _: [u64; 2]) -> Result<(), Error> {
        Ok(())
    }
    fn receive(&self) -> Result<Option<(usize, [u64; 2])>, Error> {
        Ok(None)
    }
    fn split(&self, _: usize) -> Result<Box<dyn Ranks + '_>, Error> {
        Ok(Box::new(Self))
    }
}
