//! The exponential natural evolution strategy.

use alloc::vec;
use alloc::vec::Vec;
use core::slice::{from_mut, from_ref};

use farsa_num::{Scalar, exp, ln};

use super::matrix_exponential::{exponential, mirror, multiply};
use super::optimizer::norm;
use super::settings::{
    LARGEST, at_least, bounded, bounded_size, learning_rate, point, point_row, sizes_row, step_sizes,
};
use super::utilities::{utilities, weights};
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
use crate::search::{Algorithm, Row, Search, Step};
use crate::strategy::RecordKind;

/// The most genes: a matrix of 8 MiB, and some 10^10 products a generation.
const MOST_GENES: usize = 1024;

/// Configuration of [`Xnes`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct XnesConfig {
    /// Initial mean (mu) [genes, at most 1024], within 1e100 of zero.
    pub mean: Vec<f64>,
    /// Initial standard deviation (sigma) of every gene, 1e-100 to 1e100.
    pub sigma: f64,
    /// Number of individuals of a generation (lambda), at least 2.
    pub population: usize,
    /// Learning rate of the mean (eta delta), 0 to 10.
    pub mean_learning_rate: f64,
    /// Learning rate of the step size (eta sigma), 0 to 10.
    pub sigma_learning_rate: f64,
    /// Learning rate of the shape (eta B), 0 to 10.
    pub shape_learning_rate: f64,
    /// Upper limit of the standard deviation of every gene, sigma to 1e100. If genes have a range, use its width. The
    /// default is 1e100.
    pub largest_step: f64,
}

impl XnesConfig {
    /// Creates a configuration with the parameters of \[Wierstra2014\] table 1. For d genes there are 4 + floor(3 ln d)
    /// individuals. Learning rates are 1 for the mean and (9 + 3 ln d) / (5 d sqrt d) for step size and shape.
    pub fn new(mean: Vec<f64>, sigma: f64) -> Self {
        let d = mean.len() as f64;
        let rate = (9.0 + 3.0 * ln(d)) / (5.0 * d * Scalar::sqrt(d));
        Self {
            population: Population::default_size(mean.len()),
            mean_learning_rate: 1.0,
            sigma_learning_rate: rate,
            shape_learning_rate: rate,
            mean,
            sigma,
            largest_step: LARGEST,
        }
    }

    /// Checks the configuration. You usually don't need to call this yourself, since a new search does it as well.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] or [`EvoError::OutOfRange`] for the first setting that is invalid.
    pub fn validate(&self) -> Result<(), EvoError> {
        Population::check(self.population, self.mean.len())?;
        at_least("population", self.population, 2, "2 or more")?;
        let genes = self.mean.len();
        if genes > MOST_GENES {
            return Err(EvoError::OutOfRange { field: "genes", value: genes as f64, allowed: "1 to 1024" });
        }
        point("mean", &self.mean)?;
        step_sizes(self.sigma, self.largest_step)?;
        learning_rate("mean_learning_rate", self.mean_learning_rate)?;
        learning_rate("sigma_learning_rate", self.sigma_learning_rate)?;
        learning_rate("shape_learning_rate", self.shape_learning_rate)
    }
}

/// The exponential natural evolution strategy. A normal distribution with a full covariance moves along the natural
/// gradient of the expected fitness, in coordinates in which it is the identity.
///
/// This strategy learns scales and correlations. Since the time of a generation is proportional to the cube of the
/// number of genes, it is suitable for up to a few hundred of them. Only the order of fitness matters.
///
/// Source: \[Glasmachers2010\] (xNES), as in \[Wierstra2014\] algorithm 5, with the utilities and parameters of its table 1.
/// A genome is mu + sigma B s. B is multiplied from the right by the exponential of a symmetric matrix without trace.
/// Deviations: sums go through the individuals by index. Means stay within 1e100 of zero and sigma within 1e-100 to 1e100.
/// Sigma is lowered where the standard deviation of a gene passes a limit. B does not change where an element would pass
/// 1e100.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::gradient::{Xnes, XnesConfig};
///
/// let mut search = Xnes::new(XnesConfig::new(vec![0.0; 2], 1.0), 1)?;
/// // A valley along the diagonal.
/// search.maximize(200, |x| -(x[0] + x[1] - 2.0) * (x[0] + x[1] - 2.0) - 1e4 * (x[0] - x[1]) * (x[0] - x[1]))?;
/// assert!((search.mean()[0] - 1.0).abs() < 1e-3 && (search.mean()[1] - 1.0).abs() < 1e-3);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
///
/// Individual i of a generation draws from the stream (seed, [`Domain::Mutation`](farsa_num::Domain::Mutation), trial
/// 0, i, generation), that of generation 0 with [`Domain::InitialGenome`](farsa_num::Domain::InitialGenome).
/// [`diagnostics`](crate::Strategy::diagnostics) is sigma.
pub type Xnes = Search<XnesState>;

/// Internal state of [`Xnes`].
#[derive(Clone, Debug, PartialEq)]
pub struct XnesState {
    utilities: Vec<f64>,
    mean: Vec<f64>,
    sigma: f64,
    /// The normalized factor B of the covariance [genes x genes].
    shape: Vec<f64>,
}

impl Xnes {
    /// Gets the mean \[genes\] of the distribution that the current generation is drawn from.
    pub fn mean(&self) -> &[f64] {
        &self.state.mean
    }

    /// Gets the step size sigma of the distribution that the current generation is drawn from.
    pub fn sigma(&self) -> f64 {
        self.state.sigma
    }

    /// Gets the shape B [genes x genes, row after row]. Note that the covariance of a generation is sigma^2 B B^T.
    pub fn shape(&self) -> &[f64] {
        &self.state.shape
    }
}

impl XnesState {
    /// The natural gradient of the mean \[genes\], and that of the exponent [genes x genes].
    fn gradients(&self, step: &Step<'_, XnesConfig>, fitness: &[Fitness]) -> (Vec<f64>, Vec<f64>) {
        let genes = self.mean.len();
        // grad_delta = sum u_k z_k and grad_M = sum u_k (z_k z_k^T - I), the latter by its upper half. [Wierstra2014]
        // algorithm 5.
        let (mut first, mut second) = (vec![0.0; genes], vec![0.0; genes * genes]);
        let mut numbers = vec![0.0; genes];
        for (individual, weight) in weights(fitness, &self.utilities).into_iter().enumerate() {
            step.stream(individual).fill_normal(&mut numbers);
            for (i, (row, x)) in second.chunks_exact_mut(genes).zip(&numbers).enumerate() {
                let scaled = weight * x;
                row[i..].iter_mut().zip(&numbers[i..]).for_each(|(sum, y)| *sum += scaled * y);
                row[i] -= weight;
            }
            first.iter_mut().zip(&numbers).for_each(|(sum, x)| *sum += weight * x);
        }
        mirror(&mut second, genes);
        (first, second)
    }
}

/// The products of the rows of a matrix [n x n] with a vector \[n\].
fn rows_times<'m>(matrix: &'m [f64], vector: &'m [f64]) -> impl Iterator<Item = f64> + 'm {
    matrix.chunks_exact(vector.len()).map(move |row| row.iter().zip(vector).map(|(x, y)| x * y).sum())
}

impl Algorithm for XnesState {
    type Gene = f64;
    type Config = XnesConfig;

    fn start(step: &Step<'_, XnesConfig>) -> Result<(Self, Population<f64>), EvoError> {
        let XnesConfig { mean, sigma, population, .. } = step.config;
        step.config.validate()?;
        let genes = mean.len();
        let mut shape = vec![0.0; genes * genes];
        shape.iter_mut().step_by(genes + 1).for_each(|diagonal| *diagonal = 1.0);
        let state = Self { utilities: utilities(*population), mean: mean.clone(), sigma: *sigma, shape };
        Ok((state, Population::new(*population, genes)?))
    }

    fn advance(&mut self, step: &Step<'_, XnesConfig>, fitness: &[Fitness], _: &mut Population<f64>) {
        let (genes, config) = (self.mean.len(), step.config);
        let (first, mut second) = self.gradients(&step.previous(), fitness);
        // mu <- mu + eta sigma B grad_delta. [Wierstra2014] algorithm 5.
        let rate = config.mean_learning_rate * self.sigma;
        let moves: Vec<f64> = rows_times(&self.shape, &first).collect();
        self.mean.iter_mut().zip(moves).for_each(|(mean, turned)| *mean = bounded(*mean + rate * turned));

        // The trace of the gradient grows sigma, the rest turns and stretches B.
        // M = (tr M / n) I + rest. With it sigma <- sigma exp(eta_sigma / 2 tr M / n) and B <- B exp(eta_B / 2 rest).
        let growth = second.iter().step_by(genes + 1).sum::<f64>() / genes as f64;
        self.sigma = bounded_size(self.sigma * exp(0.5 * config.sigma_learning_rate * growth), LARGEST);
        second.iter_mut().step_by(genes + 1).for_each(|diagonal| *diagonal -= growth);
        for x in &mut second {
            *x *= 0.5 * config.shape_learning_rate;
        }
        // B keeps its value if the exponential or the product is too large or NaN.
        if let Some(factor) = exponential(&second, genes) {
            let shape = multiply(&self.shape, &factor, genes);
            if shape.iter().all(|x| x.abs() <= LARGEST) {
                self.shape = shape;
            }
        }
        // The standard deviation of gene i is sigma |B_i|, with row i of B.
        let longest = self.shape.chunks_exact(genes).map(norm).fold(0.0, f64::max);
        if self.sigma * longest > config.largest_step {
            self.sigma = bounded_size(config.largest_step / longest, LARGEST);
        }
    }

    fn draw(&mut self, step: &Step<'_, XnesConfig>, genomes: &mut Population<f64>) {
        let mut numbers = vec![0.0; self.mean.len()];
        for (individual, genes) in genomes.iter_mut().enumerate() {
            step.stream(individual).fill_normal(&mut numbers);
            // x = mu + sigma B z.
            let turned = rows_times(&self.shape, &numbers);
            for ((gene, mean), turned) in genes.iter_mut().zip(&self.mean).zip(turned) {
                *gene = mean + self.sigma * turned;
            }
        }
    }

    fn record_kind(_: &XnesConfig) -> RecordKind {
        RecordKind::Order
    }

    fn diagnostics(&self, _: &XnesConfig) -> Vec<f64> {
        vec![self.sigma]
    }

    fn rows(&self) -> Vec<&[f64]> {
        vec![&self.mean, from_ref(&self.sigma), &self.shape]
    }

    fn rows_mut(&mut self) -> Vec<Row<'_>> {
        let Self { mean, sigma, shape, .. } = self;
        vec![point_row(mean), sizes_row(from_mut(sigma)), (shape, "an element of a shape", [-LARGEST, LARGEST])]
    }
}
