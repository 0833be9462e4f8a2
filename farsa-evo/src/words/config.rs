//! The configurations of the strategies: plain values that are checked where they are used.

use crate::error::EvoError;
use crate::population::Population;
#[cfg(feature = "serde")]
use crate::saved::SavedMutation;
use crate::words::mutation::{BitMutation, Mutation, check_gene_bits};

/// Number of individuals of a search of one parent and one mutant.
pub(crate) const PARENT_AND_MUTANT: usize = 2;

/// What a [`TruncationGa`](crate::words::TruncationGa) needs to know; a plain value that is checked where it is used.
///
/// Under the feature `serde` the number of bits of a gene is saved only where it is not 16, within the word for the
/// mutation: what was saved before there was a choice is still read, and written as before.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "SavedConfig", into = "SavedConfig"))]
pub struct GaConfig {
    /// Number of genes of a genome.
    pub genes: usize,
    /// Bits of a gene, 1 to 16: genes are 0 to 2^bits - 1.
    pub gene_bits: u32,
    /// Number of individuals of a generation.
    pub population: usize,
    /// Number of individuals that are selected; each makes population / parents copies.
    pub parents: usize,
    /// Probability, 0 to 1, that mutation hits a bit.
    pub mutation_rate: f64,
    /// What happens to a bit that is hit.
    pub mutation: Mutation,
}

impl GaConfig {
    /// The evolution of \[Ferrauto2010\] for genomes of this many genes of 16 bits: the best 20 of 100 make five copies each, one
    /// unchanged and four mutated with 1.5 % a bit, [`Mutation::Resample`].
    pub const fn new(genes: usize) -> Self {
        let (gene_bits, mutation) = (u16::BITS, Mutation::Resample);
        Self { genes, gene_bits, population: 100, parents: 20, mutation_rate: 0.015, mutation }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::NoIndividuals`], [`EvoError::NoGenes`], [`EvoError::TooLarge`], [`EvoError::NoParents`],
    /// [`EvoError::TooManyParents`], [`EvoError::UnevenCopies`], [`EvoError::Rate`] or [`EvoError::GeneBits`].
    pub fn validate(&self) -> Result<(), EvoError> {
        let Self { genes, population, parents, .. } = *self;
        Population::check(population, genes)?;
        if parents == 0 {
            return Err(EvoError::NoParents);
        }
        if parents > population {
            return Err(EvoError::TooManyParents { population, parents });
        }
        if !population.is_multiple_of(parents) {
            return Err(EvoError::UnevenCopies { population, parents });
        }
        check_gene_bits(self.gene_bits)?;
        self.bit_mutation().map(|_| ())
    }

    /// Copies that each parent makes; of a valid configuration only.
    pub(crate) fn copies(&self) -> usize {
        self.population / self.parents
    }

    pub(crate) fn bit_mutation(&self) -> Result<BitMutation, EvoError> {
        BitMutation::new(self.mutation, self.mutation_rate)?.with_gene_bits(self.gene_bits)
    }
}

/// What a [`OnePlusOne`](crate::words::OnePlusOne) needs to know; a plain value that is checked where it is used.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OnePlusOneConfig {
    /// Number of genes of a genome.
    pub genes: usize,
    /// Bits of a gene, 1 to 16: genes are 0 to 2^bits - 1.
    pub gene_bits: u32,
    /// Probability, 0 to 1, that mutation hits a bit of the mutant of generation 0.
    pub first_rate: f64,
    /// What the probability falls by from generation to generation, 0 to 1.
    pub rate_step: f64,
    /// The probability below which it does not fall, 0 to the first.
    pub last_rate: f64,
    /// What happens to a bit that is hit.
    pub mutation: Mutation,
}

impl OnePlusOneConfig {
    /// The search of the discrimination experiment of \[FARSA2\] for genomes of this many genes of 8 bits: half of all
    /// bits flip at first, 1 % fewer every generation, down to 2 %.
    pub const fn new(genes: usize) -> Self {
        Self { genes, gene_bits: 8, first_rate: 0.5, rate_step: 0.01, last_rate: 0.02, mutation: Mutation::Flip }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::NoGenes`], [`EvoError::TooLarge`], [`EvoError::GeneBits`], [`EvoError::Rate`] or
    /// [`EvoError::RisingRate`].
    pub fn validate(&self) -> Result<(), EvoError> {
        let Self { genes, gene_bits, first_rate, rate_step, last_rate, .. } = *self;
        Population::check(PARENT_AND_MUTANT, genes)?;
        check_gene_bits(gene_bits)?;
        for rate in [first_rate, rate_step, last_rate] {
            BitMutation::new(self.mutation, rate)?;
        }
        if last_rate > first_rate {
            return Err(EvoError::RisingRate { first: first_rate, last: last_rate });
        }
        Ok(())
    }

    /// The probability, 0 to 1, that mutation hits a bit of the mutant of a generation.
    pub fn rate(&self, generation: u32) -> f64 {
        (self.first_rate - self.rate_step * f64::from(generation)).max(self.last_rate)
    }

    pub(crate) fn bit_mutation(&self, generation: u32) -> Result<BitMutation, EvoError> {
        BitMutation::new(self.mutation, self.rate(generation))?.with_gene_bits(self.gene_bits)
    }
}

/// A [`GaConfig`] as it is saved.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "GaConfig")]
struct SavedConfig {
    genes: usize,
    population: usize,
    parents: usize,
    mutation_rate: f64,
    mutation: SavedMutation,
}

#[cfg(feature = "serde")]
impl From<SavedConfig> for GaConfig {
    fn from(saved: SavedConfig) -> Self {
        let SavedConfig { genes, population, parents, mutation_rate, mutation } = saved;
        let (mutation, gene_bits) = mutation.into();
        Self { genes, gene_bits, population, parents, mutation_rate, mutation }
    }
}

#[cfg(feature = "serde")]
impl From<GaConfig> for SavedConfig {
    fn from(config: GaConfig) -> Self {
        let GaConfig { genes, gene_bits, population, parents, mutation_rate, mutation } = config;
        Self { genes, population, parents, mutation_rate, mutation: (mutation, gene_bits).into() }
    }
}
