//! The genetic algorithm of the reference experiments: the best survive and make mutated copies.

use alloc::vec::Vec;

use crate::config::GaConfig;
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::lineage::Lineage;
use crate::population::Population;
#[cfg(feature = "serde")]
use crate::saved::Saved;
use crate::strategy::{Strategy, next_generation};

/// A generational genetic algorithm with truncation selection, elites and bit mutation, without crossover. Its population is a
/// multiple of its parents.
///
/// Each generation the `parents` best individuals make `population / parents` copies each: the first unchanged, the
/// others mutated. Parents are ranked by fitness, equals by index, the lower first; failed individuals are selected
/// only when too few lived. [`Lineage`] says where the children lie and which numbers they draw. With as many parents
/// as individuals nothing is ever mutated.
///
/// Source: \[Ferrauto2010\] chapter 2, truncation selection in the terms of \[Muhlenbein1993\]. Deviations: everyone is
/// evaluated again in every generation, the unchanged copies too, and ties go to the lower index; the source says
/// neither.
///
/// ```
/// use farsa_evo::{GaConfig, Strategy, TruncationGa};
///
/// let mut evolution = TruncationGa::new(GaConfig { population: 40, parents: 8, ..GaConfig::new(3) }, 7)?;
/// while evolution.generation() < 20 {
///     let values: Vec<f64> = evolution.ask().iter().map(|genes| -f64::from(genes[0].abs_diff(20_000))).collect();
///     evolution.tell_values(&values)?;
/// }
/// // The first copy of the best is unchanged.
/// assert!(evolution.ask().iter().next().is_some_and(|genes| genes[0].abs_diff(20_000) < 200));
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
///
/// Under the feature `serde` it is saved as its lineage and a digest of the current genomes, which are rebuilt when it
/// is read.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::saved::Saved<Lineage>"))]
pub struct TruncationGa {
    lineage: Lineage,
    population: Population,
}

impl TruncationGa {
    /// An evolution at its random initial generation.
    ///
    /// # Errors
    /// Those of [`GaConfig::validate`].
    pub fn new(config: GaConfig, seed: u64) -> Result<Self, EvoError> {
        Self::resume(Lineage::new(config, seed)?)
    }

    /// An evolution at the latest generation of a lineage, in the same state as the one that recorded it.
    ///
    /// # Errors
    /// None for a lineage that was made on this machine.
    pub fn resume(lineage: Lineage) -> Result<Self, EvoError> {
        let population = lineage.genomes_at(lineage.latest())?;
        Ok(Self { lineage, population })
    }

    /// The configuration.
    pub fn config(&self) -> &GaConfig {
        self.lineage.config()
    }

    /// The parents of every generation so far.
    pub fn lineage(&self) -> &Lineage {
        &self.lineage
    }
}

impl Strategy for TruncationGa {
    fn generation(&self) -> u32 {
        self.lineage.latest()
    }

    fn ask(&self) -> &Population {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        let config = *self.config();
        let generation = next_generation(self.generation(), config.population, fitness)?;
        let selected = best(fitness, config.parents);
        let mutation = config.bit_mutation()?;
        let mut children = Population::new(config.population, config.genes)?;
        let parents = selected.iter().filter_map(|&parent| self.population.get(parent as usize));
        let heirs = parents.flat_map(|parent| core::iter::repeat_n(parent, config.copies()));
        for (individual, (child, parent)) in children.iter_mut().zip(heirs).enumerate() {
            child.copy_from_slice(parent);
            self.lineage.vary(mutation, generation, individual, child);
        }
        self.lineage.record(&selected)?;
        self.population = children;
        Ok(())
    }

    fn genomes_at(&self, generation: u32) -> Result<Population, EvoError> {
        self.lineage.genomes_at(generation)
    }

    fn genome_of(&self, generation: u32, individual: usize) -> Result<Vec<u16>, EvoError> {
        self.lineage.genome_of(generation, individual)
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for TruncationGa {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Saved::new(&self.lineage, &self.population).serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Saved<Lineage>> for TruncationGa {
    type Error = EvoError;

    fn try_from(saved: Saved<Lineage>) -> Result<Self, EvoError> {
        let population = saved.state.genomes_at(saved.state.latest())?;
        saved.check(&population)?;
        Ok(Self { lineage: saved.state, population })
    }
}

/// The indices of the `count` best, best first, equals by index.
fn best(fitness: &[Fitness], count: usize) -> Vec<u32> {
    let mut ranked: Vec<(Fitness, u32)> = fitness.iter().copied().zip(0..).collect();
    ranked.sort_unstable_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
    ranked.into_iter().take(count).map(|(_, index)| index).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(change: impl FnOnce(&mut GaConfig)) -> EvoError {
        let mut config = GaConfig::new(10);
        change(&mut config);
        TruncationGa::new(config, 0).unwrap_err()
    }

    #[test]
    fn impossible_configurations_are_refused() {
        assert_eq!(refused(|c| c.genes = 0), EvoError::NoGenes);
        assert_eq!(refused(|c| c.population = 0), EvoError::NoIndividuals);
        assert_eq!(refused(|c| c.parents = 0), EvoError::NoParents);
        assert_eq!(refused(|c| c.parents = 101), EvoError::TooManyParents { population: 100, parents: 101 });
        assert_eq!(refused(|c| c.parents = 30), EvoError::UnevenCopies { population: 100, parents: 30 });
        assert_eq!(refused(|c| c.mutation_rate = 1.5), EvoError::Rate { rate: 1.5 });
        assert!(matches!(refused(|c| c.mutation_rate = f64::NAN), EvoError::Rate { .. }));
        assert_eq!(refused(|c| c.genes = usize::MAX), EvoError::TooLarge { population: 100, genes: usize::MAX });
    }

    #[test]
    fn ties_go_to_the_lower_index() {
        let fitness = [1.0, 5.0, f64::NAN, 5.0, 1.0, f64::NAN].map(Fitness::nan_as_failed);
        assert_eq!(best(&fitness, 6), [1, 3, 0, 4, 2, 5]);
        assert_eq!(best(&fitness, 3), [1, 3, 0]);
    }

    #[test]
    fn a_wrong_number_of_fitness_values_changes_nothing() {
        let mut ga = TruncationGa::new(GaConfig::new(10), 0).unwrap();
        let before = ga.clone();
        for found in [0, 99, 101] {
            let told = alloc::vec![Fitness::WORST; found];
            assert_eq!(ga.tell(&told), Err(EvoError::FitnessCount { expected: 100, found }));
        }
        assert_eq!(ga, before);
    }
}
