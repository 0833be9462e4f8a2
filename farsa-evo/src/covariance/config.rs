//! Configurations of covariance matrix adaptation.

use alloc::vec::Vec;

use crate::covariance::coefficients::Coefficients;
use crate::error::{EvoError, check_range, check_share};
use crate::population::Population;

/// The limits of a step size.
pub(crate) const STEP_SIZES: [f64; 2] = [1e-100, 1e100];

/// A configuration from which a search of one normal distribution starts.
pub trait Start: Clone + core::fmt::Debug + PartialEq {
    /// The initial mean and step size, and the number of individuals.
    fn start(&self) -> (&[f64], f64, usize);

    /// Weights and learning rates.
    fn coefficients(&self) -> Coefficients;

    /// Checks every number.
    ///
    /// # Errors
    /// An error that names the first wrong number.
    fn check(&self) -> Result<(), EvoError>;
}

/// The configuration of [`CmaEs`](crate::covariance::CmaEs).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CmaEsConfig {
    /// The initial mean m, a number for each gene, of magnitude up to 10^100.
    pub mean: Vec<f64>,
    /// The initial step size sigma, 10^-100 to 10^100, in the unit of the genes. About a third of the distance to the
    /// optimum in each gene is a good choice.
    pub sigma: f64,
    /// Number of individuals lambda, at least 2. \[Hansen2016\] eq. 48.
    pub population: usize,
    /// Negative weights for the worse half. \[Hansen2016\] eq. 53.
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
        let population = Population::default_size(mean.len());
        Self { mean, sigma, population, active: true, rank_one_rate: None, rank_mu_rate: None, damping: None }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::Config`] for no genes, no individuals, or more genes of a population or elements of the covariance matrix
    /// than [`Population::MAX_GENES`]. [`EvoError::OutOfRange`] for other numbers.
    pub fn validate(&self) -> Result<(), EvoError> {
        let genes = self.mean.len();
        check_start(&self.mean, self.sigma, self.population)?;
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
            (one, self.rank_mu_rate.unwrap_or(mu).min(1.0 - one))
        };
        Coefficients::new(self.mean.len(), population, self.active, self.damping, rates)
    }
}

fn same(rank_one: f64, rank_mu: f64) -> (f64, f64) {
    (rank_one, rank_mu)
}

/// Checks the start of a search of a normal distribution.
pub(super) fn check_start(mean: &[f64], sigma: f64, population: usize) -> Result<(), EvoError> {
    Population::check(population, mean.len())?;
    check_range("population", population as f64, [2.0, f64::INFINITY], "at least 2")?;
    check_range("sigma", sigma, STEP_SIZES, "1e-100 to 1e100")?;
    mean.iter().try_for_each(|&x| check_range("mean", x, [-1e100, 1e100], "-1e100 to 1e100"))
}

/// The configuration of [`SeparableCmaEs`](crate::covariance::SeparableCmaEs).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SeparableCmaEsConfig {
    /// The initial mean m, a number for each gene, of magnitude up to 10^100.
    pub mean: Vec<f64>,
    /// The initial step size sigma, 10^-100 to 10^100, in the unit of the genes. About a third of the distance to the
    /// optimum in each gene is a good choice.
    pub sigma: f64,
    /// Number of individuals lambda, at least 2.
    pub population: usize,
}

impl SeparableCmaEsConfig {
    /// The defaults of \[Ros2008\] for n genes: 4 + 3 ln n individuals, rounded down.
    pub fn new(mean: Vec<f64>, sigma: f64) -> Self {
        let population = Population::default_size(mean.len());
        Self { mean, sigma, population }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::Config`] or [`EvoError::OutOfRange`].
    pub fn validate(&self) -> Result<(), EvoError> {
        check_start(&self.mean, self.sigma, self.population)
    }
}

impl Start for CmaEsConfig {
    fn start(&self) -> (&[f64], f64, usize) {
        (&self.mean, self.sigma, self.population)
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

    fn coefficients(&self) -> Coefficients {
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
