//! Augmented random search.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Scalar;

use super::mirrored::Mirrored;
use super::settings::{point, positive};
use super::utilities::{rewards, scaled};
use crate::error::{EvoError, check_setting};
use crate::fitness::Fitness;
use crate::population::Population;
use crate::search::{Algorithm, Row, Search, Step};

/// Configuration of [`Ars`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ArsConfig {
    /// Initial parameters (M) \[genes\], within 1e100 of zero.
    pub mean: Vec<f64>,
    /// Number of directions (N). Note that a generation has twice as many individuals.
    pub directions: usize,
    /// Number of top directions (b) that a step is made of, from 1 to all of them.
    pub top_directions: usize,
    /// Step size (alpha), 1e-100 to 1e100.
    pub step_size: f64,
    /// Standard deviation of the exploration noise (nu), 1e-100 to 1e100.
    pub noise: f64,
}

impl ArsConfig {
    /// Creates a configuration of ARS V1, in which all directions count. Its step size of 0.02 and noise of 0.03 are
    /// the defaults of the program of the authors of \[Mania2018\]. Note that the paper chooses both for each task, so
    /// you may have to tune them.
    pub const fn new(mean: Vec<f64>, directions: usize) -> Self {
        Self { mean, directions, top_directions: directions, step_size: 0.02, noise: 0.03 }
    }

    /// Checks that all settings are within their allowed ranges.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] or [`EvoError::OutOfRange`] for the first setting that is invalid.
    pub fn validate(&self) -> Result<(), EvoError> {
        Population::check(self.directions.saturating_mul(2), self.mean.len())?;
        let within = (1..=self.directions).contains(&self.top_directions);
        check_setting(within, "top_directions", self.top_directions as f64, "1 to the number of directions")?;
        point("mean", &self.mean)?;
        positive("step_size", self.step_size)?;
        positive("noise", self.noise)
    }
}

/// Augmented random search, with mirrored noise of one size around one point. The point moves by the differences of rewards
/// along the best directions, divided by the standard deviation of these rewards.
///
/// This is the simplest strategy for many genes. It depends on the values of fitness, although not on their unit or
/// zero.
///
/// Source: \[Mania2018\] algorithm 1, V1, and V1-t with fewer top directions. For V2 normalize observations with
/// [`ObservationStatistics`](crate::ObservationStatistics). Deviations: sums go through the directions by index. A failed
/// evaluation counts as the worst finite value of its generation and an infinite one as the best. The rewards are divided
/// by their largest magnitude first. The point stays within 1e100 of zero, and does not move where all rewards are equal or
/// none is finite.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::gradient::{Ars, ArsConfig};
///
/// let config = ArsConfig { top_directions: 4, noise: 0.1, step_size: 0.1, ..ArsConfig::new(vec![0.0; 2], 8) };
/// let mut search = Ars::new(config, 1)?;
/// search.maximize(200, |x| -(x[0] - 3.0) * (x[0] - 3.0) - (x[1] + 1.0) * (x[1] + 1.0))?;
/// assert!((search.mean()[0] - 3.0).abs() < 0.2 && (search.mean()[1] + 1.0).abs() < 0.2);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
///
/// Individuals 2k and 2k + 1 are direction k, which adds and subtracts the noise of the stream (seed,
/// [`Domain::Mutation`](farsa_num::Domain::Mutation), trial 0, k, generation), in generation 0 with
/// [`Domain::InitialGenome`](farsa_num::Domain::InitialGenome). [`diagnostics`](crate::Strategy::diagnostics) are the
/// Euclidean lengths of the latest step and of the point.
pub type Ars = Search<ArsState>;

/// Internal state of [`Ars`].
#[derive(Clone, Debug, PartialEq)]
pub struct ArsState {
    samples: Mirrored,
}

impl Ars {
    /// Gets the point \[genes\] around which the individuals are placed.
    pub fn mean(&self) -> &[f64] {
        &self.state.samples.mean
    }
}

/// The top directions by the fitness of the better of their two individuals, equals by index, in order of index.
fn top(fitness: &[Fitness], count: usize) -> Vec<usize> {
    let better: Vec<Fitness> = fitness.chunks_exact(2).map(|pair| pair[0].max(pair[1])).collect();
    let mut top = Fitness::ranking(&better);
    top.truncate(count);
    // Sums by index do not depend on the ranking within the top directions.
    top.sort_unstable();
    top
}

impl ArsState {
    /// Moves the point by the rewards [top directions x 2] of the top directions.
    fn update(&mut self, step_size: f64, top: &[usize], rewards: &[f64]) {
        let count = rewards.len() as f64;
        let mean = rewards.iter().sum::<f64>() / count;
        let variance = rewards.iter().map(|reward| (reward - mean) * (reward - mean)).sum::<f64>() / count;
        // M <- M + alpha / (b sigma_R) sum (r+ - r-) delta, with sigma_R of the 2 b rewards in the sum. [Mania2018]
        // algorithm 1.
        let deviation = Scalar::sqrt(variance);
        if deviation > 0.0 {
            let mut step = vec![0.0; self.samples.mean.len()];
            for (row, pair) in top.iter().zip(rewards.chunks_exact(2)) {
                self.samples.directions.add(*row, (pair[0] - pair[1]) / deviation, &mut step);
            }
            let scale = step_size / top.len() as f64;
            for x in &mut step {
                *x *= scale;
            }
            self.samples.advance(&step);
        }
    }
}

impl Algorithm for ArsState {
    type Gene = f64;
    type Config = ArsConfig;

    fn start(step: &Step<'_, ArsConfig>) -> Result<(Self, Population<f64>), EvoError> {
        let ArsConfig { mean, directions, .. } = step.config;
        step.config.validate()?;
        let samples = Mirrored::new(mean, *directions);
        Ok((Self { samples }, Population::new(2 * directions, mean.len())?))
    }

    fn advance(&mut self, step: &Step<'_, ArsConfig>, fitness: &[Fitness], _: &mut Population<f64>) {
        self.samples.step = 0.0;
        if let Some(rewards) = rewards(fitness) {
            let top = top(fitness, step.config.top_directions);
            let used = top.iter().filter_map(|row| rewards.get(2 * row..2 * row + 2)).flatten().copied().collect();
            self.update(step.config.step_size, &top, &scaled(used));
        }
    }

    fn draw(&mut self, step: &Step<'_, ArsConfig>, genomes: &mut Population<f64>) {
        self.samples.draw(step, step.config.noise, genomes);
    }

    fn diagnostics(&self, _: &ArsConfig) -> Vec<f64> {
        self.samples.diagnostics()
    }

    fn rows(&self) -> Vec<&[f64]> {
        self.samples.rows()
    }

    fn rows_mut(&mut self) -> Vec<Row<'_>> {
        self.samples.rows_mut()
    }
}
