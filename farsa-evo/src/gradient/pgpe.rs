//! Policy gradients with parameter-based exploration.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Scalar;

use super::noise::{Directions, Spread};
use super::optimizer::ClipUp;
use super::settings::{
    LARGEST, bounded, bounded_size, decay, ends, learning_rate, point, point_row, positive, sizes_row, step_sizes,
};
use super::utilities::{centered_ranks, rewards};
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
use crate::search::{Algorithm, Row, Search, Step};
use crate::strategy::RecordKind;

/// Determines the reward of an individual in [`Pgpe`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum PgpeFitness {
    /// Rank of the individual, scaled to the range from -1/2 to 1/2 (0-centered ranking).
    #[cfg_attr(feature = "serde", serde(rename = "CentredRanks"))]
    CenteredRanks,
    /// Fitness of the individual, minus the mean of its generation as baseline.
    Raw,
}

/// Configuration of [`Pgpe`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PgpeConfig {
    /// Initial center (x, or mu) \[genes\], within 1e100 of zero.
    pub mean: Vec<f64>,
    /// Initial standard deviation (sigma) of every gene, 1e-100 to 1e100.
    pub sigma: f64,
    /// Number of symmetric pairs. Note that a generation has twice as many individuals (lambda).
    pub pairs: usize,
    /// Step size of `ClipUp` (alpha), 1e-100 to 1e100.
    pub step_size: f64,
    /// Largest distance that the center can move in a generation (v max), 1e-100 to 1e100.
    pub max_speed: f64,
    /// Momentum of `ClipUp` (m), 0 to less than 1.
    pub momentum: f64,
    /// Learning rate of the standard deviations (Omega), 0 to 10.
    pub sigma_learning_rate: f64,
    /// Largest relative change of a standard deviation in a generation, 0 to less than 1.
    pub sigma_max_change: f64,
    /// Determines the reward of an individual.
    pub fitness: PgpeFitness,
    /// Upper limit of the standard deviation of every gene, sigma to 1e100. If genes have a range, use its width. The
    /// default is 1e100.
    pub largest_step: f64,
}

impl PgpeConfig {
    /// Creates a configuration with the parameters of \[Toklu2020\] and its program, for the given number of pairs.
    /// Here the maximum speed is a 15th of the initial radius sigma sqrt(n). The step size is half of that, and the
    /// momentum is 0.9. For standard deviations, the learning rate is 0.1 and the largest change is 0.2. Rewards are
    /// centered ranks.
    pub fn new(mean: Vec<f64>, sigma: f64, pairs: usize) -> Self {
        let max_speed = sigma * Scalar::sqrt(mean.len() as f64) / 15.0;
        Self {
            mean,
            sigma,
            pairs,
            step_size: 0.5 * max_speed,
            max_speed,
            momentum: 0.9,
            sigma_learning_rate: 0.1,
            sigma_max_change: 0.2,
            fitness: PgpeFitness::CenteredRanks,
            largest_step: LARGEST,
        }
    }

    /// Checks whether a search can be created with these settings.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] or [`EvoError::OutOfRange`] for the first setting that is invalid.
    pub fn validate(&self) -> Result<(), EvoError> {
        Population::check(self.pairs.saturating_mul(2), self.mean.len())?;
        point("mean", &self.mean)?;
        step_sizes(self.sigma, self.largest_step)?;
        positive("step_size", self.step_size)?;
        positive("max_speed", self.max_speed)?;
        decay("momentum", self.momentum)?;
        learning_rate("sigma_learning_rate", self.sigma_learning_rate)?;
        decay("sigma_max_change", self.sigma_max_change)
    }
}

/// Policy gradients with parameter-based exploration: a normal distribution with a standard deviation for each gene,
/// symmetric pairs of individuals, and `ClipUp` to move the center.
///
/// Its parameters give the distance that the center moves, whatever the scale of fitness. With
/// [`CenteredRanks`](PgpeFitness::CenteredRanks) only the order of fitness counts, with [`Raw`](PgpeFitness::Raw) its values.
///
/// Source: \[Sehnke2010\] with symmetric sampling, as in \[Toklu2020\], whose `ClipUp` is the optimizer. With e = sigma s,
/// the gradients are the means over the pairs of (f+ - f-) / 2 e and of ((f+ + f-) / 2 - b) (e^2 - sigma^2) / sigma.
/// Deviations: sums go through the pairs by index. With raw fitness, a failed evaluation counts as the worst finite value
/// of its generation and an infinite one as the best. A generation without a finite value changes nothing. Centers stay
/// within 1e100 of zero, standard deviations between 1e-100 and a limit.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::gradient::{Pgpe, PgpeConfig};
///
/// let mut search = Pgpe::new(PgpeConfig::new(vec![0.0; 2], 1.0, 10), 1)?;
/// search.maximize(200, |x| -(x[0] - 3.0) * (x[0] - 3.0) - (x[1] + 1.0) * (x[1] + 1.0))?;
/// assert!((search.mean()[0] - 3.0).abs() < 0.2 && (search.mean()[1] + 1.0).abs() < 0.2);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
///
/// Individuals 2k and 2k + 1 are pair k, which adds and subtracts the noise of the stream (seed,
/// [`Domain::Mutation`](farsa_num::Domain::Mutation), trial 0, k, generation), in generation 0 with
/// [`Domain::InitialGenome`](farsa_num::Domain::InitialGenome). [`diagnostics`](crate::Strategy::diagnostics) are the speed of
/// the center and the smallest and the largest standard deviation.
pub type Pgpe = Search<PgpeState>;

/// Internal state of [`Pgpe`].
#[derive(Clone, Debug, PartialEq)]
pub struct PgpeState {
    mean: Vec<f64>,
    sigmas: Vec<f64>,
    clip_up: ClipUp,
    /// The noise of this generation.
    directions: Directions,
}

impl Pgpe {
    /// Gets the center \[genes\] of the distribution that the current generation is drawn from.
    pub fn mean(&self) -> &[f64] {
        &self.state.mean
    }

    /// Gets the standard deviations \[genes\] of the distribution that the current generation is drawn from.
    pub fn sigmas(&self) -> &[f64] {
        &self.state.sigmas
    }
}

impl PgpeState {
    /// Moves the center and the standard deviations by the rewards \[individuals\].
    fn update(&mut self, config: &PgpeConfig, rewards: &[f64]) {
        let genes = self.mean.len();
        let (count, pairs) = (rewards.len() as f64, config.pairs as f64);
        // b, the mean reward, divided before the sum so that it cannot overflow.
        let baseline = rewards.iter().map(|reward| reward / count).sum::<f64>();
        // With e = sigma z, grad_mu = sigma / pairs sum (r+ - r-) / 2 z and
        // grad_sigma = sigma / pairs sum ((r+ + r-) / 2 - b) (z^2 - 1). The factors sigma / pairs follow after the sums.
        let (mut first, mut second) = (vec![0.0; genes], vec![0.0; genes]);
        for (row, pair) in rewards.chunks_exact(2).enumerate() {
            let weights = [0.5 * (pair[0] - pair[1]), 0.5 * (pair[0] + pair[1]) - baseline];
            self.directions.add_moments(row, weights, &mut first, &mut second);
        }
        first.iter_mut().zip(&self.sigmas).for_each(|(g, sigma)| *g *= sigma / pairs);
        let PgpeConfig { step_size, max_speed, momentum, sigma_learning_rate, sigma_max_change, largest_step, .. } =
            *config;
        self.clip_up.step(&first, step_size, max_speed, momentum);
        for (mean, velocity) in self.mean.iter_mut().zip(self.clip_up.velocity()) {
            *mean = bounded(*mean + velocity);
        }
        // The standard deviations change last, because both gradients belong to those of the samples.
        let (least, most) = (1.0 - sigma_max_change, 1.0 + sigma_max_change);
        for (sigma, g) in self.sigmas.iter_mut().zip(second) {
            let grown = *sigma + sigma_learning_rate * (*sigma * g / pairs);
            *sigma = bounded_size(grown.clamp(least * *sigma, most * *sigma), largest_step);
        }
    }
}

impl Algorithm for PgpeState {
    type Gene = f64;
    type Config = PgpeConfig;

    fn start(step: &Step<'_, PgpeConfig>) -> Result<(Self, Population<f64>), EvoError> {
        let PgpeConfig { mean, sigma, pairs, .. } = step.config;
        step.config.validate()?;
        let genes = mean.len();
        let (sigmas, directions) = (vec![*sigma; genes], Directions::new(*pairs, genes));
        let state = Self { mean: mean.clone(), sigmas, clip_up: ClipUp::new(genes), directions };
        Ok((state, Population::new(2 * pairs, genes)?))
    }

    fn advance(&mut self, step: &Step<'_, PgpeConfig>, fitness: &[Fitness], _: &mut Population<f64>) {
        let rewards = match step.config.fitness {
            PgpeFitness::CenteredRanks => Some(centered_ranks(fitness)),
            PgpeFitness::Raw => rewards(fitness),
        };
        if let Some(rewards) = rewards {
            self.update(step.config, &rewards);
        }
    }

    fn draw(&mut self, step: &Step<'_, PgpeConfig>, genomes: &mut Population<f64>) {
        self.directions.mirror(|row| step.stream(row), genomes, &self.mean, Spread::Each(&self.sigmas));
    }

    fn record_kind(config: &PgpeConfig) -> RecordKind {
        match config.fitness {
            PgpeFitness::CenteredRanks => RecordKind::Order,
            PgpeFitness::Raw => RecordKind::Values,
        }
    }

    fn diagnostics(&self, _: &PgpeConfig) -> Vec<f64> {
        [vec![self.clip_up.speed()], ends(&self.sigmas)].concat()
    }

    fn rows(&self) -> Vec<&[f64]> {
        vec![&self.mean, &self.sigmas, self.clip_up.velocity()]
    }

    fn rows_mut(&mut self) -> Vec<Row<'_>> {
        vec![point_row(&mut self.mean), sizes_row(&mut self.sigmas), self.clip_up.row()]
    }
}
