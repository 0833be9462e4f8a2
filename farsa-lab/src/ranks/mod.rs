//! Ranks: processes that evaluate the trials of one run together. Each rank holds the whole search, so genomes are never sent.

/// Blocks of evaluations, requested by workers and assigned by rank 0.
#[cfg(feature = "command")]
pub(crate) mod dealing;
/// Messages of all ranks in a generation, in a fixed order.
#[cfg(feature = "command")]
pub(crate) mod exchange;
/// Values that must be equal on all ranks.
#[cfg(feature = "command")]
pub(crate) mod facts;
/// Evaluations of a rank: all that are left, or the blocks assigned by rank 0.
#[cfg(feature = "command")]
pub(crate) mod numbers;
mod port;
/// Ranks that are threads of a test.
#[cfg(test)]
#[cfg(feature = "command")]
pub(crate) mod threads;
/// Bytes of messages.
pub(crate) mod wire;

pub use port::{Alone, Ranks};
