//! The evolution strategy of `OpenAI`.

use alloc::vec;
use alloc::vec::Vec;

use super::mirrored::Mirrored;
use super::optimizer::{Memory, Optimizer};
use super::settings::{point, positive};
use super::utilities::centered_ranks;
use crate::error::{EvoError, check_range};
use crate::fitness::Fitness;
use crate::population::Population;
use crate::search::{Algorithm, Row, Search, Step};
use crate::strategy::RecordKind;

/// Configuration of [`OpenAiEs`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OpenAiEsConfig {
    /// Initial parameters (theta) \[genes\], within 1e100 of zero.
    pub mean: Vec<f64>,
    /// Number of antithetic pairs. Note that a generation has twice as many individuals (n).
    pub pairs: usize,
    /// Standard deviation of the noise (sigma), 1e-100 to 1e100.
    pub sigma: f64,
    /// Learning rate (alpha), 1e-100 to 1e100.
    pub learning_rate: f64,
    /// Weight decay, which is subtracted from the gradient for each unit of a parameter, 0 to 1e9.
    pub weight_decay: f64,
    /// Optimizer that turns the gradient into a step.
    pub optimizer: Optimizer,
}

impl OpenAiEsConfig {
    /// The parameters of the program of the authors of \[Salimans2017\] for its humanoid, with noise of 0.02 and
    /// [`Optimizer::ADAM`] with a learning rate of 0.01. The weight decay is 0.005 / sigma (0.005 there, where the gradient
    /// is not divided by sigma).
    pub const fn new(mean: Vec<f64>, pairs: usize) -> Self {
        let (sigma, weight_decay) = (0.02, 0.25);
        Self { mean, pairs, sigma, learning_rate: 0.01, weight_decay, optimizer: Optimizer::ADAM }
    }

    /// Checks the configuration. You usually don't need to call this yourself, since a new search does it as well.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] or [`EvoError::OutOfRange`] for the first setting that is invalid.
    pub fn validate(&self) -> Result<(), EvoError> {
        Population::check(self.pairs.saturating_mul(2), self.mean.len())?;
        point("mean", &self.mean)?;
        positive("sigma", self.sigma)?;
        positive("learning_rate", self.learning_rate)?;
        check_range("weight_decay", self.weight_decay, [0.0, 1e9], "0 to 1e9")?;
        self.optimizer.validate()
    }
}

/// The evolution strategy of `OpenAI`: mirrored noise of one size around one point, which an optimizer moves.
///
/// Use this for genomes with very many genes, since it stores only the noise, the point and the state of the optimizer
/// apart from the genomes. It does not learn scales, and sigma is constant. Only the order of fitness matters.
///
/// Source: \[Salimans2017\] algorithm 1, gradient 1 / (n sigma) times the sum of centered ranks times noise. Section 2 has
/// the antithetic sampling, the rank transformation and the weight decay. Deviations: noise is drawn, not read from a
/// table. Sums go through the pairs by index. The point stays within 1e100 of zero.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::gradient::{OpenAiEs, OpenAiEsConfig};
///
/// let paper = OpenAiEsConfig::new(vec![0.0; 2], 10);
/// let config = OpenAiEsConfig { sigma: 0.1, learning_rate: 0.05, weight_decay: 0.0, ..paper };
/// let mut search = OpenAiEs::new(config, 1)?;
/// search.maximize(200, |x| -(x[0] - 3.0) * (x[0] - 3.0) - (x[1] + 1.0) * (x[1] + 1.0))?;
/// assert!((search.mean()[0] - 3.0).abs() < 0.2 && (search.mean()[1] + 1.0).abs() < 0.2);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
///
/// Individuals 2k and 2k + 1 are pair k, which adds and subtracts the noise of the stream (seed,
/// [`Domain::Mutation`](farsa_num::Domain::Mutation), trial 0, k, generation), in generation 0 with
/// [`Domain::InitialGenome`](farsa_num::Domain::InitialGenome). [`diagnostics`](crate::Strategy::diagnostics) are the
/// Euclidean lengths of the latest step and of the point.
pub type OpenAiEs = Search<OpenAiEsState>;

/// Internal state of [`OpenAiEs`].
#[derive(Clone, Debug, PartialEq)]
pub struct OpenAiEsState {
    memory: Memory,
    samples: Mirrored,
}

impl OpenAiEs {
    /// Gets the point \[genes\] around which the individuals are placed.
    pub fn mean(&self) -> &[f64] {
        &self.state.samples.mean
    }
}

impl Algorithm for OpenAiEsState {
    type Gene = f64;
    type Config = OpenAiEsConfig;

    fn start(step: &Step<'_, OpenAiEsConfig>) -> Result<(Self, Population<f64>), EvoError> {
        let OpenAiEsConfig { mean, pairs, optimizer, .. } = step.config;
        step.config.validate()?;
        let state = Self { memory: Memory::new(*optimizer, mean.len()), samples: Mirrored::new(mean, *pairs) };
        Ok((state, Population::new(2 * pairs, mean.len())?))
    }

    fn advance(&mut self, step: &Step<'_, OpenAiEsConfig>, fitness: &[Fitness], _: &mut Population<f64>) {
        let OpenAiEsConfig { sigma, learning_rate, weight_decay, optimizer, .. } = *step.config;
        let mut gradient = vec![0.0; self.samples.mean.len()];
        for (row, pair) in centered_ranks(fitness).chunks_exact(2).enumerate() {
            // A pair has the noise z and -z, so its two terms are (r+ - r-) z.
            self.samples.directions.add(row, pair[0] - pair[1], &mut gradient);
        }
        let scale = 1.0 / (fitness.len() as f64 * sigma);
        for (g, mean) in gradient.iter_mut().zip(&self.samples.mean) {
            // g = 1 / (n sigma) sum (r+ - r-) z - decay theta. [Salimans2017] algorithm 1.
            *g = scale * *g - weight_decay * mean;
        }
        self.memory.step(optimizer, learning_rate, &mut gradient);
        self.samples.advance(&gradient);
        // An infinite length would not be valid in a saved state.
        self.samples.step = self.samples.step.min(f64::MAX);
    }

    fn draw(&mut self, step: &Step<'_, OpenAiEsConfig>, genomes: &mut Population<f64>) {
        self.samples.draw(step, step.config.sigma, genomes);
    }

    fn record_kind(_: &OpenAiEsConfig) -> RecordKind {
        RecordKind::Order
    }

    fn diagnostics(&self, _: &OpenAiEsConfig) -> Vec<f64> {
        self.samples.diagnostics()
    }

    fn rows(&self) -> Vec<&[f64]> {
        [self.samples.rows(), self.memory.rows()].concat()
    }

    fn rows_mut(&mut self) -> Vec<Row<'_>> {
        self.samples.rows_mut().into_iter().chain(self.memory.rows_mut()).collect()
    }
}
