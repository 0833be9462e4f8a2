//! The generational genetic algorithm over real genes.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::error::{EvoError, check_setting};
use crate::fitness::Fitness;
use crate::population::Population;
use crate::real::bounds::{check_bounds, check_within, draw_within};
use crate::real::crossover::Crossover;
use crate::real::mutation::RealMutation;
use crate::real::selection::{Selection, Selector};
use crate::snapshot::{Snapshot, StateReader, between_states, push_reals};
use crate::strategy::{Genealogy, RecordKind, Strategy, next_generation};

/// The configuration of [`RealGa`](crate::real::RealGa).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RealGaConfig {
    /// The range of each gene, low to high \[genes\], -1e100 to 1e100. Equal ends freeze a gene.
    pub bounds: Vec<[f64; 2]>,
    /// Number of individuals of a generation.
    pub population: usize,
    /// Number of the best that stay unchanged, as the first individuals, 0 to population - 1.
    pub elites: usize,
    /// The selection of parents.
    pub selection: Selection,
    /// The crossover of two parents.
    pub crossover: Crossover,
    /// The probability, 0 to 1, that a child has two parents. No effect for [`Crossover::None`].
    pub crossover_rate: f64,
    /// The mutation of genes.
    pub mutation: RealMutation,
    /// The factor of the mutation rate of each gene \[genes\], 0 to 1e6. Empty for 1 everywhere.
    pub rate_factors: Vec<f64>,
}

impl RealGaConfig {
    /// 100 individuals with one elite and tournaments of two. Simulated binary crossover of index 2 has probability 0.9.
    /// Gaussian mutation changes one gene in a genome by a tenth of its range. The choice is ours.
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

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::Config`] or [`EvoError::OutOfRange`].
    pub fn validate(&self) -> Result<(), EvoError> {
        self.selector().map(|_| ())
    }

    /// The selection, of a configuration of which every number is right.
    pub(crate) fn selector(&self) -> Result<Selector, EvoError> {
        check_bounds(self.population, &self.bounds)?;
        let (elites, factors) = (self.elites, self.rate_factors.len());
        check_setting(elites < self.population, "the number of elites", elites as f64, "0 to population - 1")?;
        self.crossover.check()?;
        let rate = self.crossover_rate;
        check_setting((0.0..=1.0).contains(&rate), "the crossover rate", rate, "0 to 1")?;
        self.mutation.check()?;
        let fits = factors == 0 || factors == self.bounds.len();
        check_setting(fits, "the number of rate factors", factors as f64, "none or one for each gene")?;
        for &factor in &self.rate_factors {
            check_setting((0.0..=1e6).contains(&factor), "a rate factor", factor, "0 to 1e6")?;
        }
        Selector::new(self.selection, self.population)
    }
}

/// A generational genetic algorithm over real genes within bounds: selection, crossover, mutation, elites.
///
/// Individuals are ranked by fitness, equals by index, the lower first, failed ones last. The `elites` best stay unchanged,
/// best first. Every other individual is a child of one parent or two. All are evaluated again in every generation. Genes
/// out of bounds are reflected at them.
///
/// Individual `i` of generation `g` draws from the stream (seed, [`Domain::Mutation`], trial 0, `i`, `g`). The draws are
/// its first parent, the decision for a second, the second, the crossover, its step size and its mutation, gene after gene.
/// Individuals of generation 0 are uniform within the bounds, from (seed, [`Domain::InitialGenome`], trial 0, `i`, 0).
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
#[derive(Clone, Debug, PartialEq)]
pub struct RealGa {
    config: RealGaConfig,
    selector: Selector,
    seed: u64,
    generation: u32,
    /// The first and the second parent of each individual, equal where there is one. Empty in generation 0.
    parents: Vec<[u32; 2]>,
    /// The step size of each individual, as a share of the range.
    steps: Vec<f64>,
    population: Population<f64>,
}

impl RealGa {
    /// A search at its random initial generation.
    ///
    /// # Errors
    /// The errors of [`RealGaConfig::validate`].
    pub fn new(config: RealGaConfig, seed: u64) -> Result<Self, EvoError> {
        let selector = config.selector()?;
        let mut population = Population::new(config.population, config.bounds.len())?;
        for (individual, genes) in population.iter_mut().enumerate() {
            let mut stream = Stream::new(seed, Domain::InitialGenome, 0, individual as u32, 0);
            draw_within(genes, &config.bounds, &mut stream);
        }
        let steps = vec![config.mutation.first_step(); config.population];
        Ok(Self { config, selector, seed, generation: 0, parents: Vec::new(), steps, population })
    }

    /// The configuration.
    pub fn config(&self) -> &RealGaConfig {
        &self.config
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The step size of each individual \[individuals\], as a share of the range.
    pub fn step_sizes(&self) -> &[f64] {
        &self.steps
    }

    /// Makes a child of individuals in this order, best first, and returns its parents and its step size.
    fn make(&self, genes: &mut [f64], order: &[usize], stream: &mut Stream) -> ([u32; 2], f64) {
        let RealGaConfig { crossover, mutation, bounds, rate_factors, .. } = &self.config;
        let select = |stream: &mut Stream| order.get(self.selector.draw(stream)).copied().unwrap_or_default();
        let copy = |genes: &mut [f64], parent: usize| {
            if let Some(from) = self.population.get(parent) {
                genes.copy_from_slice(from);
            }
        };
        let first = select(stream);
        copy(genes, first);
        let mut second = first;
        if *crossover != Crossover::None && stream.uniform_f64() < self.config.crossover_rate {
            second = select(stream);
            if let Some(other) = self.population.get(second) {
                crossover.apply(genes, other, bounds, stream);
            }
        }
        let step = mutation.next_step(self.steps.get(first).copied().unwrap_or_default(), stream);
        mutation.apply(genes, step, bounds, rate_factors, stream);
        ([first as u32, second as u32], step)
    }

    /// Bytes of a state at a generation.
    fn state_length(&self, generation: u32) -> usize {
        let parents = if generation == 0 { 0 } else { 8 * self.population.len() };
        let steps = self.config.mutation.smallest().map_or(0, |_| 8 * self.steps.len());
        4 + parents + steps + 8 * self.population.as_slice().len()
    }
}

impl Strategy<f64> for RealGa {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population<f64> {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        let generation = next_generation(self.generation, self.population.len(), fitness)?;
        let order = Fitness::ranking(fitness);
        let mut population = Population::new(self.population.len(), self.population.genome_len())?;
        let mut parents = Vec::with_capacity(population.len());
        let mut steps = Vec::with_capacity(population.len());
        for (individual, genes) in population.iter_mut().enumerate() {
            let elite = order.get(individual).filter(|_| individual < self.config.elites);
            if let Some((&parent, old)) = elite.and_then(|parent| Some((parent, self.population.get(*parent)?))) {
                genes.copy_from_slice(old);
                parents.push([parent as u32; 2]);
                steps.push(self.steps.get(parent).copied().unwrap_or_default());
            } else {
                let mut stream = Stream::new(self.seed, Domain::Mutation, 0, individual as u32, generation);
                let (own, step) = self.make(genes, &order, &mut stream);
                parents.push(own);
                steps.push(step);
            }
        }
        (self.generation, self.parents, self.steps, self.population) = (generation, parents, steps, population);
        Ok(())
    }

    fn record_kind(&self) -> RecordKind {
        RecordKind::Order
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn genealogy(&self) -> Option<&dyn Genealogy> {
        Some(self)
    }

    /// The mean step size, as a share of the range, of the generation that waits for its fitness.
    fn diagnostics(&self) -> Vec<f64> {
        vec![self.steps.iter().sum::<f64>() / self.steps.len().max(1) as f64]
    }
}

impl Genealogy for RealGa {
    fn parents_of(&self, individual: usize) -> Vec<usize> {
        let mut parents: Vec<usize> =
            self.parents.get(individual).into_iter().flatten().map(|parent| *parent as usize).collect();
        parents.dedup();
        parents
    }
}

impl Snapshot for RealGa {
    fn snapshot_interval(&self) -> u32 {
        between_states(&self.population)
    }

    fn save(&self) -> Vec<u8> {
        let mut state = Vec::with_capacity(self.state_length(self.generation));
        state.extend(self.generation.to_le_bytes());
        state.extend(self.parents.iter().flatten().flat_map(|parent| parent.to_le_bytes()));
        if self.config.mutation.smallest().is_some() {
            push_reals(&mut state, &self.steps);
        }
        push_reals(&mut state, self.population.as_slice());
        state
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let generation = StateReader::new(state, state.len())?.u32()?;
        let mut reader = StateReader::new(state, self.state_length(generation))?;
        reader.u32()?;
        let size = self.population.len();
        let mut parents = Vec::new();
        for _ in 0..if generation == 0 { 0 } else { size } {
            let pair = [reader.u32()?, reader.u32()?];
            if let Some(wrong) = pair.into_iter().find(|parent| *parent as usize >= size) {
                return Err(EvoError::no_such_individual(wrong as usize, size));
            }
            parents.push(pair);
        }
        let mut steps = self.steps.clone();
        if let Some(smallest) = self.config.mutation.smallest() {
            reader.reals(&mut steps)?;
            if let Some(wrong) = steps.iter().find(|step| !(smallest..=1.0).contains(*step)) {
                return Err(EvoError::state_content("a step size", wrong.to_bits()));
            }
        }
        let mut population = Population::new(size, self.population.genome_len())?;
        reader.reals(population.as_mut_slice())?;
        check_within(&population, &self.config.bounds)?;
        (self.generation, self.parents, self.steps, self.population) = (generation, parents, steps, population);
        Ok(())
    }
}
