//! A steady-state search of one parent and one mutant: the (1+1) of the original's discrimination experiment.

use alloc::vec::Vec;

use crate::config::OnePlusOneConfig;
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::one_plus_one_history::OnePlusOneHistory;
use crate::population::Population;
#[cfg(feature = "serde")]
use crate::saved::Saved;
use crate::strategy::{Strategy, next_generation};

/// A search in which one parent makes one mutant a generation, and the better of the two stays.
///
/// [`ask`](Strategy::ask) gives the parent (individual 0) and its mutant (individual 1). The parent is evaluated again
/// every generation, and its fitness is the mean over its life, the evaluation as a mutant included; the mutant takes its
/// place when its own first evaluation is at least as good. A failed evaluation makes that mean the worst there is, so
/// that a parent that failed once gives way to any mutant. [`OnePlusOneHistory`] says which numbers are drawn.
///
/// Source: the steady-state algorithm of \[FARSA2\] with one individual, whose fitness is averaged over generations.
/// Deviation: the random numbers are ours.
///
/// ```
/// use farsa_evo::{OnePlusOne, OnePlusOneConfig, Strategy};
///
/// let mut search = OnePlusOne::new(OnePlusOneConfig::new(4), 3)?;
/// let champion = search.maximize(400, |genes| genes.iter().map(|gene| f64::from(*gene)).sum())?;
/// assert!(champion.fitness.get() > 4.0 * 250.0);
/// assert_eq!(search.parent_fitness().map(|(fitness, _)| fitness), Some(champion.fitness));
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
///
/// Under the feature `serde` it is saved as its history, the parent's summed fitness and a digest of the current genomes,
/// which are rebuilt when it is read.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::saved::Saved<OnePlusOneSaved>"))]
pub struct OnePlusOne {
    history: OnePlusOneHistory,
    /// The parent's fitness summed over its evaluations so far.
    sum: Fitness,
    /// The parent's evaluations so far, 0 for the first parent before the first generation is told.
    evaluations: u32,
    population: Population,
}

impl OnePlusOne {
    /// A search at its random initial generation.
    ///
    /// # Errors
    /// Those of [`OnePlusOneConfig::validate`].
    pub fn new(config: OnePlusOneConfig, seed: u64) -> Result<Self, EvoError> {
        let history = OnePlusOneHistory::new(config, seed)?;
        let population = history.genomes_at(0)?;
        Ok(Self { history, sum: Fitness::nan_as_failed(0.0), evaluations: 0, population })
    }

    /// The configuration.
    pub fn config(&self) -> &OnePlusOneConfig {
        self.history.config()
    }

    /// What became of every mutant so far.
    pub fn history(&self) -> &OnePlusOneHistory {
        &self.history
    }

    /// The mean fitness of the current parent over its evaluations so far, and their number; none before the first
    /// generation is told.
    pub fn parent_fitness(&self) -> Option<(Fitness, u32)> {
        (self.evaluations > 0).then(|| (mean(self.sum, self.evaluations), self.evaluations))
    }

    /// The two values that the next [`tell`](Strategy::tell) of this fitness \[2\] will compare: the mean over the
    /// parent's life, the new evaluation included, and the mutant's fitness.
    ///
    /// # Errors
    /// [`EvoError::FitnessCount`].
    pub fn judged(&self, fitness: &[Fitness]) -> Result<[Fitness; 2], EvoError> {
        let &[parent, mutant] = fitness else {
            return Err(EvoError::FitnessCount { expected: OnePlusOneHistory::INDIVIDUALS, found: fitness.len() });
        };
        Ok([mean(self.grown(parent), self.evaluations.saturating_add(1)), mutant])
    }

    /// The sum of the parent's fitness with one more evaluation; infinities of both signs make a failure.
    fn grown(&self, parent: Fitness) -> Fitness {
        Fitness::nan_as_failed(self.sum.get() + parent.get())
    }
}

fn mean(sum: Fitness, evaluations: u32) -> Fitness {
    Fitness::nan_as_failed(sum.get() / f64::from(evaluations))
}

impl Strategy for OnePlusOne {
    fn generation(&self) -> u32 {
        self.history.latest()
    }

    fn ask(&self) -> &Population {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        let next = next_generation(self.generation(), OnePlusOneHistory::INDIVIDUALS, fitness)?;
        let [parent, mutant] = self.judged(fitness)?;
        let accepted = mutant >= parent;
        let survivor = self.population.get(usize::from(accepted)).map(<[u16]>::to_vec).unwrap_or_default();
        let mut population = Population::new(OnePlusOneHistory::INDIVIDUALS, self.config().genes)?;
        for (individual, genes) in population.iter_mut().enumerate() {
            genes.copy_from_slice(&survivor);
            self.history.vary(next, individual, genes)?;
        }
        self.history.record(accepted)?;
        (self.sum, self.evaluations) = match fitness {
            &[parent, _] if !accepted => (self.grown(parent), self.evaluations.saturating_add(1)),
            _ => (mutant, 1),
        };
        self.population = population;
        Ok(())
    }

    fn genomes_at(&self, generation: u32) -> Result<Population, EvoError> {
        self.history.genomes_at(generation)
    }

    fn genome_of(&self, generation: u32, individual: usize) -> Result<Vec<u16>, EvoError> {
        self.history.genome_of(generation, individual)
    }
}

/// What is saved of a search; the number of the parent's evaluations follows from its history.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct OnePlusOneSaved {
    history: OnePlusOneHistory,
    sum: Fitness,
}

#[cfg(feature = "serde")]
impl serde::Serialize for OnePlusOne {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let state = OnePlusOneSaved { history: self.history.clone(), sum: self.sum };
        Saved::new(state, &self.population).serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Saved<OnePlusOneSaved>> for OnePlusOne {
    type Error = EvoError;

    fn try_from(saved: Saved<OnePlusOneSaved>) -> Result<Self, EvoError> {
        let OnePlusOneSaved { history, sum } = &saved.state;
        let latest = history.latest();
        let population = history.genomes_at(latest)?;
        saved.check(&population)?;
        let born = (0..latest).rev().find(|&generation| history.accepted(generation) == Some(true));
        // A mutant's first evaluation was in the generation in which it took its parent's place.
        let evaluations = latest - born.unwrap_or(0);
        Ok(Self { history: history.clone(), sum: *sum, evaluations, population })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search() -> OnePlusOne {
        OnePlusOne::new(OnePlusOneConfig::new(14), 9).unwrap()
    }

    fn tell(search: &mut OnePlusOne, parent: f64, mutant: f64) -> bool {
        search.tell(&[parent, mutant].map(Fitness::nan_as_failed)).unwrap();
        search.history().accepted(search.generation() - 1).unwrap()
    }

    #[test]
    fn the_parent_is_judged_by_its_whole_life() {
        let mut search = search();
        assert_eq!(search.parent_fitness(), None);
        assert!(!tell(&mut search, 4.0, 3.9));
        // The mean is (4 + 1) / 2: a mutant between it and the last evaluation stays out, an equal one comes in.
        assert!(!tell(&mut search, 1.0, 2.4));
        assert_eq!(search.parent_fitness(), Some((Fitness::nan_as_failed(2.5), 2)));
        assert!(tell(&mut search, 1.0, 2.0));
        // The evaluation as a mutant is the first of the new parent's life.
        assert_eq!(search.parent_fitness(), Some((Fitness::nan_as_failed(2.0), 1)));
        assert!(!tell(&mut search, 4.0, 2.9));
        assert_eq!(search.parent_fitness(), Some((Fitness::nan_as_failed(3.0), 2)));
    }

    #[test]
    fn a_failure_is_never_forgiven_and_ties_go_to_the_mutant() {
        let mut search = search();
        assert!(!tell(&mut search, 5.0, f64::NAN));
        assert!(tell(&mut search, f64::NAN, f64::NAN));
        assert!(search.parent_fitness().unwrap().0.is_failed());
        assert!(tell(&mut search, 1.0, -7.0));
        assert!(!tell(&mut search, f64::INFINITY, 0.0));
        // Infinities of both signs are no number, which is a failure.
        assert!(tell(&mut search, f64::NEG_INFINITY, -1e300));
    }

    #[test]
    fn the_rate_falls_by_its_step_to_the_last() {
        let config = OnePlusOneConfig::new(1);
        assert_eq!([0, 1, 25].map(|generation| config.rate(generation)), [0.5, 0.49, 0.25]);
        assert!((config.rate(48) - 0.02).abs() < 1e-15);
        assert_eq!([49, 499, u32::MAX].map(|generation| config.rate(generation)), [0.02; 3]);
    }

    #[test]
    fn impossible_configurations_are_refused() {
        let refused = |change: fn(&mut OnePlusOneConfig)| {
            let mut config = OnePlusOneConfig::new(14);
            change(&mut config);
            OnePlusOne::new(config, 0).unwrap_err()
        };
        assert_eq!(refused(|c| c.genes = 0), EvoError::NoGenes);
        assert_eq!(refused(|c| c.genes = usize::MAX), EvoError::TooLarge { population: 2, genes: usize::MAX });
        assert_eq!(refused(|c| c.gene_bits = 17), EvoError::GeneBits { bits: 17 });
        assert_eq!(refused(|c| c.first_rate = 1.5), EvoError::Rate { rate: 1.5 });
        assert_eq!(refused(|c| c.rate_step = -0.01), EvoError::Rate { rate: -0.01 });
        assert!(matches!(refused(|c| c.last_rate = f64::NAN), EvoError::Rate { .. }));
        assert_eq!(refused(|c| c.last_rate = 0.6), EvoError::RisingRate { first: 0.5, last: 0.6 });
    }

    #[test]
    fn a_wrong_number_of_fitness_values_changes_nothing() {
        let mut search = search();
        let before = search.clone();
        for found in [0, 1, 3] {
            let told = alloc::vec![Fitness::WORST; found];
            assert_eq!(search.tell(&told), Err(EvoError::FitnessCount { expected: 2, found }));
        }
        assert_eq!(search, before);
    }
}
