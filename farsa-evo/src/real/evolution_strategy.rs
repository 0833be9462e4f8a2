//! Evolution strategies with step sizes that adapt themselves.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Domain, Stream, exp};

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
use crate::real::evolution_strategy_config::{EvolutionStrategyConfig, LARGEST, Recombination, StepSizes, Survival};
use crate::snapshot::{Snapshot, StateReader, between_states, push_reals};
use crate::strategy::{Genealogy, RecordKind, Strategy, next_generation};

/// The largest size that a gene can have: some 2^32 steps of the largest kind.
const FARTHEST: f64 = 1e120;

/// A (mu/rho + lambda) or (mu/rho, lambda) evolution strategy over unbounded real genes, with step sizes that are
/// inherited, mixed and mutated as the genes are.
///
/// Every child draws rho different parents of the mu best and recombines their step sizes and genes. It multiplies its step
/// sizes by e^(tau N), and then adds normal numbers of these standard deviations to its genes. Individuals are ranked by
/// fitness, equals by index (parents before offspring), failed ones last.
///
/// Child `i` of the offspring of generation `g` draws from the stream (seed, [`Domain::Mutation`], trial 0, `i`, `g`). The
/// draws are its parents (as swaps in a list) and, for discrete recombination, the parents of its step sizes and genes. A
/// row of normal numbers follows: the common one of all step sizes, one for each of several step sizes, one for each gene.
/// Individuals of generation 0 are normal around the mean with the first step size, from (seed, [`Domain::InitialGenome`],
/// trial 0, `i`, 0).
///
/// Source: \[Beyer2002\]. Deviations: generation 0 has as many individuals as every other, and its mu best are the first
/// parents, so mu is at most lambda. Step sizes stay between a smallest one and 1e100.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::real::{EvolutionStrategy, EvolutionStrategyConfig};
///
/// let mut search = EvolutionStrategy::new(EvolutionStrategyConfig::new(vec![0.0; 3], 1.0), 1)?;
/// let champion = search.maximize(100, |genes| -genes.iter().map(|gene| (gene - 1.0) * (gene - 1.0)).sum::<f64>())?;
/// assert!(champion.fitness.get() > -1e-9);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct EvolutionStrategy {
    config: EvolutionStrategyConfig,
    seed: u64,
    generation: u32,
    /// The selected individuals, best first \[mu\]. Empty in generation 0.
    parents: Vec<Individual>,
    /// The step sizes of those that wait for their fitness [individuals x step sizes].
    steps: Vec<f64>,
    population: Population<f64>,
}

/// A selected individual.
#[derive(Clone, Debug, PartialEq)]
struct Individual {
    genes: Vec<f64>,
    steps: Vec<f64>,
    /// The fitness of its selection where it is kept, else the worst.
    fitness: Fitness,
    /// Its index in the generation of its selection, `None` for a parent that was not evaluated in it.
    origin: Option<u32>,
}

impl EvolutionStrategy {
    /// A search at its random initial generation.
    ///
    /// # Errors
    /// The errors of [`EvolutionStrategyConfig::validate`].
    pub fn new(config: EvolutionStrategyConfig, seed: u64) -> Result<Self, EvoError> {
        config.validate()?;
        let genes = config.mean.len();
        let mut population = Population::new(config.asked(), genes)?;
        for (individual, row) in population.iter_mut().enumerate() {
            Stream::new(seed, Domain::InitialGenome, 0, individual as u32, 0).fill_normal(row);
            for (gene, mean) in row.iter_mut().zip(&config.mean) {
                *gene = mean + config.initial_step * *gene;
            }
        }
        let steps = vec![config.initial_step; config.asked() * config.step_sizes.count(genes)];
        Ok(Self { config, seed, generation: 0, parents: Vec::new(), steps, population })
    }

    /// The configuration.
    pub fn config(&self) -> &EvolutionStrategyConfig {
        &self.config
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The step sizes of the individuals that wait for their fitness [individuals x (1 or genes)], in the unit of the
    /// genes.
    pub fn step_sizes(&self) -> &[f64] {
        &self.steps
    }

    /// The fitness that the current parents keep, best first \[mu\]. Empty in generation 0 and without [`Survival::Plus`].
    pub fn parent_fitness(&self) -> Vec<Fitness> {
        let kept = if self.config.survival == Survival::Plus { self.parents.as_slice() } else { &[] };
        kept.iter().map(|parent| parent.fitness).collect()
    }

    /// Step sizes of an individual.
    fn width(&self) -> usize {
        self.config.step_sizes.count(self.config.mean.len())
    }

    fn stream(&self, child: usize, generation: u32) -> Stream {
        Stream::new(self.seed, Domain::Mutation, 0, child as u32, generation)
    }

    /// The mu best of those that are selected from.
    fn select(&self, fitness: &[Fitness]) -> Vec<Individual> {
        let plus = self.config.survival == Survival::Plus;
        let kept: &[Individual] = if plus { &self.parents } else { &[] };
        let all: Vec<Fitness> = kept.iter().map(|parent| parent.fitness).chain(fitness.iter().copied()).collect();
        let asked = |index: usize| Individual {
            genes: self.population.get(index).unwrap_or_default().to_vec(),
            steps: self.steps.chunks_exact(self.width()).nth(index).unwrap_or_default().to_vec(),
            fitness: fitness.get(index).copied().filter(|_| plus).unwrap_or(Fitness::WORST),
            origin: Some(index as u32),
        };
        let individual = |index: usize| match kept.get(index) {
            Some(parent) => Individual { origin: None, ..parent.clone() },
            None => asked(index - kept.len()),
        };
        Fitness::ranking(&all).into_iter().take(self.config.parents).map(individual).collect()
    }

    /// The parents of a child, as indices of the parents.
    fn draw_parents(&self, stream: &mut Stream) -> Vec<usize> {
        let mut indices: Vec<usize> = (0..self.config.parents).collect();
        let rho = self.config.parents_of_one();
        for slot in 0..rho {
            let rest = (indices.len() - slot) as u32;
            indices.swap(slot, slot + stream.below(rest) as usize);
        }
        indices.truncate(rho);
        indices
    }

    /// Makes a child of these parents.
    fn make(&self, parents: &[Individual], genes: &mut [f64], steps: &mut [f64], stream: &mut Stream) {
        let config = &self.config;
        let drawn = self.draw_parents(stream);
        let chosen: Vec<&Individual> = drawn.into_iter().filter_map(|parent| parents.get(parent)).collect();
        recombine(config.step_recombination, &chosen, |parent| &parent.steps, steps, stream);
        recombine(config.recombination, &chosen, |parent| &parent.genes, genes, stream);
        let own = if matches!(config.step_sizes, StepSizes::One { .. }) { 0 } else { steps.len() };
        let mut normal = vec![0.0; 1 + own + genes.len()];
        stream.fill_normal(&mut normal);
        let (of_steps, of_genes) = normal.split_at(1 + own);
        let common = of_steps.first().copied().unwrap_or_default();
        for (index, step) in steps.iter_mut().enumerate() {
            let power = match config.step_sizes {
                StepSizes::One { tau } => tau * common,
                StepSizes::PerGene { tau_0, tau } => {
                    tau_0 * common + tau * of_steps.get(1 + index).copied().unwrap_or_default()
                }
            };
            *step = (*step * exp(power)).clamp(config.smallest_step, LARGEST);
        }
        for ((gene, normal), step) in genes.iter_mut().zip(of_genes).zip(steps.iter().cycle()) {
            *gene = (*gene + step * normal).clamp(-FARTHEST, FARTHEST);
        }
    }

    /// Bytes of a state at a generation.
    fn state_length(&self, generation: u32) -> usize {
        let row = 8 * (self.config.mean.len() + self.width());
        let parents = if generation == 0 { 0 } else { self.config.parents };
        4 + parents * (12 + row) + self.config.asked() * row
    }
}

/// Mixes a row of each parent.
fn recombine(
    how: Recombination,
    parents: &[&Individual],
    row_of: impl Fn(&Individual) -> &[f64],
    row: &mut [f64],
    stream: &mut Stream,
) {
    let of = |parent: usize, index: usize| {
        parents.get(parent).and_then(|parent| row_of(parent).get(index)).copied().unwrap_or_default()
    };
    for (index, x) in row.iter_mut().enumerate() {
        *x = match how {
            Recombination::None => of(0, index),
            Recombination::Discrete => of(stream.below(parents.len() as u32) as usize, index),
            Recombination::Intermediate => {
                (0..parents.len()).map(|parent| of(parent, index)).sum::<f64>() / parents.len().max(1) as f64
            }
        };
    }
}

impl Strategy<f64> for EvolutionStrategy {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population<f64> {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        let generation = next_generation(self.generation, self.population.len(), fitness)?;
        let parents = self.select(fitness);
        let again = self.config.asked_parents();
        let mut population = Population::new(self.population.len(), self.population.genome_len())?;
        let mut steps = vec![0.0; self.steps.len()];
        let rows = population.iter_mut().zip(steps.chunks_exact_mut(self.width()));
        for (individual, (genes, steps)) in rows.enumerate() {
            if let Some(parent) = parents.get(individual).filter(|_| individual < again) {
                genes.copy_from_slice(&parent.genes);
                steps.copy_from_slice(&parent.steps);
            } else {
                self.make(&parents, genes, steps, &mut self.stream(individual - again, generation));
            }
        }
        (self.generation, self.parents, self.steps, self.population) = (generation, parents, steps, population);
        Ok(())
    }

    fn record_kind(&self) -> RecordKind {
        // Where parents keep their fitness it is compared with that of another generation.
        if self.config.survival == Survival::Plus { RecordKind::Values } else { RecordKind::Order }
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn genealogy(&self) -> Option<&dyn Genealogy> {
        Some(self)
    }

    /// The mean step size of the parents, in generation 0 the first step size.
    fn diagnostics(&self) -> Vec<f64> {
        let steps = || self.parents.iter().flat_map(|parent| &parent.steps);
        let mean = steps().sum::<f64>() / steps().count().max(1) as f64;
        vec![if self.parents.is_empty() { self.config.initial_step } else { mean }]
    }
}

/// Parents that were not evaluated in the generation before, as those of (mu + lambda) need not be, are left out.
impl Genealogy for EvolutionStrategy {
    fn parents_of(&self, individual: usize) -> Vec<usize> {
        if self.generation == 0 || individual >= self.population.len() {
            return Vec::new();
        }
        let mut parents = match individual.checked_sub(self.config.asked_parents()) {
            None => vec![individual],
            Some(child) => self.draw_parents(&mut self.stream(child, self.generation)),
        };
        parents.sort_unstable();
        parents.iter().filter_map(|parent| self.parents.get(*parent)?.origin).map(|origin| origin as usize).collect()
    }
}

impl Snapshot for EvolutionStrategy {
    fn snapshot_interval(&self) -> u32 {
        between_states(&self.population)
    }

    fn save(&self) -> Vec<u8> {
        let mut state = Vec::with_capacity(self.state_length(self.generation));
        state.extend(self.generation.to_le_bytes());
        for parent in &self.parents {
            state.extend(parent.origin.unwrap_or(u32::MAX).to_le_bytes());
            state.extend(parent.fitness.get().to_le_bytes());
            push_reals(&mut state, &parent.steps);
            push_reals(&mut state, &parent.genes);
        }
        push_reals(&mut state, &self.steps);
        push_reals(&mut state, self.population.as_slice());
        state
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let generation = StateReader::new(state, state.len())?.u32()?;
        let mut reader = StateReader::new(state, self.state_length(generation))?;
        reader.u32()?;
        let (size, genes, width) = (self.population.len(), self.config.mean.len(), self.width());
        let mut parents = Vec::new();
        for _ in 0..if generation == 0 { 0 } else { self.config.parents } {
            let origin = Some(reader.u32()?).filter(|origin| *origin != u32::MAX);
            if let Some(individual) = origin.map(|origin| origin as usize).filter(|origin| *origin >= size) {
                return Err(EvoError::no_such_individual(individual, size));
            }
            let fitness = reader.fitness()?;
            let mut parent = Individual { genes: vec![0.0; genes], steps: vec![0.0; width], fitness, origin };
            self.read_rows(&mut reader, &mut parent.steps, &mut parent.genes)?;
            parents.push(parent);
        }
        let mut steps = vec![0.0; self.steps.len()];
        let mut population = Population::new(size, genes)?;
        self.read_rows(&mut reader, &mut steps, population.as_mut_slice())?;
        (self.generation, self.parents, self.steps, self.population) = (generation, parents, steps, population);
        Ok(())
    }
}

impl EvolutionStrategy {
    /// Reads step sizes and genes that are possible.
    fn read_rows(&self, reader: &mut StateReader, steps: &mut [f64], genes: &mut [f64]) -> Result<(), EvoError> {
        reader.reals(steps)?;
        reader.reals(genes)?;
        let wrong = |what, found: &f64| Err(EvoError::state_content(what, found.to_bits()));
        if let Some(step) = steps.iter().find(|step| !(self.config.smallest_step..=LARGEST).contains(*step)) {
            return wrong("a step size", step);
        }
        match genes.iter().find(|gene| gene.abs() > FARTHEST) {
            Some(gene) => wrong("a gene of -1e120 to 1e120", gene),
            None => Ok(()),
        }
    }
}
