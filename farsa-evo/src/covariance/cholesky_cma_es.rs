//! Covariance matrix adaptation by a Cholesky factor.

use alloc::vec;
use alloc::vec::Vec;

use crate::covariance::cholesky::CholeskyCovariance;
use crate::covariance::cma_es::CmaEsConfig;
use crate::covariance::coefficients::ranked;
use crate::covariance::distribution::Distribution;
use crate::covariance::search::search;
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
use crate::snapshot::{Snapshot, StateReader};
use crate::strategy::{Strategy, next_generation};

/// Covariance matrix adaptation that draws by a triangular factor of the covariance matrix in the place of its axes: a generation
/// of many genes takes a fraction of the time of a [`CmaEs`](crate::covariance::CmaEs), whose axes take most of it.
///
/// It is a `CmaEs` in all but one thing: the path of the step size turns steps by A^-1 of C = A A^T, not by C^-1/2, so that it
/// is another one once C is no multiple of the identity. It learns as well. Configuration, random numbers, and what is said of
/// failed evaluations are those of `CmaEs`.
///
/// Source: \[Krause2016\], whose factor is updated in every generation; ours is computed of C every 1 / (10 n (`c_1` + `c_mu`))
/// generations. Deviations: those of `CmaEs`, with squares on the factor's diagonal of at least 10^-16 of the largest variance.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::covariance::{CholeskyCmaEs, CmaEsConfig};
///
/// let mut search = CholeskyCmaEs::new(CmaEsConfig::new(vec![0.0; 3], 0.5), 1)?;
/// let goal = [1.0, -2.0, 0.5];
/// let champion = search.maximize(120, |x| -x.iter().zip(goal).map(|(x, goal)| (x - goal) * (x - goal)).sum::<f64>())?;
/// assert!(champion.fitness.get() > -1e-10);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CholeskyCmaEs {
    config: CmaEsConfig,
    seed: u64,
    generation: u32,
    distribution: Distribution<CholeskyCovariance>,
    population: Population<f64>,
}

impl CholeskyCmaEs {
    /// A search at its first generation.
    ///
    /// # Errors
    /// Those of [`CmaEsConfig::validate`].
    pub fn new(config: CmaEsConfig, seed: u64) -> Result<Self, EvoError> {
        config.validate()?;
        let mut population = Population::new(config.population, config.mean.len())?;
        let mut distribution = Distribution::new(config.mean.clone(), config.sigma, config.coefficients());
        distribution.sample(seed, 0, &mut population);
        Ok(Self { config, seed, generation: 0, distribution, population })
    }

    /// The configuration.
    pub fn config(&self) -> &CmaEsConfig {
        &self.config
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The mean m \[genes\] of the current generation's distribution: the best guess where fitness is noisy.
    pub fn mean(&self) -> &[f64] {
        &self.distribution.mean
    }

    /// The step size sigma.
    pub fn sigma(&self) -> f64 {
        self.distribution.sigma
    }

    /// The covariance matrix C [genes x genes], as of the latest update; individuals are drawn with sigma^2 times it.
    pub fn covariance(&self) -> Vec<f64> {
        self.distribution.covariance.matrix()
    }

    /// The ratio of the largest to the smallest number on the factor's diagonal, which that of the axes is no less than.
    pub fn axis_ratio(&self) -> f64 {
        self.distribution.axis_ratio()
    }
}

/// How many generations are told again in some seconds, of 0.02 s for 792 genes.
fn between_states(genes: usize) -> u32 {
    let cube = (genes as u64).saturating_pow(3).max(1);
    u32::try_from(100_000_000_000 / cube).unwrap_or(u32::MAX).max(1)
}

search!(CholeskyCmaEs, CholeskyCovariance, between_states);
