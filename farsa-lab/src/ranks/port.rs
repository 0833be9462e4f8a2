//! What is asked of a library that passes messages, and one process.

use crate::error::Error;

/// Processes that run one command together, each with a number.
///
/// [`all_gather`](Self::all_gather) and [`split`](Self::split) are collective: every rank calls them in the same order. Two small
/// messages from one rank to another arrive in their order, and none is under way when a collective call begins. All calls come
/// from one thread.
pub trait Ranks {
    /// The number of this process, from 0.
    fn rank(&self) -> usize;

    /// How many processes there are, at least one.
    fn size(&self) -> usize;

    /// Gives every rank the bytes of all, in the order of their numbers. It waits for the slowest rank without keeping a
    /// processor busy.
    ///
    /// # Errors
    /// [`Error::Other`] when a rank is lost, unless that ends this process as well.
    fn all_gather(&self, bytes: &[u8]) -> Result<Vec<Vec<u8>>, Error>;

    /// Sends a small message to another rank, without waiting until it is received.
    ///
    /// # Errors
    /// As [`all_gather`](Self::all_gather).
    fn send(&self, to: usize, message: [u64; 2]) -> Result<(), Error>;

    /// The next small message and who sent it, if one has come.
    ///
    /// # Errors
    /// As [`all_gather`](Self::all_gather).
    fn receive(&self) -> Result<Option<(usize, [u64; 2])>, Error>;

    /// The ranks that name the same group as this one, numbered from 0 in the order that they have here.
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
