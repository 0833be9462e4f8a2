//! Values of fitness as finite numbers.

use alloc::vec::Vec;

use super::settings::bounded;
use crate::fitness::Fitness;

/// The values of fitness, where a failed evaluation counts as the worst finite value and an infinite one as the best;
/// within 1e100 of zero. None if no value is finite.
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
