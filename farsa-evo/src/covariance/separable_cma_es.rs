//! Covariance matrix adaptation of the diagonal alone.

use alloc::vec;
use alloc::vec::Vec;

use crate::covariance::cma_es::check_start;
use crate::covariance::coefficients::{Coefficients, default_population, ranked};
use crate::covariance::diagonal::DiagonalCovariance;
use crate::covariance::distribution::Distribution;
use crate::covariance::search::search;
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
use crate::snapshot::{Snapshot, StateReader};
use crate::strategy::{Strategy, next_generation};

/// What a [`SeparableCmaEs`] needs to know; a plain value that is checked where it is used.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SeparableCmaEsConfig {
    /// The initial mean m, a number for each gene, of magnitude up to 10^100.
    pub mean: Vec<f64>,
    /// The initial step size sigma, 10^-100 to 10^100, in the unit of the genes: about a third of how far the optimum may lie
    /// from the mean in each gene.
    pub sigma: f64,
    /// Number of individuals lambda, at least 2.
    pub population: usize,
}

impl SeparableCmaEsConfig {
    /// The defaults of \[Ros2008\] for n genes: 4 + 3 ln n individuals, rounded down.
    pub fn new(mean: Vec<f64>, sigma: f64) -> Self {
        let population = default_population(mean.len());
        Self { mean, sigma, population }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::NoGenes`], [`EvoError::NoIndividuals`], [`EvoError::TooLarge`] or [`EvoError::Setting`].
    pub fn validate(&self) -> Result<(), EvoError> {
        check_start(&self.mean, self.sigma, self.population)
    }

    fn coefficients(&self) -> Coefficients {
        let faster = (self.mean.len() as f64 + 2.0) / 3.0;
        let rates = |one: f64, mu: f64| {
            let one = (one * faster).min(1.0);
            (one, (mu * faster).min(1.0 - one))
        };
        Coefficients::new(self.mean.len(), self.population, false, None, rates)
    }
}

/// Covariance matrix adaptation with a diagonal matrix: each gene has a variance of its own, and genes stay independent.
///
/// The time of a generation rises with the number of genes, not with its square as that of a [`CmaEs`](crate::covariance::CmaEs), and it
/// learns (n + 2) / 3 times as fast. It is for many genes, or where genes matter one by one.
///
/// Equals rank by index; failed evaluations rank last. A generation of which all evaluations failed leaves the distribution
/// as it is, which is why values are recorded and not the order alone. Random numbers are those of a `CmaEs`.
///
/// Source: \[Ros2008\], with the weights and rates of \[Hansen2016\] table 1, those of the covariance times (n + 2) / 3 and no
/// more than 1 together. Deviations: larger fitness is better; the numerical limits of `CmaEs`, with variances of at
/// least 10^-30 of the largest. No weight is negative, as in the source.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::covariance::{SeparableCmaEs, SeparableCmaEsConfig};
///
/// let mut search = SeparableCmaEs::new(SeparableCmaEsConfig::new(vec![1.0; 20], 0.5), 1)?;
/// let champion = search.maximize(400, |x| -x.iter().map(|x| x * x).sum::<f64>())?;
/// assert!(champion.fitness.get() > -1e-10);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SeparableCmaEs {
    config: SeparableCmaEsConfig,
    seed: u64,
    generation: u32,
    distribution: Distribution<DiagonalCovariance>,
    population: Population<f64>,
}

impl SeparableCmaEs {
    /// A search at its first generation.
    ///
    /// # Errors
    /// Those of [`SeparableCmaEsConfig::validate`].
    pub fn new(config: SeparableCmaEsConfig, seed: u64) -> Result<Self, EvoError> {
        config.validate()?;
        let mut population = Population::new(config.population, config.mean.len())?;
        let mut distribution = Distribution::new(config.mean.clone(), config.sigma, config.coefficients());
        distribution.sample(seed, 0, &mut population);
        Ok(Self { config, seed, generation: 0, distribution, population })
    }

    /// The configuration.
    pub fn config(&self) -> &SeparableCmaEsConfig {
        &self.config
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The mean m \[genes\] of the current generation's distribution.
    pub fn mean(&self) -> &[f64] {
        &self.distribution.mean
    }

    /// The step size sigma.
    pub fn sigma(&self) -> f64 {
        self.distribution.sigma
    }

    /// The variances \[genes\], the diagonal of C; individuals are drawn with sigma^2 times them.
    pub fn variances(&self) -> &[f64] {
        &self.distribution.covariance.variances
    }

    /// The ratio of the longest to the shortest axis of the distribution.
    pub fn axis_ratio(&self) -> f64 {
        self.distribution.axis_ratio()
    }
}

search!(SeparableCmaEs, DiagonalCovariance, |_| u32::MAX);
