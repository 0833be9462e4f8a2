//! A search without selection, which serves as a baseline.

use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
#[cfg(feature = "serde")]
use crate::saved::SavedStrategy;
use crate::snapshot::{Snapshot, StateReader};
use crate::strategy::{Strategy, next_generation};
use crate::words::mutation::randomize;

/// Random search. Every genome of every generation is drawn independently, and the best is kept.
///
/// Use this as a baseline to see what selection achieves with the same number of evaluations. Generation 0 is the same
/// as that of a [`TruncationGa`](crate::words::TruncationGa) with the same seed. If you need a random search that keeps
/// its best individual in the population, use a `TruncationGa` with one parent, rate 1 and
/// [`Mutation::Resample`](crate::words::Mutation::Resample).
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::words::RandomSearch;
///
/// let mut search = RandomSearch::new(2, 50, 1)?;
/// let champion = search.maximize(20, |genes| f64::from(genes[0]))?;
/// assert_eq!(search.best().map(|best| best.fitness), Some(champion.fitness));
/// assert!(champion.genome[0] > 65_000);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
///
/// Individual `i` of generation `g` is drawn from the stream (seed, [`Domain::InitialGenome`], trial 0, `i`, `g`).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::saved::SavedStrategy<(usize, usize)>"))]
pub struct RandomSearch {
    seed: u64,
    generation: u32,
    best: Option<BestIndividual>,
    population: Population,
}

/// Best individual that a random search has found so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BestIndividual {
    /// Generation in which it was evaluated.
    pub generation: u32,
    /// Index of the individual in that generation.
    pub individual: usize,
    /// Fitness of the individual, in the unit that the experiment uses.
    pub fitness: Fitness,
}

impl RandomSearch {
    /// Creates a new search whose generations have `population` genomes with `genes` genes each.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`].
    pub fn new(genes: usize, population: usize, seed: u64) -> Result<Self, EvoError> {
        let mut population = Population::new(population, genes)?;
        draw(seed, 0, &mut population);
        Ok(Self { seed, generation: 0, best: None, population })
    }

    /// Gets the best individual so far. If several are equally good, this is the earliest. Before the first generation
    /// is reported, this returns `None`.
    pub fn best(&self) -> Option<BestIndividual> {
        self.best
    }
}

impl Strategy for RandomSearch {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        let next = next_generation(self.generation, self.population.len(), fitness)?;
        for (individual, &fitness) in fitness.iter().enumerate() {
            if self.best.is_none_or(|best| fitness > best.fitness) {
                self.best = Some(BestIndividual { generation: self.generation, individual, fitness });
            }
        }
        self.generation = next;
        draw(self.seed, next, &mut self.population);
        Ok(())
    }

    fn champion_is_best_ever(&self) -> bool {
        true
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }
}

fn stream(seed: u64, generation: u32, individual: usize) -> Stream {
    Stream::new(seed, Domain::InitialGenome, 0, individual as u32, generation)
}

fn draw(seed: u64, generation: u32, population: &mut Population) {
    for (individual, genes) in population.iter_mut().enumerate() {
        randomize(genes, &mut stream(seed, generation, individual));
    }
}

impl Snapshot for RandomSearch {
    fn save(&self) -> Vec<u8> {
        let mut state = Vec::from(self.generation.to_le_bytes());
        if let Some(BestIndividual { generation, individual, fitness }) = self.best {
            state.extend(generation.to_le_bytes());
            state.extend((individual as u64).to_le_bytes());
            state.extend(fitness.get().to_le_bytes());
        }
        state
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let generation = StateReader::new(state, state.len())?.u32()?;
        // Before the first report there is no best, and the state is the generation alone.
        let mut reader = StateReader::new(state, if generation == 0 { 4 } else { 24 })?;
        reader.u32()?;
        let mut best = None;
        if generation > 0 {
            let found = (reader.u32()?, reader.u64()?, reader.fitness()?);
            if found.0 >= generation {
                return Err(EvoError::no_such_generation(found.0, generation - 1));
            }
            let (individual, population) = (usize::try_from(found.1).unwrap_or(usize::MAX), self.population.len());
            if individual >= population {
                return Err(EvoError::no_such_individual(individual, population));
            }
            best = Some(BestIndividual { generation: found.0, individual, fitness: found.2 });
        }
        (self.generation, self.best) = (generation, best);
        draw(self.seed, generation, &mut self.population);
        Ok(())
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for RandomSearch {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let sizes = (self.population.genome_len(), self.population.len());
        SavedStrategy::new(sizes, self.seed, self).serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl TryFrom<SavedStrategy<(usize, usize)>> for RandomSearch {
    type Error = EvoError;

    fn try_from(saved: SavedStrategy<(usize, usize)>) -> Result<Self, EvoError> {
        let (genes, population) = saved.config;
        let mut strategy = Self::new(genes, population, saved.seed)?;
        strategy.restore(&saved.state)?;
        Ok(strategy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_the_best_is_remembered() {
        let mut search = RandomSearch::new(3, 2, 1).unwrap();
        assert_eq!(search.best(), None);
        for (generation, fitness) in [[0.0, 1.0], [3.0, 3.0], [3.0, f64::NAN]].into_iter().enumerate() {
            assert_eq!(search.generation(), generation as u32);
            search.tell(&fitness.map(Fitness::nan_as_failed)).unwrap();
        }
        let fitness = Fitness::nan_as_failed(3.0);
        assert_eq!(search.best(), Some(BestIndividual { generation: 1, individual: 0, fitness }));
        // A state with the best of a later generation is invalid, one with the best of the latest is valid.
        let mut state = search.save();
        state[4..8].copy_from_slice(&9_u32.to_le_bytes());
        assert_eq!(search.restore(&state), Err(EvoError::no_such_generation(9, 2)));
    }

    #[test]
    fn every_genome_is_new() {
        let mut search = RandomSearch::new(8, 10, 1).unwrap();
        let mut seen = alloc::collections::BTreeSet::new();
        for _ in 0..10 {
            seen.extend(search.ask().iter().map(<[u16]>::to_vec));
            search.tell(&[Fitness::WORST; 10]).unwrap();
        }
        assert_eq!(seen.len(), 100);
    }
}
