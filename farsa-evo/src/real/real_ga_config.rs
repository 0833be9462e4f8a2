//! What a generational genetic algorithm over reals needs to know.

use alloc::vec::Vec;

use crate::error::EvoError;
use crate::real::bounds::{check_bounds, check_setting};
use crate::real::crossover::Crossover;
use crate::real::mutation::RealMutation;
use crate::real::selection::{Selection, Selector};

/// What a [`RealGa`](crate::real::RealGa) needs to know; a plain value that is checked where it is used.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RealGaConfig {
    /// The range of each gene, low to high \[genes\], -1e100 to 1e100; equal ends freeze a gene.
    pub bounds: Vec<[f64; 2]>,
    /// Number of individuals of a generation.
    pub population: usize,
    /// Number of the best that go on unchanged, as individuals 0 and on; 0 to population - 1.
    pub elites: usize,
    /// How parents are chosen.
    pub selection: Selection,
    /// How the genes of two parents are mixed.
    pub crossover: Crossover,
    /// The probability, 0 to 1, that a child has two parents; of no effect for [`Crossover::None`].
    pub crossover_rate: f64,
    /// How genes change from parent to child.
    pub mutation: RealMutation,
    /// What the mutation rate of each gene is multiplied by \[genes\], 0 to 1e6; empty for 1 everywhere.
    pub rate_factors: Vec<f64>,
}

impl RealGaConfig {
    /// 100 individuals with one elite, tournaments of two, simulated binary crossover of index 2 with probability 0.9,
    /// and Gaussian mutation of one gene in a genome by a tenth of its range. The choice is ours.
    pub fn new(bounds: Vec<[f64; 2]>) -> Self {
        let mutation = RealMutation::Gaussian { rate: 1.0 / bounds.len().max(1) as f64, sigma: 0.1 };
        Self {
            bounds,
            population: 100,
            elites: 1,
            selection: Selection::Tournament { size: 2 },
            crossover: Crossover::SimulatedBinary { eta: 2.0 },
            crossover_rate: 0.9,
            mutation,
            rate_factors: Vec::new(),
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::NoIndividuals`], [`EvoError::NoGenes`], [`EvoError::TooLarge`], [`EvoError::Setting`].
    pub fn validate(&self) -> Result<(), EvoError> {
        self.selector().map(|_| ())
    }

    /// The selection, of a configuration of which every number is right.
    pub(crate) fn selector(&self) -> Result<Selector, EvoError> {
        check_bounds(self.population, &self.bounds)?;
        let (elites, factors) = (self.elites, self.rate_factors.len());
        check_setting(elites < self.population, "the number of elites", elites as f64, "0 to population - 1")?;
        self.crossover.check()?;
        let rate = self.crossover_rate;
        check_setting((0.0..=1.0).contains(&rate), "the crossover rate", rate, "0 to 1")?;
        self.mutation.check()?;
        let fits = factors == 0 || factors == self.bounds.len();
        check_setting(fits, "the number of rate factors", factors as f64, "none or one for each gene")?;
        for &factor in &self.rate_factors {
            check_setting((0.0..=1e6).contains(&factor), "a rate factor", factor, "0 to 1e6")?;
        }
        Selector::new(self.selection, self.population)
    }
}
