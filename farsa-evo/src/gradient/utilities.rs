//! Utilities: weights of individuals that depend on their rank alone.

use alloc::vec;
use alloc::vec::Vec;
use core::cmp::Reverse;

use farsa_num::ln;

use crate::fitness::Fitness;

/// The individuals, best first, equals by index.
pub(super) fn ranking(fitness: &[Fitness]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..fitness.len()).collect();
    order.sort_by_key(|&individual| Reverse(fitness.get(individual)));
    order
}

/// The utility of the individual of each rank, the best first; they sum to 0.
///
/// Source: \[Wierstra2014\] table 1, that of rank k is max(0, ln(lambda / 2 + 1) - ln k) / sum - 1 / lambda.
pub(super) fn utilities(population: usize) -> Vec<f64> {
    let count = population as f64;
    let raw = |rank: usize| (ln(0.5 * count + 1.0) - ln(rank as f64)).max(0.0);
    let sum: f64 = (1..=population).map(raw).sum();
    (1..=population).map(|rank| raw(rank) / sum - 1.0 / count).collect()
}

/// The utility of each individual.
pub(super) fn weights(fitness: &[Fitness], utilities: &[f64]) -> Vec<f64> {
    let mut weights = vec![0.0; fitness.len()];
    for (individual, utility) in ranking(fitness).into_iter().zip(utilities) {
        if let Some(weight) = weights.get_mut(individual) {
            *weight = *utility;
        }
    }
    weights
}

/// The population of natural evolution strategies over so many genes, 4 + floor(3 ln d).
pub(super) fn default_population(genes: usize) -> usize {
    4 + (3.0 * ln(genes as f64)) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utilities_favour_the_better_half() {
        let got = utilities(4);
        // ln 3, ln 1.5, 0, 0.
        let (a, b) = (1.0986122886681098, 0.4054651081081644);
        let want = [a / (a + b) - 0.25, b / (a + b) - 0.25, -0.25, -0.25];
        assert!(got.iter().zip(want).all(|(got, want)| (got - want).abs() < 1e-15), "{got:?}");
        let told = [1.0, f64::NAN, 3.0, 3.0].map(Fitness::nan_as_failed);
        assert_eq!(weights(&told, &got), [got[2], got[3], got[0], got[1]]);
        assert_eq!([1, 2, 10, 1000].map(default_population), [4, 6, 10, 24]);
    }
}
