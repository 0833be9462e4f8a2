//! Who comes before whom.

use alloc::vec::Vec;
use core::cmp::Reverse;

use crate::fitness::Fitness;

/// The individuals, best first, equals by index.
pub(crate) fn ranking(fitness: &[Fitness]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..fitness.len()).collect();
    order.sort_by_key(|&individual| Reverse(fitness.get(individual)));
    order
}
