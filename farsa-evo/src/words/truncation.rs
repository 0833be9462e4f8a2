//! A genetic algorithm in which the best individuals survive and make mutated copies. The reference experiments use it.

use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
#[cfg(feature = "serde")]
use crate::saved::{SavedMutation, SavedStrategy};
use crate::search::{Algorithm, Search, Step};
#[cfg(feature = "serde")]
use crate::snapshot::Snapshot;
use crate::snapshot::{StateReader, largest, push_genes, push_indices};
use crate::strategy::RecordKind;
use crate::words::mutation::{BitMutation, Mutation, check_gene_bits, randomize_bits};

/// Configuration of [`TruncationGa`](crate::words::TruncationGa).
///
/// Under the feature `serde` the number of bits of a gene is saved only where it is not 16, within the name of the
/// mutation. Configurations from before this option have the same form.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "SavedConfig", into = "SavedConfig"))]
pub struct GaConfig {
    /// Number of genes in each genome.
    pub genes: usize,
    /// Number of bits in a gene, 1 to 16. Genes range from 0 to 2^bits - 1.
    pub gene_bits: u32,
    /// Number of individuals in each generation.
    pub population: usize,
    /// Number of individuals that are selected. Each of them makes population / parents copies.
    pub parents: usize,
    /// Probability, 0 to 1, that mutation hits a bit.
    pub mutation_rate: f64,
    /// Determines what happens to a bit that is hit by mutation.
    pub mutation: Mutation,
}

impl GaConfig {
    /// Creates the configuration of \[Ferrauto2010\] for genomes with this many genes of 16 bits. The best 20 of 100
    /// individuals make five copies each. One copy is unchanged and the other four are mutated with a rate of 1.5 % per
    /// bit, [`Mutation::Resample`].
    pub const fn new(genes: usize) -> Self {
        let (gene_bits, mutation) = (u16::BITS, Mutation::Resample);
        Self { genes, gene_bits, population: 100, parents: 20, mutation_rate: 0.015, mutation }
    }

    /// Checks the configuration. You usually don't need to call this yourself, since a new search does it as well.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`].
    pub fn validate(&self) -> Result<(), EvoError> {
        let Self { genes, population, parents, .. } = *self;
        Population::check(population, genes)?;
        if parents == 0 {
            return Err(EvoError::no_parents());
        }
        if parents > population {
            return Err(EvoError::too_many_parents(population, parents));
        }
        if !population.is_multiple_of(parents) {
            return Err(EvoError::uneven_copies(population, parents));
        }
        check_gene_bits(self.gene_bits)?;
        self.bit_mutation().map(|_| ())
    }

    /// Copies of each parent, for a valid configuration.
    pub(crate) fn copies(&self) -> usize {
        self.population / self.parents
    }

    pub(crate) fn bit_mutation(&self) -> Result<BitMutation, EvoError> {
        BitMutation::new(self.mutation, self.mutation_rate)?.with_gene_bits(self.gene_bits)
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

/// A generational genetic algorithm over integer genes, with truncation selection, elites and bit mutation. There is no
/// crossover, and the size of the population is a multiple of the number of parents.
///
/// In each generation, the `parents` best individuals make `population / parents` copies each. The first copy is
/// unchanged and the others are mutated. Parents are ranked by fitness, with ties broken by the lower index. Failed
/// individuals are only selected if too few others are left. If there are as many parents as individuals, nothing is
/// mutated.
///
/// Child `i` of a generation descends from the parent of rank `i / copies` of the previous generation, where `copies` is
/// population / parents. It is unchanged when `i % copies == 0`. Otherwise it is mutated with the numbers of the stream
/// (seed, [`Domain::Mutation`], trial 0, individual `i`, generation of the child). Individual `i` of generation 0 is drawn
/// from (seed, [`Domain::InitialGenome`], trial 0, `i`, 0).
///
/// Source: \[Ferrauto2010\] chapter 2, truncation selection in the terms of \[Muhlenbein1993\]. Deviations: all individuals
/// are evaluated again in every generation, also the unchanged copies, and ties go to the lower index. The source defines
/// neither.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::words::{GaConfig, TruncationGa};
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
pub type TruncationGa = Search<TruncationState>;

/// Internal state of [`TruncationGa`].
#[derive(Clone, Debug, PartialEq)]
pub struct TruncationState {
    mutation: BitMutation,
    /// The number of the population among those of a search: the trial of its streams.
    number: u32,
    /// The individuals selected from the previous generation, best first \[parents\]. Empty in generation 0.
    selected: Vec<u32>,
}

impl TruncationGa {
    /// Starts the search of one of several populations, by its number.
    pub(crate) fn numbered(config: GaConfig, seed: u64, number: u32) -> Result<Self, EvoError> {
        let (state, population) = TruncationState::numbered(&Step { config: &config, seed, generation: 0 }, number)?;
        Ok(Self { config, seed, generation: 0, state, population })
    }

    /// Gets the individuals that were selected from the previous generation, best first \[parents\]. This is empty in
    /// generation 0.
    pub fn selected(&self) -> &[u32] {
        &self.state.selected
    }
}

impl TruncationState {
    fn numbered(step: &Step<'_, GaConfig>, number: u32) -> Result<(Self, Population), EvoError> {
        let config = step.config;
        config.validate()?;
        let mut population = Population::new(config.population, config.genes)?;
        for (individual, genes) in population.iter_mut().enumerate() {
            let mut stream = Stream::new(step.seed, Domain::InitialGenome, number, individual as u32, 0);
            randomize_bits(genes, config.gene_bits, &mut stream);
        }
        Ok((Self { mutation: config.bit_mutation()?, number, selected: Vec::new() }, population))
    }
}

impl Algorithm for TruncationState {
    type Gene = u16;
    type Config = GaConfig;
    const HAS_PARENTS: bool = true;

    fn start(step: &Step<'_, GaConfig>) -> Result<(Self, Population), EvoError> {
        Self::numbered(step, 0)
    }

    fn advance(&mut self, step: &Step<'_, GaConfig>, fitness: &[Fitness], genomes: &mut Population) {
        let (config, old) = (step.config, genomes.clone());
        self.selected = Fitness::ranking(fitness).iter().take(config.parents).map(|&parent| parent as u32).collect();
        let parents = self.selected.iter().filter_map(|&parent| old.get(parent as usize));
        let heirs = parents.flat_map(|parent| core::iter::repeat_n(parent, config.copies()));
        for (individual, (child, parent)) in genomes.iter_mut().zip(heirs).enumerate() {
            child.copy_from_slice(parent);
            if !individual.is_multiple_of(config.copies()) {
                // `Step::stream` has trial 0, while populations of one search differ in the trial.
                let (trial, individual) = (self.number, individual as u32);
                let mut stream = Stream::new(step.seed, Domain::Mutation, trial, individual, step.generation);
                self.mutation.apply(child, &mut stream);
            }
        }
    }

    fn record_kind(_: &GaConfig) -> RecordKind {
        RecordKind::Order
    }

    fn parents_of(&self, step: &Step<'_, GaConfig>, individual: usize) -> Vec<usize> {
        let parent = self.selected.get(individual / step.config.copies());
        parent.map(|&parent| parent as usize).into_iter().collect()
    }

    fn state_length(&self, step: &Step<'_, GaConfig>, genes: usize) -> usize {
        2 * genes + if step.generation == 0 { 0 } else { 4 * step.config.parents }
    }

    fn save(&self, _: &GaConfig, genomes: &Population, saved: &mut Vec<u8>) {
        push_indices(saved, &self.selected);
        push_genes(saved, genomes);
    }

    fn restore(
        &mut self,
        step: &Step<'_, GaConfig>,
        reader: &mut StateReader<'_>,
        genomes: &mut Population,
    ) -> Result<(), EvoError> {
        let parents = if step.generation == 0 { 0 } else { step.config.parents };
        self.selected = reader.individuals(parents, genomes.len())?;
        // A ranking contains each individual once.
        let mut sorted = self.selected.clone();
        sorted.sort_unstable();
        if let Some(twice) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(EvoError::selected_twice(twice[0] as usize));
        }
        reader.genes(genomes, largest(step.config.gene_bits))
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for TruncationGa {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        SavedStrategy::new(self.config, self.seed, self).serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for TruncationGa {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let saved = SavedStrategy::<GaConfig>::deserialize(deserializer)?;
        Self::try_from(saved).map_err(serde::de::Error::custom)
    }
}

#[cfg(feature = "serde")]
impl TryFrom<SavedStrategy<GaConfig>> for TruncationGa {
    type Error = EvoError;

    fn try_from(saved: SavedStrategy<GaConfig>) -> Result<Self, EvoError> {
        saved.holds(saved.config.population, saved.config.genes)?;
        let mut strategy = Self::new(saved.config, saved.seed)?;
        strategy.restore(&saved.state)?;
        Ok(strategy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strategy::Strategy;

    fn refused(change: impl FnOnce(&mut GaConfig)) -> EvoError {
        let mut config = GaConfig::new(10);
        change(&mut config);
        TruncationGa::new(config, 0).unwrap_err()
    }

    #[test]
    fn impossible_configurations_are_refused() {
        assert_eq!(refused(|c| c.genes = 0), EvoError::no_genes());
        assert_eq!(refused(|c| c.population = 0), EvoError::no_individuals());
        assert_eq!(refused(|c| c.parents = 0), EvoError::no_parents());
        assert_eq!(refused(|c| c.parents = 101), EvoError::too_many_parents(100, 101));
        assert_eq!(refused(|c| c.parents = 30), EvoError::uneven_copies(100, 30));
        assert_eq!(refused(|c| c.mutation_rate = 1.5), EvoError::rate(1.5));
        assert!(matches!(refused(|c| c.mutation_rate = f64::NAN), EvoError::Config { field: "mutation_rate", .. }));
        assert_eq!(refused(|c| c.genes = usize::MAX), EvoError::too_large(100, usize::MAX));
    }

    #[test]
    fn a_wrong_number_of_fitness_values_changes_nothing() {
        let mut ga = TruncationGa::new(GaConfig::new(10), 0).unwrap();
        let before = ga.clone();
        for found in [0, 99, 101] {
            let told = alloc::vec![Fitness::WORST; found];
            assert_eq!(ga.tell(&told), Err(EvoError::fitness_count(100, found)));
        }
        assert_eq!(ga, before);
    }
}
