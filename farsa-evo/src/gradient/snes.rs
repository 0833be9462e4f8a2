//! The separable natural evolution strategy.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Scalar, exp, ln};

use super::noise::Noise;
use super::settings::{at_least, bounded, bounded_size, learning_rate, point, positive, read_point, read_sizes};
use super::utilities::{utilities, weights};
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
use crate::snapshot::{Snapshot, StateReader, push_reals};
use crate::strategy::{RecordKind, Strategy, next_generation};

/// The configuration of [`Snes`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SnesConfig {
    /// The mean (mu) of the first generation \[genes\], within 1e100 of zero.
    pub mean: Vec<f64>,
    /// The standard deviation (sigma) of every gene of the first generation, 1e-100 to 1e100.
    pub sigma: f64,
    /// Number of individuals of a generation (lambda), at least 2.
    pub population: usize,
    /// Learning rate of the mean (eta mu), 0 to 10.
    pub mean_learning_rate: f64,
    /// Learning rate of the standard deviations (eta sigma), 0 to 10.
    pub sigma_learning_rate: f64,
}

impl SnesConfig {
    /// The parameters of \[Wierstra2014\] table 1 for d genes: 4 + floor(3 ln d) individuals, learning rates 1 and
    /// (3 + ln d) / (5 sqrt d).
    pub fn new(mean: Vec<f64>, sigma: f64) -> Self {
        let d = mean.len() as f64;
        Self {
            population: Population::default_size(mean.len()),
            mean_learning_rate: 1.0,
            sigma_learning_rate: (3.0 + ln(d)) / (5.0 * Scalar::sqrt(d)),
            mean,
            sigma,
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::Config`] or [`EvoError::OutOfRange`].
    pub fn validate(&self) -> Result<(), EvoError> {
        Population::check(self.population, self.mean.len())?;
        at_least("population", self.population, 2, "2 or more")?;
        point("mean", &self.mean)?;
        positive("sigma", self.sigma)?;
        learning_rate("mean_learning_rate", self.mean_learning_rate)?;
        learning_rate("sigma_learning_rate", self.sigma_learning_rate)
    }
}

/// The separable natural evolution strategy: a normal distribution with a standard deviation for each gene, moved along
/// the natural gradient of the expected fitness.
///
/// Time and memory are proportional to the number of genes. It learns a scale for each gene, but no correlations, for which
/// there is [`Xnes`](crate::gradient::Xnes). Only the order of fitness counts.
///
/// Source: \[Wierstra2014\] algorithm 6 (SNES) with the utilities of table 1. Deviations: sums go through the individuals
/// by index. Means stay within 1e100 of zero, standard deviations within 1e-100 to 1e100.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::gradient::{Snes, SnesConfig};
///
/// let mut search = Snes::new(SnesConfig::new(vec![0.0; 2], 1.0), 1)?;
/// search.maximize(100, |x| -(x[0] - 3.0) * (x[0] - 3.0) - 100.0 * (x[1] + 1.0) * (x[1] + 1.0))?;
/// assert!((search.mean()[0] - 3.0).abs() < 1e-3 && (search.mean()[1] + 1.0).abs() < 1e-3);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
///
/// Individual i of a generation draws from the stream (seed, [`Domain::Mutation`](farsa_num::Domain::Mutation), trial
/// 0, i, generation), that of generation 0 with [`Domain::InitialGenome`](farsa_num::Domain::InitialGenome).
/// [`diagnostics`](Strategy::diagnostics) are the smallest and the largest standard deviation.
#[derive(Clone, Debug, PartialEq)]
pub struct Snes {
    config: SnesConfig,
    seed: u64,
    generation: u32,
    utilities: Vec<f64>,
    mean: Vec<f64>,
    sigmas: Vec<f64>,
    population: Population<f64>,
}

impl Snes {
    /// A search at its first generation.
    ///
    /// # Errors
    /// The errors of [`SnesConfig::validate`].
    pub fn new(config: SnesConfig, seed: u64) -> Result<Self, EvoError> {
        config.validate()?;
        let population = Population::new(config.population, config.mean.len())?;
        let (mean, sigmas) = (config.mean.clone(), vec![config.sigma; config.mean.len()]);
        let utilities = utilities(config.population);
        let mut strategy = Self { config, seed, generation: 0, utilities, mean, sigmas, population };
        strategy.sample();
        Ok(strategy)
    }

    /// The configuration.
    pub fn config(&self) -> &SnesConfig {
        &self.config
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The mean \[genes\] of the generation that waits for its fitness.
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// The standard deviations \[genes\] of the generation that waits for its fitness.
    pub fn sigmas(&self) -> &[f64] {
        &self.sigmas
    }

    fn sample(&mut self) {
        let noise = Noise { seed: self.seed, generation: self.generation };
        noise.spread(&mut self.population, &self.mean, &self.sigmas);
    }
}

impl Strategy<f64> for Snes {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population<f64> {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        let next = next_generation(self.generation, self.population.len(), fitness)?;
        let noise = Noise { seed: self.seed, generation: self.generation };
        let (mut first, mut second) = (vec![0.0; self.mean.len()], vec![0.0; self.mean.len()]);
        for (individual, weight) in weights(fitness, &self.utilities).into_iter().enumerate() {
            noise.add_moments(individual, [weight; 2], &mut first, &mut second);
        }
        let (mean_rate, sigma_rate) = (self.config.mean_learning_rate, 0.5 * self.config.sigma_learning_rate);
        // mu <- mu + eta_mu sigma grad_mu, sigma <- sigma exp(eta_sigma / 2 grad_sigma). [Wierstra2014] algorithm 6.
        for ((mean, sigma), (first, second)) in
            self.mean.iter_mut().zip(&mut self.sigmas).zip(first.iter().zip(&second))
        {
            *mean = bounded(*mean + mean_rate * *sigma * first);
            *sigma = bounded_size(*sigma * exp(sigma_rate * second));
        }
        self.generation = next;
        self.sample();
        Ok(())
    }

    fn record_kind(&self) -> RecordKind {
        RecordKind::Order
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn diagnostics(&self) -> Vec<f64> {
        let sigmas = || self.sigmas.iter().copied();
        [sigmas().reduce(f64::min), sigmas().reduce(f64::max)].into_iter().flatten().collect()
    }
}

impl Snapshot for Snes {
    fn save(&self) -> Vec<u8> {
        let mut state = Vec::new();
        state.extend(self.generation.to_le_bytes());
        push_reals(&mut state, &self.mean);
        push_reals(&mut state, &self.sigmas);
        state
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let genes = self.mean.len();
        let mut reader = StateReader::new(state, 4 + 16 * genes)?;
        let generation = reader.u32()?;
        let (mean, sigmas) = (read_point(&mut reader, genes)?, read_sizes(&mut reader, genes)?);
        (self.generation, self.mean, self.sigmas) = (generation, mean, sigmas);
        self.sample();
        Ok(())
    }
}
