//! Genomes of one generation.

use alloc::vec;
use alloc::vec::Vec;
use core::slice::{ChunksExact, ChunksExactMut};

use farsa_num::{Digest, ln};

use crate::error::{EvoError, MAX_GENES};
use crate::gene::Gene;

/// Genomes of one generation, stored one after the other in a single piece of memory [individuals x genes].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Population<G = u16> {
    genome_len: usize,
    genes: Vec<G>,
}

impl Population {
    /// Largest number of genes that a population can have. This is 2^28, which takes 512 MiB for integer genes and 2
    /// GiB for reals. Because of this limit, a damaged configuration results in an error before any memory is
    /// allocated.
    pub const MAX_GENES: usize = MAX_GENES;

    /// The default number of individuals for `genes` real genes, 4 + 3 ln n rounded down.
    ///
    /// Source: \[Hansen2016\] eq. 48, \[Wierstra2014\] table 1.
    pub(crate) fn default_size(genes: usize) -> usize {
        4 + (3.0 * ln(genes.max(1) as f64)) as usize
    }

    /// Checks that [`Population::new`] accepts these sizes.
    pub(crate) fn check(individuals: usize, genome_len: usize) -> Result<(), EvoError> {
        if individuals == 0 {
            return Err(EvoError::no_individuals());
        }
        if genome_len == 0 {
            return Err(EvoError::no_genes());
        }
        match individuals.checked_mul(genome_len) {
            Some(total) if total <= MAX_GENES => Ok(()),
            _ => Err(EvoError::too_large(individuals, genome_len)),
        }
    }
}

impl<G: Gene> Population<G> {
    /// Creates a population with the given number of `individuals` and `genome_len` genes each. All genes are zero.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`].
    pub fn new(individuals: usize, genome_len: usize) -> Result<Self, EvoError> {
        Population::check(individuals, genome_len)?;
        Ok(Self { genome_len, genes: vec![G::default(); individuals * genome_len] })
    }

    /// Number of individuals in the population.
    pub fn len(&self) -> usize {
        self.genes.len() / self.genome_len
    }

    /// Checks whether the population is empty. Note that this is always false, since a population has at least one
    /// individual.
    pub fn is_empty(&self) -> bool {
        self.genes.is_empty()
    }

    /// Number of genes in each genome.
    pub fn genome_len(&self) -> usize {
        self.genome_len
    }

    /// Gets the genome \[genes\] of an individual, or `None` if the index is out of range.
    pub fn get(&self, individual: usize) -> Option<&[G]> {
        self.iter().nth(individual)
    }

    /// An iterator over the genomes \[genes\] in the order of the individuals.
    pub fn iter(&self) -> ChunksExact<'_, G> {
        self.genes.chunks_exact(self.genome_len)
    }

    /// An iterator over the genomes \[genes\] that allows you to change them.
    pub fn iter_mut(&mut self) -> ChunksExactMut<'_, G> {
        self.genes.chunks_exact_mut(self.genome_len)
    }

    /// All genes [individuals x genes], to be changed.
    pub(crate) fn as_mut_slice(&mut self) -> &mut [G] {
        &mut self.genes
    }

    /// Gets all genes as one slice [individuals x genes].
    pub fn as_slice(&self) -> &[G] {
        &self.genes
    }

    /// Computes the [`Digest`] of all genes as little-endian bytes. Use this to notice that two populations differ.
    pub fn digest(&self) -> u64 {
        let (mut digest, mut bytes) = (Digest::new(), Vec::with_capacity(G::BYTES));
        for gene in &self.genes {
            bytes.clear();
            gene.push_bytes(&mut bytes);
            digest.add_bytes(&bytes);
        }
        digest.finish()
    }
}

impl<'a, G: Gene> IntoIterator for &'a Population<G> {
    type Item = &'a [G];
    type IntoIter = ChunksExact<'a, G>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<'a, G: Gene> IntoIterator for &'a mut Population<G> {
    type Item = &'a mut [G];
    type IntoIter = ChunksExactMut<'a, G>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter_mut()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn genomes_lie_one_after_the_other() {
        let mut population = Population::<u16>::new(3, 2).unwrap();
        for (index, genome) in population.iter_mut().enumerate() {
            genome.fill(index as u16);
        }
        assert_eq!(population.as_slice(), [0, 0, 1, 1, 2, 2]);
        assert_eq!((population.len(), population.genome_len(), population.iter().len()), (3, 2, 3));
        assert_eq!((population.get(2), population.get(3)), (Some(&[2, 2][..]), None));
    }

    #[test]
    fn default_sizes_are_those_of_the_table() {
        let sizes = [0, 1, 2, 3, 10, 100, 792, 1000].map(Population::default_size);
        assert_eq!(sizes, [4, 4, 6, 7, 10, 17, 24, 24]);
    }

    #[test]
    fn sizes_are_checked() {
        assert_eq!(Population::<f64>::new(0, 5), Err(EvoError::no_individuals()));
        assert_eq!(Population::<f64>::new(5, 0), Err(EvoError::no_genes()));
        for (population, genes) in [(usize::MAX, 2), (Population::MAX_GENES, 2), (1, Population::MAX_GENES + 1)] {
            assert_eq!(Population::<u16>::new(population, genes), Err(EvoError::too_large(population, genes)));
        }
    }
}
