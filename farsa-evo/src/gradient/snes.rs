//! The separable natural evolution strategy.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Scalar, exp, ln};

use super::settings::{
    LARGEST, at_least, bounded, bounded_size, ends, learning_rate, point, point_row, sizes_row, step_sizes,
};
use super::utilities::{utilities, weights};
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
use crate::search::{Algorithm, Row, Search, Step};
use crate::strategy::RecordKind;

/// Configuration of [`Snes`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SnesConfig {
    /// Initial mean (mu) \[genes\], within 1e100 of zero.
    pub mean: Vec<f64>,
    /// Initial standard deviation (sigma) of every gene, 1e-100 to 1e100.
    pub sigma: f64,
    /// Number of individuals of a generation (lambda), at least 2.
    pub population: usize,
    /// Learning rate of the mean (eta mu), 0 to 10.
    pub mean_learning_rate: f64,
    /// Learning rate of the standard deviations (eta sigma), 0 to 10.
    pub sigma_learning_rate: f64,
    /// Upper limit of the standard deviation of every gene, sigma to 1e100. If genes have a range, use its width. The
    /// default is 1e100.
    pub largest_step: f64,
}

impl SnesConfig {
    /// Creates a configuration with the parameters of \[Wierstra2014\] table 1. For d genes there are 4 + floor(3 ln d)
    /// individuals, and the learning rates are 1 and (3 + ln d) / (5 sqrt d).
    pub fn new(mean: Vec<f64>, sigma: f64) -> Self {
        let d = mean.len() as f64;
        Self {
            population: Population::default_size(mean.len()),
            mean_learning_rate: 1.0,
            sigma_learning_rate: (3.0 + ln(d)) / (5.0 * Scalar::sqrt(d)),
            mean,
            sigma,
            largest_step: LARGEST,
        }
    }

    /// Checks that all settings are within their allowed ranges.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] or [`EvoError::OutOfRange`] for the first setting that is invalid.
    pub fn validate(&self) -> Result<(), EvoError> {
        Population::check(self.population, self.mean.len())?;
        at_least("population", self.population, 2, "2 or more")?;
        point("mean", &self.mean)?;
        step_sizes(self.sigma, self.largest_step)?;
        learning_rate("mean_learning_rate", self.mean_learning_rate)?;
        learning_rate("sigma_learning_rate", self.sigma_learning_rate)
    }
}

/// The separable natural evolution strategy: a normal distribution with a standard deviation for each gene, moved along
/// the natural gradient of the expected fitness.
///
/// Both time and memory are proportional to the number of genes. This strategy learns a scale for each gene, but no
/// correlations. If you need them, use [`Xnes`](crate::gradient::Xnes). Only the order of fitness matters.
///
/// Source: \[Wierstra2014\] algorithm 6 (SNES) with the utilities of table 1. Deviations: sums go through the individuals
/// by index. Means stay within 1e100 of zero, standard deviations between 1e-100 and a limit.
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
/// [`diagnostics`](crate::Strategy::diagnostics) are the smallest and the largest standard deviation.
pub type Snes = Search<SnesState>;

/// Internal state of [`Snes`].
#[derive(Clone, Debug, PartialEq)]
pub struct SnesState {
    utilities: Vec<f64>,
    mean: Vec<f64>,
    sigmas: Vec<f64>,
}

impl Snes {
    /// Gets the mean \[genes\] of the distribution that the current generation is drawn from.
    pub fn mean(&self) -> &[f64] {
        &self.state.mean
    }

    /// Gets the standard deviations \[genes\] of the distribution that the current generation is drawn from.
    pub fn sigmas(&self) -> &[f64] {
        &self.state.sigmas
    }
}

impl Algorithm for SnesState {
    type Gene = f64;
    type Config = SnesConfig;

    fn start(step: &Step<'_, SnesConfig>) -> Result<(Self, Population<f64>), EvoError> {
        let SnesConfig { mean, sigma, population, .. } = step.config;
        step.config.validate()?;
        let state = Self { utilities: utilities(*population), mean: mean.clone(), sigmas: vec![*sigma; mean.len()] };
        Ok((state, Population::new(*population, mean.len())?))
    }

    fn advance(&mut self, step: &Step<'_, SnesConfig>, fitness: &[Fitness], _: &mut Population<f64>) {
        let (mut first, mut second) = (vec![0.0; self.mean.len()], vec![0.0; self.mean.len()]);
        for (individual, weight) in weights(fitness, &self.utilities).into_iter().enumerate() {
            // Fitness belongs to the numbers of the previous generation.
            step.previous().add_moments(individual, [weight; 2], &mut first, &mut second);
        }
        let (mean_rate, sigma_rate) = (step.config.mean_learning_rate, 0.5 * step.config.sigma_learning_rate);
        // mu <- mu + eta_mu sigma grad_mu, sigma <- sigma exp(eta_sigma / 2 grad_sigma). [Wierstra2014] algorithm 6.
        for ((mean, sigma), (first, second)) in
            self.mean.iter_mut().zip(&mut self.sigmas).zip(first.iter().zip(&second))
        {
            // The mean moves by the sigma of the samples, so it changes first.
            *mean = bounded(*mean + mean_rate * *sigma * first);
            *sigma = bounded_size(*sigma * exp(sigma_rate * second), step.config.largest_step);
        }
    }

    fn draw(&mut self, step: &Step<'_, SnesConfig>, genomes: &mut Population<f64>) {
        step.spread(genomes, &self.mean, &self.sigmas);
    }

    fn record_kind(_: &SnesConfig) -> RecordKind {
        RecordKind::Order
    }

    fn diagnostics(&self, _: &SnesConfig) -> Vec<f64> {
        ends(&self.sigmas)
    }

    fn rows(&self) -> Vec<&[f64]> {
        vec![&self.mean, &self.sigmas]
    }

    fn rows_mut(&mut self) -> Vec<Row<'_>> {
        vec![point_row(&mut self.mean), sizes_row(&mut self.sigmas)]
    }
}
