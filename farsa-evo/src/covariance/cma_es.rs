//! Covariance matrix adaptation.

use alloc::vec;
use alloc::vec::Vec;

use crate::covariance::cholesky::Cholesky;
use crate::covariance::config::{CmaEsConfig, Start};
use crate::covariance::diagonal::Diagonal;
use crate::covariance::distribution::{Covariance, Distribution};
use crate::covariance::full::Full;
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
use crate::snapshot::{Snapshot, StateReader};
use crate::strategy::{Strategy, next_generation};

/// Covariance matrix adaptation with a Cholesky factor. A generation of many genes takes a fraction of the time of
/// [`CmaEs<Full>`](CmaEs), which spends most of it on the axes.
///
/// There is only one difference to [`CmaEs<Full>`](CmaEs). Here, the path of the step size turns steps by A^-1 of C = A
/// A^T instead of C^-1/2. Both paths differ once C is no longer a multiple of the identity.
///
/// Source: \[Krause2016\], which updates the factor in every generation. Here it is computed from C every
/// 1 / (10 n (`c_1` + `c_mu`)) generations. Deviations: those of `CmaEs`, and squares on the factor's diagonal are at least
/// 10^-16 of the largest.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::covariance::{CholeskyCmaEs, CmaEsConfig};
///
/// let mut search = CholeskyCmaEs::with_covariance(CmaEsConfig::new(vec![0.0; 3], 0.5), 1)?;
/// let goal = [1.0, -2.0, 0.5];
/// let champion = search.maximize(120, |x| -x.iter().zip(goal).map(|(x, goal)| (x - goal) * (x - goal)).sum::<f64>())?;
/// assert!(champion.fitness.get() > -1e-10);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
pub type CholeskyCmaEs = CmaEs<Cholesky>;

/// Covariance matrix adaptation with a diagonal matrix. Each gene has its own variance and genes stay independent.
///
/// Since the time of a generation is proportional to the number of genes instead of its square, this is suitable for
/// very many genes. It also learns (n + 2) / 3 times as fast as [`CmaEs<Full>`](CmaEs). Note that it cannot learn
/// correlations between genes.
///
/// Source: \[Ros2008\], with the weights and rates of \[Hansen2016\] table 1. The rates of the covariance are multiplied by
/// (n + 2) / 3 and sum to at most 1. Deviations: larger fitness is better, and variances are at least 10^-30 of the largest. No
/// weight is negative, as in the source.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::covariance::{SeparableCmaEs, SeparableCmaEsConfig};
///
/// let mut search = SeparableCmaEs::with_covariance(SeparableCmaEsConfig::new(vec![1.0; 20], 0.5), 1)?;
/// let champion = search.maximize(400, |x| -x.iter().map(|x| x * x).sum::<f64>())?;
/// assert!(champion.fitness.get() > -1e-10);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
pub type SeparableCmaEs = CmaEs<Diagonal>;

/// Covariance matrix adaptation (CMA-ES) over unbounded real genes. Individuals are drawn from a normal distribution,
/// and its mean, step size and covariance follow the better ones.
///
/// Only the order of the individuals matters for this search. It is invariant to rotations of the genes, and it learns
/// their scales and correlations. An update takes n^2 operations for each individual. Computing the axes of the
/// distribution takes n^3 operations, but this is done only once every 1 / (10 n (`c_1` + `c_mu`)) generations. Use
/// this for up to about a thousand genes.
///
/// Individuals that are equally good are ranked by index, and failed evaluations come last. If all evaluations of a
/// generation failed, the distribution remains unchanged and the next generation is drawn from it again. This is why
/// records contain values, since an order does not show that a generation failed.
///
/// Individual `i` of generation `g` draws from the stream (seed, [`Domain::Mutation`](farsa_num::Domain::Mutation), trial 0,
/// `i`, `g`), in generation 0 from [`Domain::InitialGenome`](farsa_num::Domain::InitialGenome).
/// [`diagnostics`](Strategy::diagnostics) are the step size and the axis ratio.
///
/// Source: \[Hansen2016\] appendix A. Deviations: larger fitness is better. Variances along axes are at least 10^-16 of the
/// largest. The step size is at least 10^-100, and lowered where the standard deviation of a gene passes a limit. Where the largest variance leaves 10^-30 to 10^30, the excess moves
/// into the step size.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::covariance::{CmaEs, CmaEsConfig};
///
/// let mut search = CmaEs::new(CmaEsConfig::new(vec![0.0; 3], 0.5), 1)?;
/// let goal = [1.0, -2.0, 0.5];
/// let champion = search.maximize(120, |x| -x.iter().zip(goal).map(|(x, goal)| (x - goal) * (x - goal)).sum::<f64>())?;
/// assert!(champion.fitness.get() > -1e-10);
/// assert!(search.sigma() < 1e-4);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CmaEs<C: Covariance = Full> {
    config: C::Config,
    seed: u64,
    generation: u32,
    distribution: Distribution<C>,
    population: Population<f64>,
}

impl CmaEs {
    /// Creates a new search with a full covariance matrix. For other kinds of matrices, use
    /// [`with_covariance`](Self::with_covariance).
    ///
    /// # Errors
    /// Returns the errors of [`CmaEsConfig::validate`].
    pub fn new(config: CmaEsConfig, seed: u64) -> Result<Self, EvoError> {
        Self::with_covariance(config, seed)
    }
}

impl<C: Covariance> CmaEs<C> {
    /// Creates a new search whose kind of covariance matrix is given by the type.
    ///
    /// # Errors
    /// Returns the errors of [`CmaEsConfig::validate`] or
    /// [`SeparableCmaEsConfig::validate`](crate::covariance::SeparableCmaEsConfig::validate).
    pub fn with_covariance(config: C::Config, seed: u64) -> Result<Self, EvoError> {
        config.check()?;
        let (mean, sigma, population) = config.start();
        let mut population = Population::new(population, mean.len())?;
        let mut distribution = Distribution::new(mean.to_vec(), sigma, config.largest_step(), config.coefficients());
        distribution.sample(seed, 0, &mut population);
        Ok(Self { config, seed, generation: 0, distribution, population })
    }

    /// Gets the configuration that this search was created with.
    pub fn config(&self) -> &C::Config {
        &self.config
    }

    /// Gets the seed that this search was created with.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Gets the mean m \[genes\] of the distribution that the current generation is drawn from. If fitness is noisy,
    /// this is a better result than the champion.
    pub fn mean(&self) -> &[f64] {
        &self.distribution.mean
    }

    /// Gets the current step size sigma.
    pub fn sigma(&self) -> f64 {
        self.distribution.sigma
    }

    /// Computes the covariance matrix C [genes x genes] after the latest update. Note that individuals are drawn with
    /// sigma^2 C.
    pub fn covariance(&self) -> Vec<f64> {
        self.distribution.covariance.matrix()
    }

    /// Computes the ratio of the longest to the shortest axis of the distribution. For [`Cholesky`], this is the ratio
    /// of the largest to the smallest number on the diagonal of the factor. That is only a lower bound of the ratio of
    /// the axes.
    pub fn axis_ratio(&self) -> f64 {
        self.distribution.axis_ratio()
    }
}

impl SeparableCmaEs {
    /// Gets the variance of each gene \[genes\], which is the diagonal of C. Note that individuals are drawn with
    /// sigma^2 times these.
    pub fn variances(&self) -> &[f64] {
        &self.distribution.covariance.variances
    }
}

impl<C: Covariance> Strategy<f64> for CmaEs<C> {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population<f64> {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        self.generation = next_generation(self.generation, self.population.len(), fitness)?;
        if fitness.iter().any(|fitness| !fitness.is_failed()) {
            self.distribution.update(&Fitness::ranking(fitness));
        }
        self.distribution.sample(self.seed, self.generation, &mut self.population);
        Ok(())
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn diagnostics(&self) -> Vec<f64> {
        vec![self.sigma(), self.axis_ratio()]
    }
}

impl<C: Covariance> Snapshot for CmaEs<C> {
    fn save(&self) -> Vec<u8> {
        let mut state = Vec::with_capacity(4 + Distribution::<C>::state_length(self.mean().len()));
        state.extend(self.generation.to_le_bytes());
        self.distribution.save(&mut state);
        state
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let mut reader = StateReader::new(state, 4 + Distribution::<C>::state_length(self.mean().len()))?;
        let generation = reader.u32()?;
        let mut distribution = self.distribution.clone();
        distribution.restore(&mut reader)?;
        (self.generation, self.distribution) = (generation, distribution);
        self.distribution.sample(self.seed, generation, &mut self.population);
        Ok(())
    }

    fn snapshot_interval(&self) -> u32 {
        C::snapshot_interval(self.mean().len())
    }
}
