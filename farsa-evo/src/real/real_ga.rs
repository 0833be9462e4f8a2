//! A generational genetic algorithm over real genes.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Stream;

use crate::error::{EvoError, check_range, check_setting, check_share};
use crate::fitness::Fitness;
use crate::population::Population;
use crate::real::bounds::{check_bounds, check_within, uniform};
use crate::real::crossover::Crossover;
use crate::real::mutation::RealMutation;
use crate::real::selection::{Selection, Selector};
use crate::search::{Algorithm, Search, Step};
use crate::snapshot::{StateReader, between_states, push_indices, push_reals};
use crate::strategy::RecordKind;

/// Configuration of [`RealGa`](crate::real::RealGa).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RealGaConfig {
    /// Range of each gene, from low to high \[genes\], -1e100 to 1e100. You can freeze a gene by giving it equal ends.
    pub bounds: Vec<[f64; 2]>,
    /// Number of individuals in each generation.
    pub population: usize,
    /// Number of the best individuals that stay unchanged, 0 to population - 1. They become the first individuals.
    pub elites: usize,
    /// Method used to select parents.
    pub selection: Selection,
    /// Method used to cross two parents.
    pub crossover: Crossover,
    /// Probability (0 to 1) that a child has two parents. No effect for [`Crossover::None`].
    pub crossover_rate: f64,
    /// The mutation of genes.
    pub mutation: RealMutation,
    /// Factors that multiply the mutation rate of each gene \[genes\], 0 to 1e6. If this is empty, all factors are 1.
    pub rate_factors: Vec<f64>,
}

impl RealGaConfig {
    /// Creates a configuration with 100 individuals, one elite and tournaments of two. Simulated binary crossover of
    /// index 2 has a probability of 0.9. Gaussian mutation changes on average one gene in a genome, by a tenth of its
    /// range. These values are our choice.
    pub fn new(bounds: Vec<[f64; 2]>) -> Self {
        let mutation = RealMutation::Gaussian { rate: 1.0 / bounds.len().max(1) as f64, sigma: 0.1 };
        Self {
            bounds,
            population: 100,
            elites: 1,
            selection: Selection::Tournament { size: 2 },
            crossover: Crossover::SimulatedBinary { eta: 2.0 },
            crossover_rate: 0.9,
            mutation,
            rate_factors: Vec::new(),
        }
    }

    /// Checks the configuration. You usually don't need to call this yourself, since a new search does it as well.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] or [`EvoError::OutOfRange`] for the first setting that is invalid.
    pub fn validate(&self) -> Result<(), EvoError> {
        self.selector().map(|_| ())
    }

    /// The selection, of a configuration of which every number is right.
    pub(crate) fn selector(&self) -> Result<Selector, EvoError> {
        check_bounds(self.population, &self.bounds)?;
        let (elites, factors) = (self.elites, self.rate_factors.len());
        check_setting(elites < self.population, "the number of elites", elites as f64, "0 to population - 1")?;
        self.crossover.check()?;
        check_share("the crossover rate", self.crossover_rate)?;
        self.mutation.check()?;
        let fits = factors == 0 || factors == self.bounds.len();
        check_setting(fits, "the number of rate factors", factors as f64, "none or one for each gene")?;
        for &factor in &self.rate_factors {
            check_range("a rate factor", factor, [0.0, 1e6], "0 to 1e6")?;
        }
        Selector::new(self.selection, self.population)
    }
}

/// A generational genetic algorithm over real genes within bounds: selection, crossover, mutation, elites.
///
/// Individuals are ranked by fitness, and ties are broken by the lower index. Failed individuals come last. The best
/// individuals, as many as `elites`, stay unchanged, best first. Every other individual is a child of one or two
/// parents. Note that all individuals are evaluated again in every generation. If a gene leaves its bounds, it is
/// reflected at them.
///
/// Individual `i` of generation `g` draws from the stream (seed, [`Domain::Mutation`](farsa_num::Domain::Mutation), trial 0, `i`, `g`). The draws are
/// its first parent, the decision for a second, the second, the crossover, its step size and its mutation, gene after gene.
/// Individuals of generation 0 are uniform within the bounds, from (seed, [`Domain::InitialGenome`](farsa_num::Domain::InitialGenome), trial 0, `i`, 0).
///
/// Sources: see [`Selection`](crate::real::Selection), [`Crossover`] and [`RealMutation`](crate::real::RealMutation). Their
/// combination is ours.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::real::{RealGa, RealGaConfig};
///
/// let mut search = RealGa::new(RealGaConfig::new(vec![[-5.0, 5.0]; 3]), 1)?;
/// let champion = search.maximize(100, |genes| -genes.iter().map(|gene| (gene - 1.0) * (gene - 1.0)).sum::<f64>())?;
/// assert!(champion.fitness.get() > -1e-3);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
pub type RealGa = Search<RealGaState>;

/// Internal state of [`RealGa`].
#[derive(Clone, Debug, PartialEq)]
pub struct RealGaState {
    selector: Selector,
    /// The first and the second parent of each individual, equal where there is one. Empty in generation 0.
    parents: Vec<u32>,
    /// The step size of each individual, as a share of the range.
    steps: Vec<f64>,
}

impl RealGa {
    /// Gets the step size of each individual \[individuals\], as a share of the range.
    pub fn step_sizes(&self) -> &[f64] {
        &self.state.steps
    }
}

impl RealGaState {
    /// Makes a child of `old` individuals in this order, best first, and returns its parents and its step size.
    fn make(
        &self,
        config: &RealGaConfig,
        genes: &mut [f64],
        old: &Population<f64>,
        order: &[usize],
        stream: &mut Stream,
    ) -> ([u32; 2], f64) {
        let RealGaConfig { crossover, mutation, bounds, rate_factors, .. } = config;
        let select = |stream: &mut Stream| order.get(self.selector.draw(stream)).copied().unwrap_or_default();
        let first = select(stream);
        genes.copy_from_slice(old.get(first).unwrap_or_default());
        let mut second = first;
        if *crossover != Crossover::None && stream.uniform_f64() < config.crossover_rate {
            second = select(stream);
            crossover.apply(genes, old.get(second).unwrap_or_default(), bounds, stream);
        }
        let step = mutation.next_step(self.steps.get(first).copied().unwrap_or_default(), stream);
        mutation.apply(genes, step, bounds, rate_factors, stream);
        ([first as u32, second as u32], step)
    }
}

impl Algorithm for RealGaState {
    type Gene = f64;
    type Config = RealGaConfig;
    const HAS_PARENTS: bool = true;

    fn start(step: &Step<'_, RealGaConfig>) -> Result<(Self, Population<f64>), EvoError> {
        let RealGaConfig { bounds, population, mutation, .. } = step.config;
        let selector = step.config.selector()?;
        let steps = vec![mutation.first_step(); *population];
        Ok((Self { selector, parents: Vec::new(), steps }, uniform(step, *population, bounds)?))
    }

    fn advance(&mut self, step: &Step<'_, RealGaConfig>, fitness: &[Fitness], genomes: &mut Population<f64>) {
        // Children are written in place of individuals that may still be parents, hence the copy.
        let (order, old) = (Fitness::ranking(fitness), genomes.clone());
        let (mut parents, mut steps) = (Vec::with_capacity(2 * old.len()), Vec::with_capacity(old.len()));
        for (individual, genes) in genomes.iter_mut().enumerate() {
            if let Some(&elite) = order.get(individual).filter(|_| individual < step.config.elites) {
                genes.copy_from_slice(old.get(elite).unwrap_or_default());
                parents.extend([elite as u32; 2]);
                steps.push(self.steps.get(elite).copied().unwrap_or_default());
            } else {
                let (pair, size) = self.make(step.config, genes, &old, &order, &mut step.stream(individual));
                parents.extend(pair);
                steps.push(size);
            }
        }
        (self.parents, self.steps) = (parents, steps);
    }

    fn record_kind(_: &RealGaConfig) -> RecordKind {
        RecordKind::Order
    }

    /// The mean step size, as a share of the range, of the generation that waits for its fitness.
    fn diagnostics(&self, _: &RealGaConfig) -> Vec<f64> {
        vec![self.steps.iter().sum::<f64>() / self.steps.len().max(1) as f64]
    }

    fn parents_of(&self, _: &Step<'_, RealGaConfig>, individual: usize) -> Vec<usize> {
        let pair = self.parents.chunks_exact(2).nth(individual).unwrap_or_default();
        let mut parents: Vec<usize> = pair.iter().map(|parent| *parent as usize).collect();
        parents.dedup();
        parents
    }

    fn snapshot_interval(genomes: &Population<f64>) -> u32 {
        between_states(genomes)
    }

    fn state_length(&self, step: &Step<'_, RealGaConfig>, genes: usize) -> usize {
        let parents = if step.generation == 0 { 0 } else { 8 * step.config.population };
        // Constant step sizes follow from the configuration.
        let steps = step.config.mutation.smallest().map_or(0, |_| 8 * step.config.population);
        parents + steps + 8 * genes
    }

    fn save(&self, config: &RealGaConfig, genomes: &Population<f64>, saved: &mut Vec<u8>) {
        push_indices(saved, &self.parents);
        if config.mutation.smallest().is_some() {
            push_reals(saved, &self.steps);
        }
        push_reals(saved, genomes.as_slice());
    }

    fn restore(
        &mut self,
        step: &Step<'_, RealGaConfig>,
        reader: &mut StateReader<'_>,
        genomes: &mut Population<f64>,
    ) -> Result<(), EvoError> {
        let parents = if step.generation == 0 { 0 } else { 2 * genomes.len() };
        self.parents = reader.individuals(parents, genomes.len())?;
        if let Some(smallest) = step.config.mutation.smallest() {
            reader.row(&mut self.steps, "a step size", [smallest, 1.0])?;
        }
        reader.reals(genomes.as_mut_slice())?;
        check_within(genomes, &step.config.bounds)
    }
}
