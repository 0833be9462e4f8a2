//! The configuration of an evolution strategy.

use alloc::vec::Vec;

use farsa_num::Scalar;

use crate::error::{EvoError, check_setting};
use crate::population::Population;

/// The largest size of a gene or a step size of a configuration. Genes grow no further than by steps of this size.
pub(crate) const LARGEST: f64 = 1e100;

/// Which individuals are selected from, \[Beyer2002\].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Survival {
    /// (mu, lambda): the offspring alone.
    Comma,
    /// (mu + lambda), parents and offspring. Parents keep their fitness.
    Plus,
    /// (mu + lambda) where the parents are evaluated again in every generation.
    PlusEvaluatedAgain,
}

/// The recombination of the genes, or the step sizes, of rho parents, \[Beyer2002\].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Recombination {
    /// No recombination. The values are those of the first drawn parent.
    None,
    /// The mean of all rho parents.
    Intermediate,
    /// Each from one of the rho parents, drawn for it.
    Discrete,
}

/// The number of step sizes of an individual and their learning rates, \[Beyer2002\].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum StepSizes {
    /// One for all genes: `sigma e^(tau N)`.
    One {
        /// The learning rate tau, 0 to 10.
        tau: f64,
    },
    /// One for each gene: `sigma_i e^(tau_0 N) e^(tau N_i)`.
    PerGene {
        /// The learning rate `tau_0` of what all have in common, 0 to 10.
        tau_0: f64,
        /// The learning rate tau of each, 0 to 10.
        tau: f64,
    },
}

impl StepSizes {
    /// One step size, with tau = 1 / sqrt(n) of n genes.
    pub fn one(genes: usize) -> Self {
        Self::One { tau: 1.0 / Scalar::sqrt(genes.max(1) as f64) }
    }

    /// A step size for each gene, with `tau_0` = 1 / sqrt(2 n) and tau = 1 / sqrt(2 sqrt(n)) of n genes.
    pub fn per_gene(genes: usize) -> Self {
        let n = genes.max(1) as f64;
        Self::PerGene { tau_0: 1.0 / Scalar::sqrt(2.0 * n), tau: 1.0 / Scalar::sqrt(2.0 * Scalar::sqrt(n)) }
    }

    /// Step sizes of an individual with the given number of genes.
    pub(crate) fn count(self, genes: usize) -> usize {
        match self {
            Self::One { .. } => 1,
            Self::PerGene { .. } => genes,
        }
    }
}

/// The configuration of [`EvolutionStrategy`](crate::real::EvolutionStrategy).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EvolutionStrategyConfig {
    /// Where the search begins \[genes\], -1e100 to 1e100.
    pub mean: Vec<f64>,
    /// The first step size sigma, in the unit of the genes, `smallest_step` to 1e100.
    pub initial_step: f64,
    /// The number of parents mu, 1 to the number of offspring.
    pub parents: usize,
    /// The number of offspring lambda of a generation.
    pub offspring: usize,
    /// The mixing number rho, the number of different parents of a child, 1 to mu. No effect without recombination.
    pub mixing: usize,
    /// Which individuals are selected from.
    pub survival: Survival,
    /// Recombination of genes.
    pub recombination: Recombination,
    /// Recombination of step sizes.
    pub step_recombination: Recombination,
    /// Number and learning rates of step sizes.
    pub step_sizes: StepSizes,
    /// The step size that is never undercut, in the unit of the genes, 1e-100 to 1e100.
    pub smallest_step: f64,
}

impl EvolutionStrategyConfig {
    /// A (15/15, 100) strategy that begins around `mean` \[genes\] with this step size. It has intermediate recombination
    /// of genes and step sizes, and one step size for each gene. Its learning rates are those of \[Beyer2002\]. (15, 100)
    /// is the classical choice of its authors, the smallest step of 1e-12 is ours.
    pub fn new(mean: Vec<f64>, initial_step: f64) -> Self {
        let step_sizes = StepSizes::per_gene(mean.len());
        Self {
            mean,
            initial_step,
            parents: 15,
            offspring: 100,
            mixing: 15,
            survival: Survival::Comma,
            recombination: Recombination::Intermediate,
            step_recombination: Recombination::Intermediate,
            step_sizes,
            smallest_step: 1e-12,
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::Config`] or [`EvoError::OutOfRange`].
    pub fn validate(&self) -> Result<(), EvoError> {
        let Self { parents, offspring, mixing, initial_step, smallest_step, .. } = *self;
        Population::check(offspring, self.mean.len())?;
        if parents == 0 {
            return Err(EvoError::no_parents());
        }
        check_setting(parents <= offspring, "the number of parents", parents as f64, "1 to the number of offspring")?;
        Population::check(self.asked(), self.mean.len())?;
        let mixed = (1..=parents).contains(&mixing);
        check_setting(mixed, "the mixing number", mixing as f64, "1 to the number of parents")?;
        for &x in &self.mean {
            check_setting((-LARGEST..=LARGEST).contains(&x), "a mean", x, "-1e100 to 1e100")?;
        }
        let steps = 1e-100..=LARGEST;
        check_setting(steps.contains(&smallest_step), "the smallest step size", smallest_step, "1e-100 to 1e100")?;
        let within = (smallest_step..=LARGEST).contains(&initial_step);
        check_setting(within, "the first step size", initial_step, "the smallest to 1e100")?;
        let rate = |name, tau| check_setting((0.0..=10.0).contains(&tau), name, tau, "0 to 10");
        match self.step_sizes {
            StepSizes::One { tau } => rate("tau", tau),
            StepSizes::PerGene { tau_0, tau } => rate("tau_0", tau_0).and_then(|()| rate("tau", tau)),
        }
    }

    /// Individuals of a generation that are evaluated.
    pub(crate) fn asked(&self) -> usize {
        match self.survival {
            Survival::Comma | Survival::Plus => self.offspring,
            Survival::PlusEvaluatedAgain => self.parents.saturating_add(self.offspring),
        }
    }

    /// Number of evaluated individuals that are parents, from generation 1 on.
    pub(crate) fn asked_parents(&self) -> usize {
        self.asked() - self.offspring
    }

    /// Parents of a child.
    pub(crate) fn parents_of_one(&self) -> usize {
        let alone = [self.recombination, self.step_recombination] == [Recombination::None; 2];
        if alone { 1 } else { self.mixing }
    }
}
