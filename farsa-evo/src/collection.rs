//! What a strategy keeps beyond its generation.

use alloc::vec::Vec;

/// An individual that a strategy keeps: an elite of an archive, or a member of a front.
///
/// Where it comes from, its generation and index, is enough to find its genes in a [`Record`](crate::Record).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Member<'a> {
    /// The number of its cell, where there are cells.
    pub cell: Option<usize>,
    /// Its objectives \[m\], in the experiment's own units.
    pub objectives: &'a [f64],
    /// Its behaviour descriptor \[d\].
    pub descriptor: &'a [f64],
    /// The generation in which it was evaluated.
    pub generation: u32,
    /// Its index in that generation, counted through all populations.
    pub individual: usize,
}

/// The ability to keep individuals beyond their generation: an archive of elites, or the front of several objectives.
pub trait Collection {
    /// All that are kept, in an order that says nothing.
    fn members(&self) -> Vec<Member<'_>>;
}
