//! Utilities, centered ranks and rewards, which replace the values of fitness.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::ln;

use super::settings::bounded;
use crate::fitness::Fitness;

/// The utility of the individual of each rank, the best first. Utilities sum to 0.
///
/// Source: \[Wierstra2014\] table 1, that of rank k is max(0, ln(lambda / 2 + 1) - ln k) / sum - 1 / lambda.
pub(super) fn utilities(population: usize) -> Vec<f64> {
    let count = population as f64;
    let raw = |rank: usize| (ln(0.5 * count + 1.0) - ln(rank as f64)).max(0.0);
    // The term of rank 1 is positive, so the sum is not 0.
    let sum: f64 = (1..=population).map(raw).sum();
    (1..=population).map(|rank| raw(rank) / sum - 1.0 / count).collect()
}

/// The utility of each individual.
pub(super) fn weights(fitness: &[Fitness], utilities: &[f64]) -> Vec<f64> {
    let mut weights = vec![0.0; fitness.len()];
    for (individual, utility) in Fitness::ranking(fitness).into_iter().zip(utilities) {
        if let Some(weight) = weights.get_mut(individual) {
            *weight = *utility;
        }
    }
    weights
}

/// The rank of each individual, spaced evenly from 1/2 for the best to -1/2 for the worst, equals by index.
///
/// Source: \[Salimans2017\] section 2. The spacing is that of its authors' program.
pub(super) fn centered_ranks(fitness: &[Fitness]) -> Vec<f64> {
    // One individual has no spacing: the divisor 1 prevents 0 / 0.
    let last = fitness.len().saturating_sub(1).max(1) as f64;
    let mut ranks = vec![0.0; fitness.len()];
    for (place, individual) in Fitness::ranking(fitness).into_iter().enumerate() {
        if let Some(rank) = ranks.get_mut(individual) {
            *rank = 0.5 - place as f64 / last;
        }
    }
    ranks
}

/// The values of fitness within 1e100 of zero. A failed evaluation counts as the worst finite value and an infinite one as
/// the best. `None` if no value is finite.
pub(super) fn rewards(fitness: &[Fitness]) -> Option<Vec<f64>> {
    let finite = || fitness.iter().map(|fitness| fitness.get()).filter(|value| value.is_finite());
    let worst = finite().reduce(f64::min)?;
    let best = finite().reduce(f64::max)?;
    Some(fitness.iter().map(|fitness| bounded(fitness.get().clamp(worst, best))).collect())
}

/// The values divided by the largest magnitude of them, so that squares neither overflow nor vanish.
pub(super) fn scaled(mut rewards: Vec<f64>) -> Vec<f64> {
    let largest = rewards.iter().fold(0.0, |largest: f64, reward| largest.max(reward.abs()));
    if largest > 0.0 {
        for reward in &mut rewards {
            *reward /= largest;
        }
    }
    rewards
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utilities_favor_the_better_half() {
        let got = utilities(4);
        // ln 3, ln 1.5, 0, 0.
        let (a, b) = (1.0986122886681098, 0.4054651081081644);
        let want = [a / (a + b) - 0.25, b / (a + b) - 0.25, -0.25, -0.25];
        assert!(got.iter().zip(want).all(|(got, want)| (got - want).abs() < 1e-15), "{got:?}");
        let told = [1.0, f64::NAN, 3.0, 3.0].map(Fitness::nan_as_failed);
        assert_eq!(weights(&told, &got), [got[2], got[3], got[0], got[1]]);
    }

    #[test]
    fn ranks_are_spaced_evenly() {
        let told = [2.0, f64::NAN, 7.0, 2.0, 1.0].map(Fitness::nan_as_failed);
        assert_eq!(centered_ranks(&told), [0.25, -0.5, 0.5, 0.0, -0.25]);
        assert_eq!(centered_ranks(&told[..1]), [0.5]);
    }

    #[test]
    fn rewards_are_finite() {
        let told = [3.0, f64::NAN, f64::INFINITY, -2.0].map(Fitness::nan_as_failed);
        assert_eq!(rewards(&told).unwrap(), [3.0, -2.0, 3.0, -2.0]);
        let told = [1e300, f64::NAN].map(Fitness::nan_as_failed);
        assert_eq!(rewards(&told).unwrap(), [1e100, 1e100]);
        assert_eq!(rewards(&[Fitness::WORST; 3]), None);
        assert_eq!(scaled(alloc::vec![0.0, -4.0, 2.0]), [0.0, -1.0, 0.5]);
        assert_eq!(scaled(alloc::vec![0.0, 0.0]), [0.0, 0.0]);
    }
}
