//! What a cooperative search over weights needs to know.

use alloc::vec;
use alloc::vec::Vec;

use crate::error::EvoError;
use crate::population::Population;
use crate::real::bounds::{check_rate, check_setting};

/// Which weights change places within their subpopulation before the next generation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Permutation {
    /// All but those of new offspring, as in the experiments of \[Gomez2008\].
    All,
    /// Of those, a weight of a network of fitness f with the probability 1 - ((f - min) / (max - min))^(1/n) for n genes,
    /// \[Gomez2008\] eq. 1, which keeps good networks together. Deviations: failed evaluations are not the minimum, and their
    /// weights are always permuted, as are all weights where the fitness of all is the same.
    ByFitness,
}

/// What a [`Cosyne`] needs to know; a plain value that is checked where it is used.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CosyneConfig {
    /// Number of genes of each segment, at least 1; together all genes. A segment is what belongs together, such as the
    /// weights of one neuron: crossover cuts each of them once.
    pub segments: Vec<usize>,
    /// Number of individuals m, at least 2: weights of each subpopulation.
    pub population: usize,
    /// Number of the best that are parents, 1 to `population`; a quarter in the source.
    pub parents: usize,
    /// Number of offspring l, which replace the worst: 0 to `population`.
    pub offspring: usize,
    /// Weights begin uniform between minus and plus this, 0 to 1e100.
    pub range: f64,
    /// The probability, 0 to 1, that a weight of an offspring is mutated.
    pub mutation_rate: f64,
    /// The scale of the Cauchy distribution that mutation adds, in the unit of the genes: half of all mutations are smaller. 0
    /// to 1e100.
    pub mutation_scale: f64,
    /// Which weights change places.
    pub permutation: Permutation,
}

impl CosyneConfig {
    /// The values of \[Gomez2008\] section 5.3 for two poles, with one segment of so many genes: 30 individuals, of which the
    /// best 7 are parents, weights from -10 to 10, and 30 % of those of offspring mutated with a scale of 0.3.
    ///
    /// The source does not say how many offspring there are. Half of the population are replaced here, as in ESP of the same
    /// authors.
    pub fn new(genes: usize) -> Self {
        Self {
            segments: vec![genes],
            population: 30,
            parents: 7,
            offspring: 15,
            range: 10.0,
            mutation_rate: 0.3,
            mutation_scale: 0.3,
            permutation: Permutation::All,
        }
    }

    /// Number of genes, those of all segments together.
    pub fn genes(&self) -> usize {
        self.segments.iter().fold(0, |sum: usize, segment| sum.saturating_add(*segment))
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::NoIndividuals`], [`EvoError::NoGenes`], [`EvoError::TooLarge`], [`EvoError::Setting`].
    pub fn validate(&self) -> Result<(), EvoError> {
        let Self { population, parents, offspring, range, mutation_rate, mutation_scale, .. } = *self;
        Population::check(population, self.genes())?;
        check_setting(population >= 2, "the population", population as f64, "at least 2")?;
        for &segment in &self.segments {
            check_setting(segment > 0, "the genes of a segment", segment as f64, "at least 1")?;
        }
        let within = (1..=population).contains(&parents);
        check_setting(within, "the number of parents", parents as f64, "1 to the population")?;
        let within = offspring <= population;
        check_setting(within, "the number of offspring", offspring as f64, "0 to the population")?;
        check_setting((0.0..=1e100).contains(&range), "the range of the first weights", range, "0 to 1e100")?;
        check_rate("the mutation rate", mutation_rate)?;
        check_setting((0.0..=1e100).contains(&mutation_scale), "the scale of mutation", mutation_scale, "0 to 1e100")
    }
}
