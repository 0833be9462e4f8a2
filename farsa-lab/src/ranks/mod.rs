//! Ranks: processes that evaluate the trials of one run together. Each holds the whole search and asks it itself, so genomes
//! never travel.
//!
//! - `port`: what is asked of a library that passes messages, [`Ranks`], and one process, [`Alone`]
//! - `numbers`: which evaluations a rank does: all that are left, or the blocks that rank 0 gives it
//! - `dealing`: blocks between rank 0 and the others, asked for and given
//! - `exchange`: what all ranks tell each other in a generation, in an order that none can leave
//! - `wire`: the bytes of what they tell
//! - `facts`: what must be the same on all ranks, compared by name

#[cfg(feature = "command")]
pub(crate) mod dealing;
#[cfg(feature = "command")]
pub(crate) mod exchange;
#[cfg(feature = "command")]
pub(crate) mod facts;
#[cfg(feature = "command")]
pub(crate) mod numbers;
mod port;
#[cfg(test)]
#[cfg(feature = "command")]
pub(crate) mod threads;
pub(crate) mod wire;

pub use port::{Alone, Ranks};
