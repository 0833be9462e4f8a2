//! Covariance matrix adaptation.

use alloc::vec;
use alloc::vec::Vec;

use crate::covariance::coefficients::{Coefficients, check, default_population, ranked};
use crate::covariance::distribution::{Distribution, MEANS, STEP_SIZES};
use crate::covariance::full::FullCovariance;
use crate::covariance::search::search;
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
use crate::snapshot::{Snapshot, StateReader};
use crate::strategy::{Strategy, next_generation};

/// What a [`CmaEs`] needs to know; a plain value that is checked where it is used.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CmaEsConfig {
    /// The initial mean m, a number for each gene, of magnitude up to 10^100.
    pub mean: Vec<f64>,
    /// The initial step size sigma, 10^-100 to 10^100, in the unit of the genes: about a third of how far the optimum may lie
    /// from the mean in each gene.
    pub sigma: f64,
    /// Number of individuals lambda, at least 2. \[Hansen2016\] eq. 48.
    pub population: usize,
    /// Whether the worse half has negative weights. \[Hansen2016\] eq. 53.
    pub active: bool,
    /// The rate of the rank-one update `c_1`, 0 to 1, if not that of \[Hansen2016\] eq. 57.
    pub rank_one_rate: Option<f64>,
    /// The rate of the rank-mu update `c_mu`, 0 to 1 - `c_1`, if not that of \[Hansen2016\] eq. 58.
    pub rank_mu_rate: Option<f64>,
    /// The damping of the step size `d_sigma`, 0.001 to 1000, if not that of \[Hansen2016\] eq. 55.
    pub damping: Option<f64>,
}

impl CmaEsConfig {
    /// The defaults of \[Hansen2016\] table 1 for n genes: 4 + 3 ln n individuals, rounded down, and negative weights.
    pub fn new(mean: Vec<f64>, sigma: f64) -> Self {
        let population = default_population(mean.len());
        Self { mean, sigma, population, active: true, rank_one_rate: None, rank_mu_rate: None, damping: None }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::NoGenes`], [`EvoError::NoIndividuals`], [`EvoError::TooLarge`] for more genes of a population, or elements of
    /// the covariance matrix, than [`Population::MAX_GENES`]; [`EvoError::Setting`].
    pub fn validate(&self) -> Result<(), EvoError> {
        let genes = self.mean.len();
        check_start(&self.mean, self.sigma, self.population)?;
        Population::check(genes, genes)?;
        let rank_one = self.rank_one_rate.unwrap_or(0.0);
        check("rank_one_rate", rank_one, [0.0, 1.0], "0 to 1")?;
        let rank_one =
            self.rank_one_rate.unwrap_or(Coefficients::new(genes, self.population, false, None, same).rank_one);
        check("rank_mu_rate", self.rank_mu_rate.unwrap_or(0.0), [0.0, 1.0 - rank_one], "0 to 1 - rank_one_rate")?;
        check("damping", self.damping.unwrap_or(1.0), [0.001, 1000.0], "0.001 to 1000")
    }

    pub(super) fn coefficients(&self) -> Coefficients {
        self.coefficients_of(self.population)
    }

    /// The coefficients of another number of individuals.
    pub(super) fn coefficients_of(&self, population: usize) -> Coefficients {
        let rates = |one: f64, mu: f64| {
            let one = self.rank_one_rate.unwrap_or(one);
            (one, self.rank_mu_rate.unwrap_or(mu).min(1.0 - one))
        };
        Coefficients::new(self.mean.len(), population, self.active, self.damping, rates)
    }
}

fn same(rank_one: f64, rank_mu: f64) -> (f64, f64) {
    (rank_one, rank_mu)
}

/// Checks what all searches of a normal distribution start from.
pub(super) fn check_start(mean: &[f64], sigma: f64, population: usize) -> Result<(), EvoError> {
    Population::check(population, mean.len())?;
    check("population", population as f64, [2.0, f64::INFINITY], "at least 2")?;
    check("sigma", sigma, STEP_SIZES, "1e-100 to 1e100")?;
    mean.iter().try_for_each(|&x| check("mean", x, MEANS, "-1e100 to 1e100"))
}

/// Covariance matrix adaptation: individuals are drawn from a normal distribution, whose mean, step size and covariance
/// follow the better ones. Genes are unbounded reals.
///
/// It asks for nothing but the order of the individuals, searches alike however the axes of the genes are turned, and learns
/// how genes are scaled and which depend on each other. An update takes n^2 operations an individual, and the axes of the
/// distribution, computed every 1 / (10 n (`c_1` + `c_mu`)) generations, n^3: it is for up to about a thousand genes.
///
/// Equals rank by index; failed evaluations rank last. A generation of which all evaluations failed leaves the distribution
/// as it is, and the next one draws from it again. This is why values are recorded and not the order alone, in which such a
/// generation looks like any other.
///
/// Individual `i` of generation `g` draws from the stream (seed, [`Domain::Mutation`](farsa_num::Domain::Mutation), trial 0,
/// `i`, `g`), in generation 0 from [`Domain::InitialGenome`](farsa_num::Domain::InitialGenome).
///
/// Source: \[Hansen2016\] appendix A. Deviations: larger fitness is better. Variances along axes are at least 10^-16 of the
/// largest, the step size stays within 10^-100 and 10^100, and where the largest variance leaves 10^-30 to 10^30 the step size
/// takes its place.
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
pub struct CmaEs {
    config: CmaEsConfig,
    seed: u64,
    generation: u32,
    distribution: Distribution<FullCovariance>,
    population: Population<f64>,
}

impl CmaEs {
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

    /// The ratio of the longest to the shortest axis of the distribution.
    pub fn axis_ratio(&self) -> f64 {
        self.distribution.axis_ratio()
    }
}

/// How many generations are told again in some seconds: a generation takes time in proportion to the cube of its genes, 0.1 s
/// for 792.
pub(super) fn between_states(genes: usize) -> u32 {
    let cube = (genes as u64).saturating_pow(3).max(1);
    u32::try_from(20_000_000_000 / cube).unwrap_or(u32::MAX).max(1)
}

search!(CmaEs, FullCovariance, between_states);
