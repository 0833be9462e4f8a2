//! When a run of covariance matrix adaptation has come to its end.

use alloc::vec::Vec;

use farsa_num::Scalar;

use crate::covariance::distribution::{Covariance, Distribution};
use crate::covariance::full::Full;
use crate::fitness::Fitness;

/// The largest number of generations whose best and median are stored.
pub(super) const LONGEST: usize = 20_000;
/// Differences of fitness, and of genes as a fraction of the initial step size, that count for nothing.
const TOLERANCE: f64 = 1e-12;
/// The largest ratio of the longest axis to the initial step size.
const LONGEST_AXIS: f64 = 1e4;
/// The largest ratio of the squares of the longest and the shortest axis.
const CONDITION: f64 = 1e14;

/// Why a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Termination {
    MaxIter,
    TolHistFun,
    TolX,
    TolUpSigma,
    ConditionCov,
    NoEffectAxis,
    NoEffectCoord,
    Stagnation,
}

/// The history of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Progress {
    /// Generations so far, those that failed as a whole too.
    pub(super) iterations: u32,
    /// The best of each generation that did not fail as a whole, the latest last.
    pub(super) best: Vec<Fitness>,
    /// The median of each of them.
    pub(super) median: Vec<Fitness>,
}

impl Progress {
    /// Takes a generation, given its individuals, best first.
    pub(super) fn push(&mut self, fitness: &[Fitness], ranked: &[usize]) {
        self.iterations = self.iterations.saturating_add(1);
        let at = |rank: usize| ranked.get(rank).map_or(Fitness::WORST, |&individual| fitness[individual]);
        // Without a success there is no best, but the generation counts for the limit of iterations.
        if at(0).is_failed() {
            return;
        }
        if self.best.len() == LONGEST {
            self.best.remove(0);
            self.median.remove(0);
        }
        self.best.push(at(0));
        self.median.push(at(ranked.len() / 2));
    }

    /// Why the run ends, if it does, given the step size that it began with.
    pub(super) fn ends(&self, distribution: &Distribution<Full>, start: f64) -> Option<Termination> {
        let (n, population) = (distribution.mean.len(), distribution.coefficients.population());
        let (sigma, covariance) = (distribution.sigma, &distribution.covariance);
        let [_, longest] = covariance.extremes();
        // MaxIter = 100 + 50 (n + 3)^2 / sqrt(lambda). [Hansen2009].
        let reach = (n as f64 + 3.0) * (n as f64 + 3.0) / Scalar::sqrt(population as f64);
        let small = |x: f64| x * (sigma / start) < TOLERANCE;
        // Axes take turns, so a generation needs n operations instead of n^2.
        let axis = covariance.axis(self.iterations as usize % n);
        let unmoved = |(mean, step): (&f64, f64)| *mean + step == *mean;
        if f64::from(self.iterations) >= 100.0 + 50.0 * reach {
            Some(Termination::MaxIter)
        } else if flat(&self.best, 10 + (30 * n).div_ceil(population)) {
            Some(Termination::TolHistFun)
        } else if covariance.gene_deviations().chain(distribution.path.iter().map(|x| x.abs())).all(small) {
            // sigma sqrt(C_ii) and sigma |p_c| are below 10^-12 of the first sigma in all genes.
            Some(Termination::TolX)
        } else if sigma / start * Scalar::sqrt(longest) > LONGEST_AXIS {
            Some(Termination::TolUpSigma)
        } else if distribution.axis_ratio() * distribution.axis_ratio() > CONDITION {
            Some(Termination::ConditionCov)
        } else if distribution.mean.iter().zip(axis.0.iter().map(|b| 0.1 * sigma * axis.1 * b)).all(unmoved) {
            // m + 0.1 sigma d_i b_i = m in floating point.
            Some(Termination::NoEffectAxis)
        } else if distribution.mean.iter().zip(covariance.gene_deviations().map(|d| 0.2 * sigma * d)).any(unmoved) {
            // m_i + 0.2 sigma sqrt(C_ii) = m_i for some gene.
            Some(Termination::NoEffectCoord)
        } else {
            // The last fifth of the run, at least 120 + 30 n / lambda generations. [Hansen2016] section B.3. The
            // upper limit must not be below the lower one.
            let window = (self.iterations as usize / 5).clamp(120 + 30 * n / population, LONGEST.max(120 + 30 * n));
            (stagnates(&self.best, window) && stagnates(&self.median, window)).then_some(Termination::Stagnation)
        }
    }
}

/// Returns true if the latest values of a window are almost equal.
fn flat(history: &[Fitness], window: usize) -> bool {
    let Some(latest) = history.len().checked_sub(window).map(|start| &history[start..]) else { return false };
    let (Some(low), Some(high)) = (latest.iter().min(), latest.iter().max()) else { return false };
    // The difference of two infinities is NaN, so equality is a separate test.
    low == high || high.get() - low.get() < TOLERANCE
}

/// Returns true if the median of the last 30 % of a window is not better than that of the first.
fn stagnates(history: &[Fitness], window: usize) -> bool {
    let Some(latest) = history.len().checked_sub(window).map(|start| &history[start..]) else { return false };
    let part = (3 * window / 10).max(1);
    let median = |part: &[Fitness]| {
        let mut sorted = part.to_vec();
        sorted.sort_unstable();
        sorted.get(part.len() / 2).copied()
    };
    median(&latest[latest.len() - part..]) <= median(&latest[..part])
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;
    use crate::covariance::config::CmaEsConfig;

    fn distribution(mean: f64, sigma: f64) -> Distribution<Full> {
        let config = CmaEsConfig::new(vec![mean; 4], sigma);
        Distribution::new(config.mean.clone(), sigma, config.largest_step, config.coefficients_of(8))
    }

    /// A run of generations with these values as the best, others below.
    fn progress(values: impl Iterator<Item = f64>) -> Progress {
        let mut progress = Progress::default();
        for value in values {
            let fitness: Vec<Fitness> = (0..8).map(|k| Fitness::nan_as_failed(value - f64::from(k))).collect();
            progress.push(&fitness, &Fitness::ranking(&fitness));
        }
        progress
    }

    #[test]
    fn each_criterion_ends_a_run() {
        let rising = || (0..60).map(f64::from);
        assert_eq!(progress(rising()).ends(&distribution(1.0, 1.0), 1.0), None);
        assert_eq!(progress(rising()).ends(&distribution(1.0, 1e-13), 1.0), Some(Termination::TolX));
        assert_eq!(progress(rising()).ends(&distribution(1.0, 1.1e4), 1.0), Some(Termination::TolUpSigma));
        assert_eq!(progress(rising()).ends(&distribution(1e30, 1.0), 1.0), Some(Termination::NoEffectAxis));
        let mut one = distribution(1.0, 1.0);
        one.mean[2] = 1e30;
        assert_eq!(progress(rising()).ends(&one, 1.0), Some(Termination::NoEffectCoord));
        // An axis of the first gene alone: the turn of the others comes after it.
        let mut one = distribution(1.0, 1.0);
        one.mean[0] = 1e30;
        assert_eq!(progress(rising()).ends(&one, 1.0), Some(Termination::NoEffectAxis));
        let next = progress((0..61).map(f64::from));
        assert_eq!(next.ends(&one, 1.0), Some(Termination::NoEffectCoord));
        // The same with small steps, which large ones would hide.
        assert_eq!(progress(rising()).ends(&distribution(1.0, 1e-18), 1e-18), Some(Termination::NoEffectAxis));
        let mut one = distribution(0.0, 1e-10);
        one.mean[2] = 1e8;
        assert_eq!(progress(rising()).ends(&one, 1e-10), Some(Termination::NoEffectCoord));
        // 10 + 30 n / lambda = 25 generations.
        let flat = |count: usize| progress(rising().chain(core::iter::repeat_n(99.0, count)));
        assert_eq!(flat(24).ends(&distribution(1.0, 1.0), 1.0), None);
        assert_eq!(flat(25).ends(&distribution(1.0, 1.0), 1.0), Some(Termination::TolHistFun));
        let infinite = progress(core::iter::repeat_n(f64::INFINITY, 25));
        assert_eq!(infinite.ends(&distribution(1.0, 1.0), 1.0), Some(Termination::TolHistFun));
        // 120 + 30 n / lambda = 135 generations that go up and down.
        let restless = |count: u32| progress((0..count).map(|k| f64::from(k % 2)));
        assert_eq!(restless(134).ends(&distribution(1.0, 1.0), 1.0), None);
        assert_eq!(restless(135).ends(&distribution(1.0, 1.0), 1.0), Some(Termination::Stagnation));
        // 100 + 50 * 49 / sqrt(8) = 966.2 generations.
        let rising = |count: u32| progress((0..count).map(f64::from));
        assert_eq!(rising(966).ends(&distribution(1.0, 1.0), 1.0), None);
        assert_eq!(rising(967).ends(&distribution(1.0, 1.0), 1.0), Some(Termination::MaxIter));
    }

    #[test]
    fn the_median_is_remembered_beside_the_best() {
        let one = progress([3.0, 5.0].into_iter());
        let values = |all: &[Fitness]| all.iter().map(|fitness| fitness.get()).collect::<Vec<_>>();
        assert_eq!((values(&one.best), values(&one.median)), (vec![3.0, 5.0], vec![-1.0, 1.0]));
        // The best goes up and down, the median rises: nothing stagnates.
        let mut rising = Progress::default();
        for k in 0..200 {
            let fitness: Vec<Fitness> = (0..8)
                .map(|i| Fitness::nan_as_failed(if i == 0 { 1000.0 + f64::from(k % 2) } else { f64::from(k) }))
                .collect();
            rising.push(&fitness, &Fitness::ranking(&fitness));
        }
        assert_eq!(rising.ends(&distribution(1.0, 1.0), 1.0), None);
    }

    #[test]
    fn stagnation_compares_medians_of_three_tenths_of_a_window() {
        // The first six and the last six of 20 generations. The upper one of the two in the middle is the median.
        let history = |first: [f64; 6]| -> Vec<Fitness> {
            let values = first.into_iter().chain([7.0; 8]).chain([5.0; 6]);
            values.map(Fitness::nan_as_failed).collect()
        };
        for (first, expected) in [([0.0, 0.0, 0.0, 9.0, 9.0, 9.0], true), ([0.0, 0.0, 0.0, 0.0, 9.0, 9.0], false)] {
            assert_eq!(stagnates(&history(first), 20), expected, "{first:?}");
            assert!(!stagnates(&history(first), 21), "a window that is not full");
        }
    }

    #[test]
    fn failed_generations_count_but_are_not_compared() {
        let failures = progress(core::iter::repeat_n(f64::NAN, 400));
        assert_eq!((failures.iterations, failures.best.len()), (400, 0));
        assert_eq!(failures.ends(&distribution(1.0, 1.0), 1.0), None);
    }
}
