//! Searches over integer genes of 1 to 16 bits, and the numbers that these genes encode.
//!
//! [`decode`] and [`WordMap`] turn genes into parameters. [`TruncationGa`] and [`OnePlusOne`] search, and
//! [`RandomSearch`] is their baseline.

/// Linear decoding of genes.
mod decode;
/// Mutation of bits.
pub(crate) mod mutation;
/// One parent and one mutant.
mod one_plus_one;
/// Search without selection.
mod random_search;
/// Truncation selection.
mod truncation;
/// Encoding and decoding with bits, range and code of each parameter.
mod word_map;

pub use decode::{GeneRange, decode};
pub use mutation::{BitMutation, Mutation, randomize};
pub use one_plus_one::{OnePlusOne, OnePlusOneConfig};
pub use random_search::{BestIndividual, RandomSearch};
pub use truncation::{GaConfig, TruncationGa};
pub use word_map::{WordCode, WordGene, WordMap};
