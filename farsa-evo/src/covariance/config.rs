//! Configurations of covariance matrix adaptation.

use alloc::vec::Vec;

use crate::covariance::coefficients::Coefficients;
use crate::error::{EvoError, check_range, check_share};
use crate::population::Population;

/// The limits of a step size.
pub(crate) const STEP_SIZES: [f64; 2] = [1e-100, 1e100];

/// A configuration that a search with one normal distribution can start from.
pub trait Start: Clone + core::fmt::Debug + PartialEq {
    /// Gets the initial mean, the initial step size and the number of individuals.
    fn start(&self) -> (&[f64], f64, usize);

    /// Gets the upper limit of the standard deviation of every gene.
    fn largest_step(&self) -> f64;

    /// Computes weights and learning rates.
    fn coefficients(&self) -> Coefficients;

    /// Checks whether a search can be created with these settings.
    ///
    /// # Errors
    /// Returns an error that names the first wrong number.
    fn check(&self) -> Result<(), EvoError>;
}

/// Configuration of [`CmaEs`](crate::covariance::CmaEs).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CmaEsConfig {
    /// Initial mean m with a number for each gene. Each can have a magnitude of up to 10^100.
    pub mean: Vec<f64>,
    /// Initial step size sigma, 10^-100 to 10^100, in the unit of the genes. If you don't have a better guess, use
    /// about a third of the distance to the optimum in each gene.
    pub sigma: f64,
    /// Number of individuals lambda in each generation, at least 2. The default is that of \[Hansen2016\] eq. 48.
    pub population: usize,
    /// Set this to true to use negative weights for the worse half of the individuals, \[Hansen2016\] eq. 53.
    pub active: bool,
    /// Rate of the rank-one update `c_1`, 0 to 1. If this is `None`, the rate of \[Hansen2016\] eq. 57 is used.
    pub rank_one_rate: Option<f64>,
    /// Rate of the rank-mu update `c_mu`, 0 to 1 - `c_1`. If this is `None`, the rate of \[Hansen2016\] eq. 58 is used.
    pub rank_mu_rate: Option<f64>,
    /// Damping of the step size `d_sigma`, 0.001 to 1000. If this is `None`, the damping of \[Hansen2016\] eq. 55 is
    /// used.
    pub damping: Option<f64>,
    /// Upper limit of the standard deviation of every gene, sigma to 10^100, in the unit of the genes. If genes have a
    /// range, use its width. The default is 10^100.
    pub largest_step: f64,
}

impl CmaEsConfig {
    /// Creates a configuration with the defaults of \[Hansen2016\] table 1. For n genes it has 4 + 3 ln n individuals,
    /// rounded down, and it uses negative weights.
    pub fn new(mean: Vec<f64>, sigma: f64) -> Self {
        let population = Population::default_size(mean.len());
        let largest_step = STEP_SIZES[1];
        Self {
            mean,
            sigma,
            population,
            active: true,
            rank_one_rate: None,
            rank_mu_rate: None,
            damping: None,
            largest_step,
        }
    }

    /// Checks that all settings are within their allowed ranges.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] for no genes, no individuals, or more genes of a population or elements of the
    /// covariance matrix than [`Population::MAX_GENES`]. [`EvoError::OutOfRange`] for other numbers.
    pub fn validate(&self) -> Result<(), EvoError> {
        let genes = self.mean.len();
        check_start(self)?;
        Population::check(genes, genes)?;
        check_share("rank_one_rate", self.rank_one_rate.unwrap_or(0.0))?;
        let rank_one =
            self.rank_one_rate.unwrap_or(Coefficients::new(genes, self.population, false, None, same).rank_one);
        check_range("rank_mu_rate", self.rank_mu_rate.unwrap_or(0.0), [0.0, 1.0 - rank_one], "0 to 1 - rank_one_rate")?;
        check_range("damping", self.damping.unwrap_or(1.0), [0.001, 1000.0], "0.001 to 1000")
    }

    /// The coefficients of another number of individuals.
    pub(super) fn coefficients_of(&self, population: usize) -> Coefficients {
        let rates = |one: f64, mu: f64| {
            let one = self.rank_one_rate.unwrap_or(one);
            // With c_1 + c_mu up to 1 the factor of the old C is never negative.
            (one, self.rank_mu_rate.unwrap_or(mu).min(1.0 - one))
        };
        Coefficients::new(self.mean.len(), population, self.active, self.damping, rates)
    }
}

fn same(rank_one: f64, rank_mu: f64) -> (f64, f64) {
    (rank_one, rank_mu)
}

/// Checks the start of a search of a normal distribution.
fn check_start(start: &impl Start) -> Result<(), EvoError> {
    let (mean, sigma, population) = start.start();
    Population::check(population, mean.len())?;
    check_range("population", population as f64, [2.0, f64::INFINITY], "at least 2")?;
    check_range("sigma", sigma, STEP_SIZES, "1e-100 to 1e100")?;
    check_range("largest_step", start.largest_step(), [sigma, STEP_SIZES[1]], "sigma to 1e100")?;
    mean.iter().try_for_each(|&x| check_range("mean", x, [-1e100, 1e100], "-1e100 to 1e100"))
}

/// Configuration of [`SeparableCmaEs`](crate::covariance::SeparableCmaEs).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SeparableCmaEsConfig {
    /// Initial mean m with a number for each gene. Each can have a magnitude of up to 10^100.
    pub mean: Vec<f64>,
    /// Initial step size sigma, 10^-100 to 10^100, in the unit of the genes. If you don't have a better guess, use
    /// about a third of the distance to the optimum in each gene.
    pub sigma: f64,
    /// Number of individuals lambda in each generation, at least 2.
    pub population: usize,
    /// Upper limit of the standard deviation of every gene, sigma to 10^100, in the unit of the genes. If genes have a
    /// range, use its width. The default is 10^100.
    pub largest_step: f64,
}

impl SeparableCmaEsConfig {
    /// Creates a configuration with the defaults of \[Ros2008\]. For n genes it has 4 + 3 ln n individuals, rounded
    /// down.
    pub fn new(mean: Vec<f64>, sigma: f64) -> Self {
        let population = Population::default_size(mean.len());
        Self { mean, sigma, population, largest_step: STEP_SIZES[1] }
    }

    /// Checks the configuration. You usually don't need to call this yourself, since a new search does it as well.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] or [`EvoError::OutOfRange`] for the first setting that is invalid.
    pub fn validate(&self) -> Result<(), EvoError> {
        check_start(self)
    }
}

impl Start for CmaEsConfig {
    fn start(&self) -> (&[f64], f64, usize) {
        (&self.mean, self.sigma, self.population)
    }

    fn largest_step(&self) -> f64 {
        self.largest_step
    }

    fn coefficients(&self) -> Coefficients {
        self.coefficients_of(self.population)
    }

    fn check(&self) -> Result<(), EvoError> {
        self.validate()
    }
}

impl Start for SeparableCmaEsConfig {
    fn start(&self) -> (&[f64], f64, usize) {
        (&self.mean, self.sigma, self.population)
    }

    fn largest_step(&self) -> f64 {
        self.largest_step
    }

    fn coefficients(&self) -> Coefficients {
        // A diagonal has n numbers to learn instead of n (n + 1) / 2, so its rates may be higher. [Ros2008].
        let faster = (self.mean.len() as f64 + 2.0) / 3.0;
        let rates = |one: f64, mu: f64| {
            let one = (one * faster).min(1.0);
            (one, (mu * faster).min(1.0 - one))
        };
        Coefficients::new(self.mean.len(), self.population, false, None, rates)
    }

    fn check(&self) -> Result<(), EvoError> {
        self.validate()
    }
}
