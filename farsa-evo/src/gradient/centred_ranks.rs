//! Ranks from -1/2 to 1/2.

use alloc::vec;
use alloc::vec::Vec;

use super::utilities::ranking;
use crate::fitness::Fitness;

/// The rank of each individual, spaced evenly from 1/2 for the best to -1/2 for the worst; equals by index.
///
/// Source: \[Salimans2017\] section 2 names them; the spacing is that of its authors' program.
pub(super) fn centred_ranks(fitness: &[Fitness]) -> Vec<f64> {
    let last = fitness.len().saturating_sub(1).max(1) as f64;
    let mut ranks = vec![0.0; fitness.len()];
    for (place, individual) in ranking(fitness).into_iter().enumerate() {
        if let Some(rank) = ranks.get_mut(individual) {
            *rank = 0.5 - place as f64 / last;
        }
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_spaced_evenly() {
        let told = [2.0, f64::NAN, 7.0, 2.0, 1.0].map(Fitness::nan_as_failed);
        assert_eq!(centred_ranks(&told), [0.25, -0.5, 0.5, 0.0, -0.25]);
        assert_eq!(centred_ranks(&told[..1]), [0.5]);
    }
}
