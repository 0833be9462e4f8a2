//! Policy gradients with parameter-based exploration.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Scalar;

use super::noise::{Directions, Noise, Spread};
use super::optimizer::ClipUp;
use super::settings::{bounded, bounded_size, decay, learning_rate, point, positive, read_point, read_sizes};
use super::utilities::centered_ranks;
use super::utilities::rewards;
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
use crate::snapshot::{Snapshot, StateReader, push_reals};
use crate::strategy::{RecordKind, Strategy, next_generation};

/// The reward of an individual in [`Pgpe`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum PgpeFitness {
    /// Its rank, from -1/2 to 1/2 (0-centered ranking).
    #[cfg_attr(feature = "serde", serde(rename = "CentredRanks"))]
    CenteredRanks,
    /// Its fitness, less the mean of its generation as baseline.
    Raw,
}

/// The configuration of [`Pgpe`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PgpeConfig {
    /// The center (x, or mu) of the first generation \[genes\], within 1e100 of zero.
    pub mean: Vec<f64>,
    /// The standard deviation (sigma) of every gene of the first generation, 1e-100 to 1e100.
    pub sigma: f64,
    /// Number of symmetric pairs: a generation has twice as many individuals (lambda).
    pub pairs: usize,
    /// Step size of `ClipUp` (alpha), 1e-100 to 1e100.
    pub step_size: f64,
    /// The most that the center moves in a generation (v max), 1e-100 to 1e100.
    pub max_speed: f64,
    /// Momentum of `ClipUp` (m), 0 to less than 1.
    pub momentum: f64,
    /// Learning rate of the standard deviations (Omega), 0 to 10.
    pub sigma_learning_rate: f64,
    /// The most that a standard deviation changes in a generation, as a share of itself, 0 to less than 1.
    pub sigma_max_change: f64,
    /// The reward of an individual.
    pub fitness: PgpeFitness,
}

impl PgpeConfig {
    /// The parameters of \[Toklu2020\] and of its authors' program, for the given number of pairs. The maximum speed is a
    /// 15th of the initial radius sigma sqrt(n), the step size half of that, and the momentum 0.9. The standard deviations
    /// have a learning rate of 0.1 and a largest change of 0.2. Rewards are centered ranks.
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
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::Config`] or [`EvoError::OutOfRange`].
    pub fn validate(&self) -> Result<(), EvoError> {
        Population::check(self.pairs.saturating_mul(2), self.mean.len())?;
        point("mean", &self.mean)?;
        positive("sigma", self.sigma)?;
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
/// within 1e100 of zero, standard deviations within 1e-100 to 1e100.
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
/// [`Domain::InitialGenome`](farsa_num::Domain::InitialGenome). [`diagnostics`](Strategy::diagnostics) are the speed of
/// the center and the smallest and the largest standard deviation.
#[derive(Clone, Debug, PartialEq)]
pub struct Pgpe {
    config: PgpeConfig,
    seed: u64,
    generation: u32,
    mean: Vec<f64>,
    sigmas: Vec<f64>,
    clip_up: ClipUp,
    /// The noise of this generation.
    directions: Directions,
    population: Population<f64>,
}

impl Pgpe {
    /// A search at its first generation.
    ///
    /// # Errors
    /// The errors of [`PgpeConfig::validate`].
    pub fn new(config: PgpeConfig, seed: u64) -> Result<Self, EvoError> {
        config.validate()?;
        let genes = config.mean.len();
        let population = Population::new(2 * config.pairs, genes)?;
        let (mean, sigmas) = (config.mean.clone(), vec![config.sigma; genes]);
        let directions = Directions::new(config.pairs, genes);
        let clip_up = ClipUp::new(genes);
        let mut strategy = Self { config, seed, generation: 0, mean, sigmas, clip_up, directions, population };
        strategy.sample();
        Ok(strategy)
    }

    /// The configuration.
    pub fn config(&self) -> &PgpeConfig {
        &self.config
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The center \[genes\] of the generation that waits for its fitness.
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// The standard deviations \[genes\] of the generation that waits for its fitness.
    pub fn sigmas(&self) -> &[f64] {
        &self.sigmas
    }

    fn noise(&self) -> Noise {
        Noise { seed: self.seed, generation: self.generation }
    }

    fn sample(&mut self) {
        let noise = self.noise();
        self.directions.mirror(noise, &mut self.population, &self.mean, Spread::Each(&self.sigmas));
    }

    /// Moves the center and the standard deviations by the rewards \[individuals\].
    fn update(&mut self, rewards: &[f64]) {
        let genes = self.mean.len();
        let (count, pairs) = (rewards.len() as f64, self.config.pairs as f64);
        // b, the mean reward, divided before the sum so that it cannot overflow.
        let baseline = rewards.iter().map(|reward| reward / count).sum::<f64>();
        let (mut first, mut second) = (vec![0.0; genes], vec![0.0; genes]);
        for (row, pair) in rewards.chunks_exact(2).enumerate() {
            let weights = [0.5 * (pair[0] - pair[1]), 0.5 * (pair[0] + pair[1]) - baseline];
            self.directions.add_moments(row, weights, &mut first, &mut second);
        }
        first.iter_mut().zip(&self.sigmas).for_each(|(g, sigma)| *g *= sigma / pairs);
        let PgpeConfig { step_size, max_speed, momentum, sigma_learning_rate, sigma_max_change, .. } = self.config;
        self.clip_up.step(&first, step_size, max_speed, momentum);
        for (mean, velocity) in self.mean.iter_mut().zip(self.clip_up.velocity()) {
            *mean = bounded(*mean + velocity);
        }
        let (least, most) = (1.0 - sigma_max_change, 1.0 + sigma_max_change);
        for (sigma, g) in self.sigmas.iter_mut().zip(second) {
            let grown = *sigma + sigma_learning_rate * (*sigma * g / pairs);
            *sigma = bounded_size(grown.clamp(least * *sigma, most * *sigma));
        }
    }
}

impl Strategy<f64> for Pgpe {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population<f64> {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        let next = next_generation(self.generation, self.population.len(), fitness)?;
        let rewards = match self.config.fitness {
            PgpeFitness::CenteredRanks => Some(centered_ranks(fitness)),
            PgpeFitness::Raw => rewards(fitness),
        };
        if let Some(rewards) = rewards {
            self.update(&rewards);
        }
        self.generation = next;
        self.sample();
        Ok(())
    }

    fn record_kind(&self) -> RecordKind {
        match self.config.fitness {
            PgpeFitness::CenteredRanks => RecordKind::Order,
            PgpeFitness::Raw => RecordKind::Values,
        }
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn diagnostics(&self) -> Vec<f64> {
        let sigmas = || self.sigmas.iter().copied();
        let ends = [sigmas().reduce(f64::min), sigmas().reduce(f64::max)];
        [Some(self.clip_up.speed())].into_iter().chain(ends).flatten().collect()
    }
}

impl Snapshot for Pgpe {
    fn save(&self) -> Vec<u8> {
        let mut state = Vec::new();
        state.extend(self.generation.to_le_bytes());
        push_reals(&mut state, &self.mean);
        push_reals(&mut state, &self.sigmas);
        self.clip_up.push(&mut state);
        state
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let genes = self.mean.len();
        let mut reader = StateReader::new(state, 4 + 24 * genes)?;
        let generation = reader.u32()?;
        let (mean, sigmas) = (read_point(&mut reader, genes)?, read_sizes(&mut reader, genes)?);
        let clip_up = ClipUp::read(&mut reader, genes)?;
        (self.generation, self.mean, self.sigmas, self.clip_up) = (generation, mean, sigmas, clip_up);
        self.sample();
        Ok(())
    }
}
