//! Saved states of strategies.

use alloc::vec::Vec;

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;

/// A strategy that can resume from a saved state, without replaying earlier generations.
pub trait Snapshot {
    /// Saves everything that changes from generation to generation as bytes. Note that this does not include the
    /// configuration and the seed.
    fn save(&self) -> Vec<u8>;

    /// Restores a state that was saved by a strategy with the same configuration and seed. After that,
    /// [`save`](Self::save) returns the same bytes.
    ///
    /// # Errors
    /// Returns [`EvoError::State`]. The strategy is then unchanged.
    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError>;

    /// The largest number of generations between two states of a [`Record`](crate::Record), at least 1, for strategies that
    /// are slow to replay. The interval doubles for every 256 MiB of states. By default a record stores states as often as
    /// they at most double it.
    fn snapshot_interval(&self) -> u32 {
        u32::MAX
    }
}

/// The number of generations that are replayed in about a second, at 50 ns for each gene of each individual.
pub(crate) fn between_states(population: &Population<f64>) -> u32 {
    let genes = (population.as_slice().len() as u64).max(1);
    u32::try_from(20_000_000 / genes).unwrap_or(u32::MAX).max(1)
}

/// A reader that decodes a state from front to back, in little-endian order.
pub struct StateReader<'s> {
    rest: &'s [u8],
    total: usize,
}

impl<'s> StateReader<'s> {
    /// Starts to read a state, which must have the expected number of bytes.
    pub(crate) fn new(state: &'s [u8], expected: usize) -> Result<Self, EvoError> {
        let found = state.len();
        if found == expected {
            Ok(Self { rest: state, total: found })
        } else {
            Err(EvoError::state_length(expected, found))
        }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], EvoError> {
        let short = || EvoError::state_length(self.total - self.rest.len() + N, self.total);
        let (first, rest) = self.rest.split_first_chunk::<N>().ok_or_else(short)?;
        self.rest = rest;
        Ok(*first)
    }

    pub(crate) fn u32(&mut self) -> Result<u32, EvoError> {
        self.take().map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self) -> Result<u64, EvoError> {
        self.take().map(u64::from_le_bytes)
    }

    pub(crate) fn fitness(&mut self) -> Result<Fitness, EvoError> {
        Fitness::try_from(self.take().map(f64::from_le_bytes)?)
    }

    /// A finite number.
    pub(crate) fn real(&mut self) -> Result<f64, EvoError> {
        let x = self.take().map(f64::from_le_bytes)?;
        if x.is_finite() { Ok(x) } else { Err(EvoError::state_content("a finite number", x.to_bits())) }
    }

    /// A row of finite numbers.
    pub(crate) fn reals(&mut self, row: &mut [f64]) -> Result<(), EvoError> {
        row.iter_mut().try_for_each(|x| self.real().map(|found| *x = found))
    }

    /// A row of numbers within a range, both ends included.
    pub(crate) fn row(&mut self, row: &mut [f64], what: &'static str, [low, high]: [f64; 2]) -> Result<(), EvoError> {
        self.reals(row)?;
        let wrong = row.iter().find(|x| !(low..=high).contains(*x));
        wrong.map_or(Ok(()), |x| Err(EvoError::state_content(what, x.to_bits())))
    }

    /// Indices of individuals of a population of this size.
    pub(crate) fn individuals(&mut self, count: usize, population: usize) -> Result<Vec<u32>, EvoError> {
        let mut individual = || match self.u32()? {
            found if (found as usize) < population => Ok(found),
            found => Err(EvoError::no_such_individual(found as usize, population)),
        };
        (0..count).map(|_| individual()).collect()
    }

    /// The genes of a population, none of them above the largest.
    pub(crate) fn genes(&mut self, population: &mut Population, largest: u16) -> Result<(), EvoError> {
        for genome in population.iter_mut() {
            for gene in genome {
                *gene = self.take().map(u16::from_le_bytes)?;
                if *gene > largest {
                    return Err(EvoError::state_content("a gene", (*gene).into()));
                }
            }
        }
        Ok(())
    }
}

/// Appends the genes of a population.
pub(crate) fn push_genes(state: &mut Vec<u8>, population: &Population) {
    state.extend(population.as_slice().iter().flat_map(|gene| gene.to_le_bytes()));
}

/// Appends indices.
pub(crate) fn push_indices(state: &mut Vec<u8>, indices: &[u32]) {
    state.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
}

/// Appends a row of numbers.
pub(crate) fn push_reals(state: &mut Vec<u8>, row: &[f64]) {
    state.extend(row.iter().flat_map(|x| x.to_le_bytes()));
}

/// The largest gene of the given number of bits, 1 to 16.
pub(crate) fn largest(gene_bits: u32) -> u16 {
    u16::MAX >> u16::BITS.saturating_sub(gene_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_are_as_far_apart_as_a_second_of_telling() {
        for (individuals, genes, generations) in [(1, 1, 20_000_000), (100, 200, 1000), (5000, 5000, 1)] {
            let population = Population::new(individuals, genes).unwrap();
            assert_eq!(between_states(&population), generations, "{individuals} x {genes}");
        }
    }
}
