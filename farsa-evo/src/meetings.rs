//! Whom the individuals of co-evolving populations meet.

use alloc::vec::Vec;

use crate::gene::Gene;

/// The ability to say whom each individual of a generation meets, [`Strategy::meetings`](crate::Strategy::meetings): for
/// strategies of several populations that are told what was earned against each opponent.
///
/// Such a strategy is judged by 1 + m objectives for m opponents: the fitness of all trials, and then the fitness of the trials
/// against each opponent, in their order. In trial `t` an individual meets the opponent of number `t` modulo m, so that there
/// have to be m trials or more.
pub trait Meetings<G: Gene = u16> {
    /// Number of opponents m that each individual of a generation meets, at least 1.
    fn count(&self) -> usize;

    /// The genomes that an individual of the generation that waits for its fitness meets in the trials of an opponent: one of each
    /// other population, in the order of the populations. Individuals are counted through all populations, opponents from 0
    /// to m - 1; nobody is met beyond the last of either.
    fn met(&self, individual: usize, opponent: usize) -> Vec<&[G]>;
}
