//! What became of every mutant of a steady-state search: enough to rebuild every genome of it.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::config::{OnePlusOneConfig, PARENT_AND_MUTANT};
use crate::error::EvoError;
use crate::mutation::randomize_bits;
use crate::population::Population;

/// The configuration, the seed and, for every generation, whether the mutant took its parent's place: one bit.
///
/// Individual 0 of a generation is the parent, individual 1 its mutant. The first parent is drawn from the stream (seed,
/// [`Domain::InitialGenome`], trial 0, individual 0, generation 0), as individual 0 of a
/// [`TruncationGa`](crate::TruncationGa) is; the mutant of a generation draws from (seed, [`Domain::Mutation`], trial 0,
/// individual 1, its generation).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RawHistory"))]
pub struct OnePlusOneHistory {
    config: OnePlusOneConfig,
    seed: u64,
    /// Generations recorded.
    generations: u32,
    /// Bit g % 8 of byte g / 8 is set where the mutant of generation g stayed; the rest is zero.
    accepted: Vec<u8>,
}

impl OnePlusOneHistory {
    /// Number of individuals of a generation: a parent and its mutant.
    pub const INDIVIDUALS: usize = PARENT_AND_MUTANT;

    /// The history of a search that has only its initial generation.
    ///
    /// # Errors
    /// Those of [`OnePlusOneConfig::validate`].
    pub fn new(config: OnePlusOneConfig, seed: u64) -> Result<Self, EvoError> {
        config.validate()?;
        Ok(Self { config, seed, generations: 0, accepted: Vec::new() })
    }

    /// Records whether the mutant of the latest generation took its parent's place, which makes the next generation.
    ///
    /// # Errors
    /// [`EvoError::LastGeneration`]; the history is then unchanged.
    pub fn record(&mut self, accepted: bool) -> Result<(), EvoError> {
        let next = self.generations.checked_add(1).ok_or(EvoError::LastGeneration)?;
        if self.generations.is_multiple_of(8) {
            self.accepted.push(0);
        }
        if let Some(byte) = self.accepted.last_mut() {
            *byte |= u8::from(accepted) << (self.generations % 8);
        }
        self.generations = next;
        Ok(())
    }

    /// The configuration of the search.
    pub fn config(&self) -> &OnePlusOneConfig {
        &self.config
    }

    /// The seed of the search.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The number of the latest generation whose genomes are known, 0 when nothing is recorded.
    pub fn latest(&self) -> u32 {
        self.generations
    }

    /// Whether the mutant of a generation took its parent's place; none for the latest and what lies ahead.
    pub fn accepted(&self, generation: u32) -> Option<bool> {
        let byte = self.accepted.get((generation / 8) as usize).filter(|_| generation < self.generations)?;
        Some(byte >> (generation % 8) & 1 == 1)
    }

    /// The individual that survived a generation, 0 or 1; none for the latest and what lies ahead.
    pub fn survivor(&self, generation: u32) -> Option<usize> {
        self.accepted(generation).map(usize::from)
    }

    /// The genomes of a generation [2 x genes], the parent first.
    ///
    /// # Errors
    /// [`EvoError::NoSuchGeneration`].
    pub fn genomes_at(&self, generation: u32) -> Result<Population, EvoError> {
        let parent = self.parent_at(generation)?;
        let mut population = Population::new(Self::INDIVIDUALS, self.config.genes)?;
        for (individual, genome) in population.iter_mut().enumerate() {
            genome.copy_from_slice(&parent);
            self.vary(generation, individual, genome)?;
        }
        Ok(population)
    }

    /// The genome \[genes\] of the parent (0) or the mutant (1) of a generation.
    ///
    /// # Errors
    /// [`EvoError::NoSuchGeneration`] or [`EvoError::NoSuchIndividual`].
    pub fn genome_of(&self, generation: u32, individual: usize) -> Result<Vec<u16>, EvoError> {
        let mut genes = self.parent_at(generation)?;
        if individual >= Self::INDIVIDUALS {
            return Err(EvoError::NoSuchIndividual { individual, population: Self::INDIVIDUALS });
        }
        self.vary(generation, individual, &mut genes)?;
        Ok(genes)
    }

    /// The parent of a generation: the first one, changed by every mutation that was accepted since.
    fn parent_at(&self, generation: u32) -> Result<Vec<u16>, EvoError> {
        let latest = self.latest();
        if generation > latest {
            return Err(EvoError::NoSuchGeneration { generation, latest });
        }
        let mut genes = vec![0; self.config.genes];
        let mut stream = Stream::new(self.seed, Domain::InitialGenome, 0, 0, 0);
        randomize_bits(&mut genes, self.config.gene_bits, &mut stream);
        for time in (0..generation).filter(|&time| self.accepted(time) == Some(true)) {
            self.vary(time, 1, &mut genes)?;
        }
        Ok(genes)
    }

    /// Turns the genes \[genes\] of the parent of a generation into those of one of its individuals: kept or mutated.
    pub(crate) fn vary(&self, generation: u32, individual: usize, genes: &mut [u16]) -> Result<(), EvoError> {
        if individual > 0 {
            let mut stream = Stream::new(self.seed, Domain::Mutation, 0, individual as u32, generation);
            self.config.bit_mutation(generation)?.apply(genes, &mut stream);
        }
        Ok(())
    }
}

/// A history as it is read, before anything in it is believed.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(rename = "OnePlusOneHistory")]
struct RawHistory {
    config: OnePlusOneConfig,
    seed: u64,
    generations: u32,
    accepted: Vec<u8>,
}

#[cfg(feature = "serde")]
impl TryFrom<RawHistory> for OnePlusOneHistory {
    type Error = EvoError;

    fn try_from(raw: RawHistory) -> Result<Self, EvoError> {
        let RawHistory { config, seed, generations, accepted } = raw;
        config.validate()?;
        let unused = accepted.last().is_some_and(|byte| generations % 8 != 0 && byte >> (generations % 8) != 0);
        if accepted.len() != generations.div_ceil(8) as usize || unused {
            return Err(EvoError::History { generations, bytes: accepted.len() });
        }
        Ok(Self { config, seed, generations, accepted })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_accepted_mutants_have_descendants() {
        let mut history = OnePlusOneHistory::new(OnePlusOneConfig::new(14), 3).unwrap();
        let mut parent = history.genome_of(0, 0).unwrap();
        // A chain by hand: whoever survives is the next parent.
        for generation in 0..40 {
            let lived = history.genomes_at(generation).unwrap();
            assert_eq!(lived.get(0), Some(&parent[..]));
            for individual in 0..2 {
                assert_eq!(history.genome_of(generation, individual).unwrap(), lived.get(individual).unwrap());
            }
            let accepted = generation % 3 == 1 || generation > 30;
            history.record(accepted).unwrap();
            assert_eq!(history.accepted(generation), Some(accepted));
            parent = lived.get(history.survivor(generation).unwrap()).unwrap().to_vec();
        }
        assert_eq!((history.latest(), history.accepted(40), history.survivor(41)), (40, None, None));
        let ahead = EvoError::NoSuchGeneration { generation: 41, latest: 40 };
        assert_eq!(history.genomes_at(41), Err(ahead));
        assert_eq!(history.genome_of(41, 0), Err(ahead));
        assert_eq!(history.genome_of(2, 2), Err(EvoError::NoSuchIndividual { individual: 2, population: 2 }));
    }
}
