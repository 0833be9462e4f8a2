//! Weights and learning rates of covariance matrix adaptation.

use alloc::vec::Vec;

use farsa_num::{Scalar, exp, ln};

/// Weights and learning rates: functions of the number of genes and individuals.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients {
    /// Weights w of the ranks, best first. The weights of the parents are positive with sum 1, others zero or negative.
    pub(crate) weights: Vec<f64>,
    /// Number of parents, mu.
    pub(crate) parents: usize,
    /// Effective number of parents, `mu_eff`.
    pub(crate) effective: f64,
    /// Rate of the path of the step size, `c_sigma`.
    pub(crate) step_path_rate: f64,
    /// Damping of the step size, `d_sigma`.
    pub(crate) damping: f64,
    /// Rate of the path of the covariance, `c_c`.
    pub(crate) path_rate: f64,
    /// Rate of the rank-one update, `c_1`.
    pub(crate) rank_one: f64,
    /// Rate of the rank-mu update, `c_mu`.
    pub(crate) rank_mu: f64,
    /// Expected length of a standard normal vector.
    pub(crate) expected: f64,
}

impl Coefficients {
    /// The defaults of \[Hansen2016\] table 1. `rates` may change `c_1` and `c_mu`. Without `active` no weight is negative.
    pub(crate) fn new(
        genes: usize,
        population: usize,
        active: bool,
        damping: Option<f64>,
        rates: impl FnOnce(f64, f64) -> (f64, f64),
    ) -> Self {
        let n = genes as f64;
        // w'_i = ln((lambda + 1) / 2) - ln i, which is positive for the parents alone. [Hansen2016] eq. 49.
        let middle = ln(0.5 * (population as f64 + 1.0));
        let raw: Vec<f64> = (1..=population).map(|rank| middle - ln(rank as f64)).collect();
        let parents = population / 2;
        let (good, bad) = raw.split_at(parents);
        let (effective, effective_bad) = (effective(good), effective(bad));
        // c_sigma = (mu_eff + 2) / (n + mu_eff + 5). [Hansen2016] eq. 55, as d_sigma below.
        let step_path_rate = (effective + 2.0) / (n + effective + 5.0);
        // d_sigma = 1 + 2 max(0, sqrt((mu_eff - 1) / (n + 1)) - 1) + c_sigma.
        let excess = Scalar::sqrt(((effective - 1.0) / (n + 1.0)).max(0.0)) - 1.0;
        let damping = damping.unwrap_or(1.0 + 2.0 * excess.max(0.0) + step_path_rate);
        // c_c = (4 + mu_eff / n) / (n + 4 + 2 mu_eff / n). [Hansen2016] eq. 56.
        let path_rate = (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n);
        // c_1 = alpha_cov / ((n + 1.3)^2 + mu_eff) with alpha_cov = 2. [Hansen2016] eq. 57.
        let rank_one = 2.0 / ((n + 1.3) * (n + 1.3) + effective);
        // c_mu = min(1 - c_1, 2 (mu_eff - 2 + 1 / mu_eff) / ((n + 2)^2 + mu_eff)). It is 0 with one parent.
        // [Hansen2016] eq. 58.
        let spread = 2.0 * (effective - 2.0 + 1.0 / effective);
        let rank_mu = (spread.max(0.0) / ((n + 2.0) * (n + 2.0) + effective)).min(1.0 - rank_one);
        let (rank_one, rank_mu) = rates(rank_one, rank_mu);
        // Equations 50 to 52: how much the negative weights may take away together.
        // Two of the three limits divide by c_mu.
        let negative = if active && rank_mu > 0.0 {
            // With this sum of negative weights, c_1 + c_mu sum w_i = 0: C does not decay.
            let by_rates = 1.0 + rank_one / rank_mu;
            let by_parents = 1.0 + 2.0 * effective_bad / (effective + 2.0);
            // With at most this sum C stays positive definite.
            let definite = (1.0 - rank_one - rank_mu).max(0.0) / (n * rank_mu);
            by_rates.min(by_parents).min(definite)
        } else {
            0.0
        };
        let (sum, sum_bad) = (good.iter().sum::<f64>(), -bad.iter().sum::<f64>());
        // w_i = w'_i / sum of the positive, or the limit times w'_i / sum of the negative. [Hansen2016] eq. 53.
        let weigh = |raw: &f64| if *raw > 0.0 { raw / sum } else { negative * raw / sum_bad };
        let weights = raw.iter().map(weigh).collect();
        // E |N(0, I)| = sqrt(n) (1 - 1 / (4 n) + 1 / (21 n^2)), up to higher orders of 1 / n.
        let expected = Scalar::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        Self { weights, parents, effective, step_path_rate, damping, path_rate, rank_one, rank_mu, expected }
    }

    /// Number of individuals.
    pub(crate) fn population(&self) -> usize {
        self.weights.len()
    }

    /// Returns true if the path of the covariance stalls because that of the step size is long, `h_sigma` = 0.
    pub(crate) fn stalls(&self, genes: usize, updates: u32, step_path_length: f64) -> bool {
        // h_sigma = 0 if |p_sigma| / sqrt(1 - (1 - c_sigma)^(2 g)) >= (1.4 + 2 / (n + 1)) E |N(0, I)|, after g
        // updates. The root corrects the length of a path that began at 0.
        let left = exp(2.0 * f64::from(updates) * ln(1.0 - self.step_path_rate));
        let limit = (1.4 + 2.0 / (genes as f64 + 1.0)) * self.expected;
        step_path_length / Scalar::sqrt(1.0 - left) >= limit
    }
}

/// The effective number of parents of these weights.
fn effective(weights: &[f64]) -> f64 {
    // mu_eff = (sum w)^2 / sum w^2, which does not depend on the scale of the weights.
    let sum: f64 = weights.iter().sum();
    sum * sum / weights.iter().map(|w| w * w).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() <= 5e-5
    }

    #[test]
    fn defaults_are_those_of_the_table() {
        // By hand from table 1 for n = 10: ln 5.5 - ln i, normalized.
        let coefficients = Coefficients::new(10, 10, true, None, |one, mu| (one, mu));
        let Coefficients { weights, parents, effective, .. } = &coefficients;
        let raw = [1.704_748, 1.011_601, 0.606_136, 0.318_454, 0.095_310];
        for (weight, raw) in weights.iter().zip(raw) {
            assert!(near(*weight, raw / 3.736_249), "{weights:?}");
        }
        assert_eq!(*parents, 5);
        assert!(near(*effective, 3.167_30), "{effective}");
        assert!(near(coefficients.step_path_rate, 0.284_428) && near(coefficients.damping, 1.284_428));
        assert!(near(coefficients.path_rate, 0.294_990) && near(coefficients.rank_one, 0.015_284));
        assert!(near(coefficients.rank_mu, 0.020_154), "{}", coefficients.rank_mu);
        assert!(near(coefficients.expected, 3.084_727_4));
    }

    #[test]
    fn weights_have_their_sums() {
        for (genes, population) in [(1, 2), (1, 3), (2, 4), (5, 8), (10, 1000), (792, 24)] {
            let plain = Coefficients::new(genes, population, false, None, |one, mu| (one, mu));
            let active = Coefficients::new(genes, population, true, None, |one, mu| (one, mu));
            let positive = |c: &Coefficients| c.weights.iter().filter(|w| **w > 0.0).sum::<f64>();
            assert!((positive(&plain) - 1.0).abs() < 1e-12 && (positive(&active) - 1.0).abs() < 1e-12);
            assert_eq!(plain.weights[plain.parents..].iter().sum::<f64>(), 0.0);
            let Coefficients { rank_one, rank_mu, .. } = active;
            let negative = 1.0 - active.weights.iter().sum::<f64>();
            assert!(rank_one + rank_mu + rank_mu * negative * genes as f64 <= 1.0 + 1e-12);
            let possible = rank_mu > 0.0 && rank_one + rank_mu < 1.0;
            assert_eq!(negative > 1e-9, possible, "{genes} genes, {population} individuals");
        }
    }
}
