//! Settings for co-evolution with generalist selection.

use crate::error::{EvoError, check_setting};
use crate::population::Population;
use crate::words::mutation::{BitMutation, Mutation, check_gene_bits};

/// Configuration of [`GeneralistCoevolution`](crate::coevolution::GeneralistCoevolution).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GeneralistConfig {
    /// Number of genes in each genome.
    pub genes: usize,
    /// Number of bits in a gene, 1 to 16. Genes range from 0 to 2^bits - 1.
    pub gene_bits: u32,
    /// Number of members of each population. This must be a multiple of the number of newcomers.
    pub members: usize,
    /// Number of newcomers, at least 1. These are copies of members that are trained in each round and may replace
    /// members.
    pub newcomers: usize,
    /// Number of opponents m that each individual has in a generation, from 1 to `members`.
    pub opponents: usize,
    /// Number of generations of training in each round, at least 1.
    pub iterations: u32,
    /// Probability, 0 to 1, that mutation hits a bit.
    pub mutation_rate: f64,
    /// Determines what happens to a bit that is hit by mutation.
    pub mutation: Mutation,
}

impl GeneralistConfig {
    /// Creates a configuration with the sizes of the program of \[Simione2020\], for genomes with this many genes of 16
    /// bits. Each population has 80 members and 10 newcomers, which are trained for 20 generations against 10
    /// opponents. Mutation is that of [`GaConfig::new`](crate::words::GaConfig::new).
    pub const fn new(genes: usize) -> Self {
        let (members, newcomers, opponents, iterations) = (80, 10, 10, 20);
        let (gene_bits, mutation_rate, mutation) = (u16::BITS, 0.015, Mutation::Resample);
        Self { genes, gene_bits, members, newcomers, opponents, iterations, mutation_rate, mutation }
    }

    /// Checks the configuration. You usually don't need to call this yourself, since a new search does it as well.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] or [`EvoError::OutOfRange`] for the first setting that is invalid.
    pub fn validate(&self) -> Result<(), EvoError> {
        let Self { genes, members, newcomers, opponents, iterations, .. } = *self;
        Population::check(members, genes)?;
        let even = newcomers > 0 && members.is_multiple_of(newcomers);
        check_setting(even, "the number of newcomers", newcomers as f64, "a divisor of the members")?;
        let size = members.saturating_add(newcomers);
        Population::check(size.saturating_mul(2), genes)?;
        // All pairs of the two populations.
        Population::check(size.saturating_mul(2), size)?;
        let some = (1..=members).contains(&opponents);
        check_setting(some, "the number of opponents", opponents as f64, "1 to all members")?;
        check_setting(iterations > 0, "the generations of training", f64::from(iterations), "1 or more")?;
        check_gene_bits(self.gene_bits)?;
        self.bit_mutation().map(|_| ())
    }

    /// Number of individuals that each population has in a generation. This includes members and newcomers.
    pub const fn size(&self) -> usize {
        self.members.saturating_add(self.newcomers)
    }

    /// Number of generations that the encounters of a round take. This requires a valid configuration.
    pub const fn encounters(&self) -> u32 {
        self.size().div_ceil(self.opponents) as u32
    }

    /// Number of generations in a round, which consists of encounters and training. This requires a valid
    /// configuration.
    pub const fn round(&self) -> u32 {
        self.encounters().saturating_add(self.iterations)
    }

    /// Individuals evaluated for each newcomer in a generation of training, for a valid configuration.
    pub(crate) const fn candidates(&self) -> usize {
        self.size() / self.newcomers
    }

    pub(crate) fn bit_mutation(&self) -> Result<BitMutation, EvoError> {
        BitMutation::new(self.mutation, self.mutation_rate)?.with_gene_bits(self.gene_bits)
    }
}
