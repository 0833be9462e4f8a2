//! The null model: search without selection.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::mutation::randomize;
use crate::population::Population;
#[cfg(feature = "serde")]
use crate::saved::Saved;
use crate::strategy::{Strategy, next_generation};

/// Random search: every genome of every generation is drawn anew, and the best of all is remembered.
///
/// What an evolution finds beyond this, with the same number of lives, is owed to selection. Generation 0 is that of a
/// [`TruncationGa`](crate::TruncationGa) of the same seed. (For random search that keeps its best in the population,
/// take a `TruncationGa` of one parent, rate 1 and [`Mutation::Resample`](crate::Mutation::Resample).)
///
/// ```
/// use farsa_evo::{RandomSearch, Strategy};
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
#[cfg_attr(feature = "serde", serde(try_from = "crate::saved::Saved<SearchState>"))]
pub struct RandomSearch {
    seed: u64,
    generation: u32,
    best: Option<Found>,
    population: Population,
}

/// Where, and how good, the best individual so far was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Found {
    /// Its generation.
    pub generation: u32,
    /// Its index in that generation.
    pub individual: usize,
    /// Its fitness, in the experiment's own unit.
    pub fitness: Fitness,
}

impl RandomSearch {
    /// A search by generations of `population` genomes of `genes` genes, at its first.
    ///
    /// # Errors
    /// [`EvoError::NoIndividuals`], [`EvoError::NoGenes`] or [`EvoError::TooLarge`].
    pub fn new(genes: usize, population: usize, seed: u64) -> Result<Self, EvoError> {
        let mut population = Population::new(population, genes)?;
        draw(seed, 0, &mut population);
        Ok(Self { seed, generation: 0, best: None, population })
    }

    /// The best individual told so far, the earliest among equals; none before the first generation is told.
    pub fn best(&self) -> Option<Found> {
        self.best
    }

    fn check(&self, generation: u32, individual: usize) -> Result<(), EvoError> {
        let (latest, population) = (self.generation, self.population.len());
        if generation > latest {
            Err(EvoError::NoSuchGeneration { generation, latest })
        } else if individual >= population {
            Err(EvoError::NoSuchIndividual { individual, population })
        } else {
            Ok(())
        }
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
                self.best = Some(Found { generation: self.generation, individual, fitness });
            }
        }
        self.generation = next;
        draw(self.seed, next, &mut self.population);
        Ok(())
    }

    fn genomes_at(&self, generation: u32) -> Result<Population, EvoError> {
        self.check(generation, 0)?;
        let mut population = self.population.clone();
        draw(self.seed, generation, &mut population);
        Ok(population)
    }

    fn genome_of(&self, generation: u32, individual: usize) -> Result<Vec<u16>, EvoError> {
        self.check(generation, individual)?;
        let mut genes = vec![0; self.population.genome_len()];
        randomize(&mut genes, &mut stream(self.seed, generation, individual));
        Ok(genes)
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

/// What is saved of a search.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct SearchState {
    genes: usize,
    population: usize,
    seed: u64,
    generation: u32,
    best: Option<Found>,
}

#[cfg(feature = "serde")]
impl serde::Serialize for RandomSearch {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let state = SearchState {
            genes: self.population.genome_len(),
            population: self.population.len(),
            seed: self.seed,
            generation: self.generation,
            best: self.best,
        };
        Saved::new(state, &self.population).serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Saved<SearchState>> for RandomSearch {
    type Error = EvoError;

    fn try_from(saved: Saved<SearchState>) -> Result<Self, EvoError> {
        let state = &saved.state;
        let mut search = Self::new(state.genes, state.population, state.seed)?;
        search.generation = state.generation;
        draw(state.seed, state.generation, &mut search.population);
        saved.check(&search.population)?;
        // Exactly the told generations have a best individual, and it is one of them.
        search.best = state.best;
        match (state.best, state.generation.checked_sub(1)) {
            (None, None) => Ok(search),
            (Some(best), Some(latest)) if best.generation <= latest => {
                search.check(best.generation, best.individual)?;
                Ok(search)
            }
            (Some(Found { generation, .. }), latest) => {
                Err(EvoError::NoSuchGeneration { generation, latest: latest.unwrap_or(0) })
            }
            (None, Some(_)) => Err(EvoError::NoBest { generation: state.generation }),
        }
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
        assert_eq!(search.best(), Some(Found { generation: 1, individual: 0, fitness }));
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
