//! A normal distribution that is adapted to what improves an archive.

use alloc::vec::Vec;

use farsa_num::Stream;

use crate::archives::archive::Addition;
use crate::covariance::coefficients::Coefficients;
use crate::covariance::distribution::Distribution;
use crate::covariance::full::Full;
use crate::error::EvoError;
use crate::snapshot::StateReader;

/// The largest ratio of the longest to the shortest axis.
const LARGEST_RATIO: f64 = 1e7;
/// The shortest that the longest axis may be, as a part of the first step size.
const SMALLEST: f64 = 1e-10;

/// The state of an improvement emitter.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Improvement {
    batch: usize,
    /// The step size at every start.
    sigma: f64,
    /// The upper limit of the standard deviation of every gene.
    largest_step: f64,
    distribution: Distribution<Full>,
}

/// The coefficients with positive weights alone.
fn coefficients(genes: usize, individuals: usize) -> Coefficients {
    Coefficients::new(genes, individuals, false, None, |one, mu| (one, mu))
}

fn start(mean: Vec<f64>, sigma: f64, largest_step: f64, batch: usize) -> Distribution<Full> {
    let coefficients = coefficients(mean.len(), batch);
    Distribution::new(mean, sigma, largest_step, coefficients)
}

impl Improvement {
    /// Creates an emitter whose genes have these bounds.
    pub(super) fn new(mean: Vec<f64>, sigma: f64, batch: usize, bounds: &[[f64; 2]]) -> Self {
        let widest = bounds.iter().fold(0.0_f64, |widest, [low, high]| widest.max(high - low));
        let largest_step = sigma.max(widest);
        Self { batch, sigma, largest_step, distribution: start(mean, sigma, largest_step, batch) }
    }

    /// Draws the individuals [batch x genes], each from the stream that belongs to it.
    pub(super) fn sample(&mut self, stream: impl Fn(usize) -> Stream, points: &mut [f64], bounds: &[[f64; 2]]) {
        self.distribution.sample_within(stream, points, bounds);
    }

    /// Adapts the distribution, given the objectives of the individuals \[batch\] and the results of their additions.
    /// Returns true if it has to start again.
    pub(super) fn tell(&mut self, objectives: &[f64], additions: &[Addition]) -> bool {
        let worth = |individual: usize| match additions.get(individual) {
            Some(Addition::New) => (2, objectives.get(individual).copied().unwrap_or_default()),
            Some(Addition::Better { by }) => (1, *by),
            _ => (0, 0.0),
        };
        let mut ranked: Vec<usize> = (0..additions.len()).collect();
        // The stable sort ranks equals by index.
        ranked.sort_by(|&a, &b| worth(b).0.cmp(&worth(a).0).then_with(|| worth(b).1.total_cmp(&worth(a).1)));
        let parents = additions.iter().filter(|addition| **addition != Addition::None).count();
        if parents == 0 {
            return true;
        }
        // A population of twice the additions makes every addition a parent, since mu = lambda / 2.
        let own = coefficients(self.distribution.mean.len(), 2 * parents);
        let usual = core::mem::replace(&mut self.distribution.coefficients, own);
        self.distribution.update(&ranked);
        self.distribution.coefficients = usual;
        !self.is_sound()
    }

    /// Returns true unless the distribution has collapsed.
    fn is_sound(&self) -> bool {
        let distribution = &self.distribution;
        distribution.axis_ratio() <= LARGEST_RATIO && distribution.longest_axis() >= SMALLEST * self.sigma
    }

    /// Starts again from these genes.
    pub(super) fn restart(&mut self, mean: &[f64]) {
        self.distribution = start(mean.to_vec(), self.sigma, self.largest_step, self.batch);
    }

    pub(super) fn state_length(genes: usize) -> usize {
        Distribution::<Full>::state_length(genes)
    }

    pub(super) fn save(&self, state: &mut Vec<u8>) {
        self.distribution.save(state);
    }

    /// Restores a state. On error the state is incomplete.
    pub(super) fn restore(&mut self, reader: &mut StateReader<'_>) -> Result<(), EvoError> {
        self.distribution.restore(reader)
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    #[test]
    fn a_distribution_that_has_collapsed_starts_again() {
        let tell = |emitter: &mut Improvement| emitter.tell(&[1.0; 4], &[Addition::New; 4]);
        let mut emitter = Improvement::new(vec![0.5; 3], 0.2, 4, &[[-9.0, 9.0]; 3]);
        let mut points = vec![0.0; 12];
        emitter.sample(|row| Stream::from_seed(row as u64), &mut points, &[[-9.0, 9.0]; 3]);
        let mut other = emitter.clone();
        assert!(!tell(&mut emitter));
        other.distribution.sigma *= 1e-11;
        assert!(tell(&mut other), "sigma is {}", other.distribution.sigma);
        assert!(emitter.tell(&[1.0; 4], &[Addition::None; 4]), "nothing was added");
    }
}
