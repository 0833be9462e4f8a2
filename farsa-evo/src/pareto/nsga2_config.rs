//! What NSGA-II needs to know.

use alloc::vec::Vec;

use crate::error::EvoError;
use crate::population::Population;
use crate::real::bounds::{check_bounds, check_rate, check_setting};
use crate::real::crossover::Crossover;
use crate::real::polynomial_mutation::PolynomialMutation;

/// What an [`Nsga2`](crate::pareto::Nsga2) needs to know; a plain value that is checked where it is used.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Nsga2Config {
    /// The range of each gene, low to high \[genes\], -1e100 to 1e100; equal ends freeze a gene.
    pub bounds: Vec<[f64; 2]>,
    /// Number of objectives m, at least 1.
    pub objectives: usize,
    /// Number of individuals N of a generation, which is also that of the parents.
    pub population: usize,
    /// The probability, 0 to 1, that a child has two parents, `p_c`.
    pub crossover_rate: f64,
    /// The distribution index of crossover `eta_c`, 0 to 1000: the larger, the nearer to the parents.
    pub crossover_eta: f64,
    /// The probability, 0 to 1, that a gene is mutated, `p_m`.
    pub mutation_rate: f64,
    /// The distribution index of mutation `eta_m`, 0 to 1000: the larger, the smaller the steps.
    pub mutation_eta: f64,
}

impl Nsga2Config {
    /// The settings of \[Deb2002\] section IV: 100 individuals, `p_c` 0.9, `p_m` one gene of a genome, both indices 20.
    pub fn new(bounds: Vec<[f64; 2]>, objectives: usize) -> Self {
        let mutation_rate = 1.0 / bounds.len().max(1) as f64;
        let (crossover_rate, crossover_eta, mutation_eta) = (0.9, 20.0, 20.0);
        Self { bounds, objectives, population: 100, crossover_rate, crossover_eta, mutation_rate, mutation_eta }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::NoIndividuals`], [`EvoError::NoGenes`], [`EvoError::TooLarge`] for genomes or objectives; [`EvoError::Setting`].
    pub fn validate(&self) -> Result<(), EvoError> {
        check_bounds(self.population, &self.bounds)?;
        check_setting(self.objectives > 0, "the number of objectives", self.objectives as f64, "1 or more")?;
        Population::check(self.population.saturating_mul(2), self.objectives)?;
        check_rate("the crossover rate", self.crossover_rate)?;
        self.crossover().check()?;
        self.mutation().check()
    }

    pub(super) fn crossover(&self) -> Crossover {
        Crossover::SimulatedBinary { eta: self.crossover_eta }
    }

    pub(super) fn mutation(&self) -> PolynomialMutation {
        PolynomialMutation { rate: self.mutation_rate, eta: self.mutation_eta }
    }
}
