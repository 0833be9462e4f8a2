//! A search of one parent and one mutant: the (1+1) of the original's discrimination experiment.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
#[cfg(feature = "serde")]
use crate::saved::SavedStrategy;
use crate::snapshot::{Snapshot, StateReader, largest, push_genes};
use crate::strategy::{Genealogy, Strategy, next_generation};
use crate::words::mutation::{BitMutation, Mutation, check_gene_bits, randomize_bits};

/// Number of individuals of a search of one parent and one mutant.
pub(crate) const PARENT_AND_MUTANT: usize = 2;

/// Configuration of [`OnePlusOne`](crate::words::OnePlusOne).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OnePlusOneConfig {
    /// Number of genes in each genome.
    pub genes: usize,
    /// Number of bits in a gene, 1 to 16. Genes range from 0 to 2^bits - 1.
    pub gene_bits: u32,
    /// Probability, 0 to 1, that mutation hits a bit of the mutant of generation 0.
    pub first_rate: f64,
    /// Amount by which the probability decreases from generation to generation, 0 to 1.
    pub rate_step: f64,
    /// Lower limit of the probability, from 0 to the first probability.
    pub last_rate: f64,
    /// Determines what happens to a bit that is hit by mutation.
    pub mutation: Mutation,
}

impl OnePlusOneConfig {
    /// Creates the configuration of the discrimination experiment of \[FARSA2\] for genomes with this many genes of 8
    /// bits. At first half of all bits flip. This decreases by 1 % in every generation, down to 2 %.
    pub const fn new(genes: usize) -> Self {
        Self { genes, gene_bits: 8, first_rate: 0.5, rate_step: 0.01, last_rate: 0.02, mutation: Mutation::Flip }
    }

    /// Checks that all settings are within their allowed ranges.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`].
    pub fn validate(&self) -> Result<(), EvoError> {
        let Self { genes, gene_bits, first_rate, rate_step, last_rate, .. } = *self;
        Population::check(PARENT_AND_MUTANT, genes)?;
        check_gene_bits(gene_bits)?;
        for rate in [first_rate, rate_step, last_rate] {
            BitMutation::new(self.mutation, rate)?;
        }
        if last_rate > first_rate {
            return Err(EvoError::rising_rate(first_rate, last_rate));
        }
        Ok(())
    }

    /// Computes the probability (0 to 1) that mutation hits a bit of the mutant of a generation.
    pub fn rate(&self, generation: u32) -> f64 {
        (self.first_rate - self.rate_step * f64::from(generation)).max(self.last_rate)
    }

    pub(crate) fn bit_mutation(&self, generation: u32) -> Result<BitMutation, EvoError> {
        BitMutation::new(self.mutation, self.rate(generation))?.with_gene_bits(self.gene_bits)
    }
}

/// A search in which one parent makes one mutant a generation, and the better of the two stays.
///
/// [`ask`](Strategy::ask) returns the parent (individual 0) and its mutant (individual 1). Since the parent is
/// evaluated again in every generation, its fitness is the mean over all its evaluations, including those as a mutant.
/// If the first evaluation of the mutant is at least as good, the mutant replaces the parent. A failed evaluation makes
/// the mean the worst possible, so a parent that failed once is replaced by any mutant.
///
/// Source: the steady-state algorithm of \[FARSA2\] with one individual, whose fitness is averaged over generations.
/// Deviation: the random numbers are ours.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::words::{OnePlusOne, OnePlusOneConfig};
///
/// let mut search = OnePlusOne::new(OnePlusOneConfig::new(4), 3)?;
/// let champion = search.maximize(400, |genes| genes.iter().map(|gene| f64::from(*gene)).sum())?;
/// assert!(champion.fitness.get() > 4.0 * 250.0);
/// assert_eq!(search.parent_fitness().map(|(fitness, _)| fitness), Some(champion.fitness));
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
///
/// The first parent is drawn from the stream (seed, [`Domain::InitialGenome`], trial 0, individual 0, generation 0), like
/// individual 0 of a [`TruncationGa`](crate::words::TruncationGa). The mutant of a generation draws from (seed,
/// [`Domain::Mutation`], trial 0, individual 1, its generation).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::saved::SavedStrategy<OnePlusOneConfig>"))]
pub struct OnePlusOne {
    config: OnePlusOneConfig,
    seed: u64,
    generation: u32,
    /// The individual of the generation before that became the parent, 0 or 1.
    survivor: usize,
    /// The parent's fitness summed over its evaluations so far.
    sum: Fitness,
    /// The number of evaluations of the parent, 0 for the first parent before the first generation is reported.
    evaluations: u32,
    population: Population,
}

impl OnePlusOne {
    /// Creates a new search with a random initial generation.
    ///
    /// # Errors
    /// Returns the errors of [`OnePlusOneConfig::validate`].
    pub fn new(config: OnePlusOneConfig, seed: u64) -> Result<Self, EvoError> {
        config.validate()?;
        let mut parent = vec![0; config.genes];
        let mut stream = Stream::new(seed, Domain::InitialGenome, 0, 0, 0);
        randomize_bits(&mut parent, config.gene_bits, &mut stream);
        let population = pair(&config, seed, 0, &parent)?;
        let sum = Fitness::nan_as_failed(0.0);
        Ok(Self { config, seed, generation: 0, survivor: 0, sum, evaluations: 0, population })
    }

    /// Gets the configuration that this search was created with.
    pub fn config(&self) -> &OnePlusOneConfig {
        &self.config
    }

    /// Gets the seed that this search was created with.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Checks whether the parent of the current generation was the mutant of the previous one.
    pub fn replaced(&self) -> bool {
        self.survivor == 1
    }

    /// Gets the mean fitness of the current parent over its evaluations, and the number of these evaluations. Before
    /// the first generation is reported, this returns `None`.
    pub fn parent_fitness(&self) -> Option<(Fitness, u32)> {
        (self.evaluations > 0).then(|| (mean(self.sum, self.evaluations), self.evaluations))
    }

    /// Computes the two values that the next [`tell`](Strategy::tell) of this fitness \[2\] would compare. They are the
    /// mean over all evaluations of the parent, including the new one, and the fitness of the mutant.
    ///
    /// # Errors
    /// Returns [`EvoError::Shape`].
    pub fn judged(&self, fitness: &[Fitness]) -> Result<[Fitness; 2], EvoError> {
        let &[parent, mutant] = fitness else {
            return Err(EvoError::fitness_count(PARENT_AND_MUTANT, fitness.len()));
        };
        Ok([mean(self.grown(parent), self.evaluations.saturating_add(1)), mutant])
    }

    /// The sum of the parent's fitness with one more evaluation. Infinities of both signs make a failure.
    fn grown(&self, parent: Fitness) -> Fitness {
        Fitness::nan_as_failed(self.sum.get() + parent.get())
    }
}

fn mean(sum: Fitness, evaluations: u32) -> Fitness {
    Fitness::nan_as_failed(sum.get() / f64::from(evaluations))
}

/// A parent and its mutant in a generation.
fn pair(config: &OnePlusOneConfig, seed: u64, generation: u32, parent: &[u16]) -> Result<Population, EvoError> {
    let mut population = Population::new(PARENT_AND_MUTANT, config.genes)?;
    for (individual, genes) in population.iter_mut().enumerate() {
        genes.copy_from_slice(parent);
        if individual > 0 {
            let mut stream = Stream::new(seed, Domain::Mutation, 0, individual as u32, generation);
            config.bit_mutation(generation)?.apply(genes, &mut stream);
        }
    }
    Ok(population)
}

impl Strategy for OnePlusOne {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        let next = next_generation(self.generation, PARENT_AND_MUTANT, fitness)?;
        let [parent, mutant] = self.judged(fitness)?;
        // An equal mutant wins, so the search drifts across plateaus.
        let survivor = usize::from(mutant >= parent);
        // Made before any field changes, because an error must leave the search unchanged.
        let population = pair(&self.config, self.seed, next, self.population.get(survivor).unwrap_or_default())?;
        (self.sum, self.evaluations) = match fitness {
            &[parent, _] if survivor == 0 => (self.grown(parent), self.evaluations.saturating_add(1)),
            _ => (mutant, 1),
        };
        (self.generation, self.survivor, self.population) = (next, survivor, population);
        Ok(())
    }

    fn ranked_by(&self, fitness: &[Fitness]) -> Vec<Fitness> {
        self.judged(fitness).map(Vec::from).unwrap_or_default()
    }

    /// Ties go to the mutant.
    fn champions(&self, ranked_by: &[Fitness]) -> Vec<usize> {
        vec![usize::from(ranked_by.get(1) >= ranked_by.first())]
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn genealogy(&self) -> Option<&dyn Genealogy> {
        Some(self)
    }
}

impl Genealogy for OnePlusOne {
    fn parents_of(&self, individual: usize) -> Vec<usize> {
        let exists = self.generation > 0 && individual < PARENT_AND_MUTANT;
        exists.then_some(self.survivor).into_iter().collect()
    }
}

impl Snapshot for OnePlusOne {
    fn save(&self) -> Vec<u8> {
        let mut state = Vec::new();
        state.extend(self.generation.to_le_bytes());
        state.extend((self.survivor as u32).to_le_bytes());
        state.extend(self.sum.get().to_le_bytes());
        state.extend(self.evaluations.to_le_bytes());
        push_genes(&mut state, &self.population);
        state
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let mut reader = StateReader::new(state, 20 + 2 * self.population.as_slice().len())?;
        let (generation, survivor, sum) = (reader.u32()?, reader.u32()?, reader.fitness()?);
        let evaluations = reader.u32()?;
        if survivor > 1 || (generation == 0 && survivor > 0) {
            return Err(EvoError::state_content("a survivor", survivor.into()));
        }
        // The parent is evaluated once in every generation.
        if evaluations > generation || (evaluations == 0) != (generation == 0) {
            return Err(EvoError::state_content("a number of evaluations", evaluations.into()));
        }
        let mut population = self.population.clone();
        reader.genes(&mut population, largest(self.config.gene_bits))?;
        (self.generation, self.survivor, self.sum, self.evaluations, self.population) =
            (generation, survivor as usize, sum, evaluations, population);
        Ok(())
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for OnePlusOne {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        SavedStrategy::new(self.config, self.seed, self).serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl TryFrom<SavedStrategy<OnePlusOneConfig>> for OnePlusOne {
    type Error = EvoError;

    fn try_from(saved: SavedStrategy<OnePlusOneConfig>) -> Result<Self, EvoError> {
        saved.holds(2, saved.config.genes)?;
        let mut strategy = Self::new(saved.config, saved.seed)?;
        strategy.restore(&saved.state)?;
        Ok(strategy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search() -> OnePlusOne {
        OnePlusOne::new(OnePlusOneConfig::new(14), 9).unwrap()
    }

    fn tell(search: &mut OnePlusOne, parent: f64, mutant: f64) -> bool {
        let told = [parent, mutant].map(Fitness::nan_as_failed);
        let champions = search.champions(&search.ranked_by(&told));
        search.tell(&told).unwrap();
        // The champion stays.
        assert_eq!(champions, [usize::from(search.replaced())]);
        search.replaced()
    }

    #[test]
    fn the_parent_is_judged_by_all_its_evaluations() {
        let mut search = search();
        assert_eq!(search.parent_fitness(), None);
        assert!(!tell(&mut search, 4.0, 3.9));
        // The mean is (4 + 1) / 2: a mutant between it and the last evaluation stays out, an equal one comes in.
        assert!(!tell(&mut search, 1.0, 2.4));
        assert_eq!(search.parent_fitness(), Some((Fitness::nan_as_failed(2.5), 2)));
        assert!(tell(&mut search, 1.0, 2.0));
        // The evaluation as a mutant is the first of the new parent.
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
        assert_eq!(refused(|c| c.genes = 0), EvoError::no_genes());
        assert_eq!(refused(|c| c.genes = usize::MAX), EvoError::too_large(2, usize::MAX));
        assert_eq!(refused(|c| c.gene_bits = 17), EvoError::gene_bits(17));
        assert_eq!(refused(|c| c.first_rate = 1.5), EvoError::rate(1.5));
        assert_eq!(refused(|c| c.rate_step = -0.01), EvoError::rate(-0.01));
        assert!(matches!(refused(|c| c.last_rate = f64::NAN), EvoError::Config { field: "mutation_rate", .. }));
        assert_eq!(refused(|c| c.last_rate = 0.6), EvoError::rising_rate(0.5, 0.6));
    }

    #[test]
    fn a_wrong_number_of_fitness_values_changes_nothing() {
        let mut search = search();
        let before = search.clone();
        for found in [0, 1, 3] {
            let told = alloc::vec![Fitness::WORST; found];
            assert_eq!(search.tell(&told), Err(EvoError::fitness_count(2, found)));
        }
        assert_eq!(search, before);
    }
}
