//! Evolution strategies with step sizes that adapt themselves.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Scalar, Stream, exp, ln};

use crate::error::{EvoError, check_range, check_setting};
use crate::fitness::Fitness;
use crate::population::Population;
use crate::search::{Algorithm, Search, Step};
use crate::snapshot::{StateReader, between_states, push_reals};
use crate::strategy::RecordKind;

/// The largest size of a gene or a step size of a configuration. Genes grow no further than by steps of this size.
const LARGEST: f64 = 1e100;

/// Determines which individuals the next parents are selected from, \[Beyer2002\].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Survival {
    /// (mu, lambda) selection, in which only the offspring can be selected.
    Comma,
    /// (mu + lambda) selection from parents and offspring. Parents keep their fitness and are not evaluated again.
    Plus,
    /// (mu + lambda) selection in which the parents are evaluated again in every generation. This is useful if fitness
    /// is noisy.
    PlusEvaluatedAgain,
}

/// Method used to recombine the genes or the step sizes of rho parents, \[Beyer2002\].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Recombination {
    /// No recombination. All values are copied from the first parent that was drawn.
    None,
    /// Each gene is the mean over all rho parents. A step size is their geometric mean, which leaves its logarithm
    /// unbiased where nothing is selected, \[Hansen2006\].
    Intermediate,
    /// Each value is copied from one of the rho parents, which is drawn separately for every value.
    Discrete,
}

/// Number of step sizes that an individual has, and their learning rates, \[Beyer2002\].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum StepSizes {
    /// A single step size for all genes, `sigma e^(tau N)`.
    One {
        /// Learning rate tau, 0 to 10.
        tau: f64,
    },
    /// A separate step size for each gene, `sigma_i e^(tau_0 N) e^(tau N_i)`.
    PerGene {
        /// Learning rate `tau_0` of the factor that all step sizes share, 0 to 10.
        tau_0: f64,
        /// Learning rate tau of each step size, 0 to 10.
        tau: f64,
    },
}

impl StepSizes {
    /// Creates a single step size with the recommended learning rate for n genes, tau = 1 / sqrt(n).
    pub fn one(genes: usize) -> Self {
        Self::One { tau: 1.0 / Scalar::sqrt(genes.max(1) as f64) }
    }

    /// Creates a step size for each gene. For n genes, the learning rates are `tau_0` = 1 / sqrt(2 n) and tau = 1 /
    /// sqrt(2 sqrt(n)).
    pub fn per_gene(genes: usize) -> Self {
        let n = genes.max(1) as f64;
        Self::PerGene { tau_0: 1.0 / Scalar::sqrt(2.0 * n), tau: 1.0 / Scalar::sqrt(2.0 * Scalar::sqrt(n)) }
    }

    /// Step sizes of an individual with the given number of genes.
    fn count(self, genes: usize) -> usize {
        match self {
            Self::One { .. } => 1,
            Self::PerGene { .. } => genes,
        }
    }
}

/// Configuration of [`EvolutionStrategy`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EvolutionStrategyConfig {
    /// Point from which the search starts \[genes\], within -1e100 to 1e100.
    pub mean: Vec<f64>,
    /// Initial step size sigma, in the unit of the genes. It must be between `smallest_step` and 1e100.
    pub initial_step: f64,
    /// Number of parents mu, from 1 to the number of offspring.
    pub parents: usize,
    /// Number of offspring lambda in each generation.
    pub offspring: usize,
    /// Mixing number rho, which is the number of different parents of a child, 1 to mu. This has no effect without
    /// recombination.
    pub mixing: usize,
    /// Determines which individuals the next parents are selected from.
    pub survival: Survival,
    /// Method used to recombine genes.
    pub recombination: Recombination,
    /// Method used to recombine step sizes.
    pub step_recombination: Recombination,
    /// Number and learning rates of step sizes.
    pub step_sizes: StepSizes,
    /// Lower limit of all step sizes, in the unit of the genes, 1e-100 to 1e100.
    pub smallest_step: f64,
    /// Upper limit of all step sizes, in the unit of the genes, `initial_step` to 1e100. If genes have a range, use its
    /// width.
    pub largest_step: f64,
}

impl EvolutionStrategyConfig {
    /// Creates a (15/15, 100) strategy that starts around `mean` \[genes\] with the given step size. It has a step size
    /// for each gene and uses intermediate recombination for genes and step sizes. Its learning rates are those of
    /// \[Beyer2002\]. While (15, 100) is the classical choice of its authors, the smallest step of 1e-12 is ours. The
    /// largest step is 10^4 times the first, beyond which \[Hansen2016\] calls a search divergent.
    pub fn new(mean: Vec<f64>, initial_step: f64) -> Self {
        let step_sizes = StepSizes::per_gene(mean.len());
        Self {
            mean,
            initial_step,
            parents: 15,
            offspring: 100,
            mixing: 15,
            survival: Survival::Comma,
            recombination: Recombination::Intermediate,
            step_recombination: Recombination::Intermediate,
            step_sizes,
            smallest_step: 1e-12,
            largest_step: (1e4 * initial_step).min(LARGEST),
        }
    }

    /// Checks that all settings are within their allowed ranges.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] or [`EvoError::OutOfRange`] for the first setting that is invalid.
    pub fn validate(&self) -> Result<(), EvoError> {
        let Self { parents, offspring, mixing, initial_step, smallest_step, largest_step, .. } = *self;
        Population::check(offspring, self.mean.len())?;
        if parents == 0 {
            return Err(EvoError::no_parents());
        }
        check_setting(parents <= offspring, "the number of parents", parents as f64, "1 to the number of offspring")?;
        Population::check(self.asked(), self.mean.len())?;
        let mixed = (1..=parents).contains(&mixing);
        check_setting(mixed, "the mixing number", mixing as f64, "1 to the number of parents")?;
        for &x in &self.mean {
            check_range("a mean", x, [-LARGEST, LARGEST], "-1e100 to 1e100")?;
        }
        let steps = 1e-100..=LARGEST;
        check_setting(steps.contains(&smallest_step), "the smallest step size", smallest_step, "1e-100 to 1e100")?;
        check_range("the first step size", initial_step, [smallest_step, LARGEST], "the smallest to 1e100")?;
        check_range("the largest step size", largest_step, [initial_step, LARGEST], "the first to 1e100")?;
        let rate = |name, tau| check_range(name, tau, [0.0, 10.0], "0 to 10");
        match self.step_sizes {
            StepSizes::One { tau } => rate("tau", tau),
            StepSizes::PerGene { tau_0, tau } => rate("tau_0", tau_0).and_then(|()| rate("tau", tau)),
        }
    }

    /// Individuals of a generation that are evaluated.
    fn asked(&self) -> usize {
        match self.survival {
            Survival::Comma | Survival::Plus => self.offspring,
            Survival::PlusEvaluatedAgain => self.parents.saturating_add(self.offspring),
        }
    }

    /// Number of evaluated individuals that are parents, from generation 1 on.
    fn asked_parents(&self) -> usize {
        self.asked() - self.offspring
    }

    /// Parents of a child.
    fn parents_of_one(&self) -> usize {
        let alone = [self.recombination, self.step_recombination] == [Recombination::None; 2];
        if alone { 1 } else { self.mixing }
    }
}

/// The largest size that a gene can have: some 2^32 steps of the largest kind.
const FARTHEST: f64 = 1e120;

/// A (mu/rho + lambda) or (mu/rho, lambda) evolution strategy over unbounded real genes, with step sizes that are
/// inherited, mixed and mutated as the genes are.
///
/// Every child draws rho different parents of the mu best and recombines their step sizes and genes. It multiplies its step
/// sizes by e^(tau N), and then adds normal numbers of these standard deviations to its genes. Individuals are ranked by
/// fitness, equals by index (parents before offspring), failed ones last.
///
/// Child `i` of the offspring of generation `g` draws from the stream (seed, [`Domain::Mutation`](farsa_num::Domain::Mutation), trial 0, `i`, `g`). The
/// draws are its parents (as swaps in a list) and, for discrete recombination, the parents of its step sizes and genes. A
/// row of normal numbers follows: the common one of all step sizes, one for each of several step sizes, one for each gene.
/// Individuals of generation 0 are normal around the mean with the first step size, from (seed, [`Domain::InitialGenome`](farsa_num::Domain::InitialGenome),
/// trial 0, `i`, 0).
///
/// Source: \[Beyer2002\]. Deviations: generation 0 has as many individuals as every other, and its mu best are the first
/// parents, so mu is at most lambda. Step sizes stay between a smallest and a largest one, and their mean is geometric:
/// the arithmetic mean of the source grows them without selection, \[Hansen2006\].
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
pub type EvolutionStrategy = Search<EvolutionStrategyState>;

/// Internal state of [`EvolutionStrategy`].
#[derive(Clone, Debug, PartialEq)]
pub struct EvolutionStrategyState {
    /// The selected individuals, best first \[mu\]. Empty in generation 0.
    parents: Vec<Individual>,
    /// The step sizes of those that wait for their fitness [individuals x step sizes].
    steps: Vec<f64>,
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
    /// Gets the step sizes of the individuals that are waiting for their fitness [individuals x (1 or genes)]. They are
    /// in the unit of the genes.
    pub fn step_sizes(&self) -> &[f64] {
        &self.state.steps
    }

    /// Fitness of the current parents, best first \[mu\]. This is empty in generation 0, and always empty without
    /// [`Survival::Plus`].
    pub fn parent_fitness(&self) -> Vec<Fitness> {
        self.state.kept(&self.config).iter().map(|parent| parent.fitness).collect()
    }
}

impl EvolutionStrategyConfig {
    /// Step sizes of an individual.
    fn width(&self) -> usize {
        self.step_sizes.count(self.mean.len())
    }

    /// The parents of a child, as indices of the parents.
    fn draw_parents(&self, stream: &mut Stream) -> Vec<usize> {
        let mut indices: Vec<usize> = (0..self.parents).collect();
        let rho = self.parents_of_one();
        // The first rho places of a Fisher-Yates shuffle: all parents differ.
        for slot in 0..rho {
            let rest = (indices.len() - slot) as u32;
            indices.swap(slot, slot + stream.below(rest) as usize);
        }
        indices.truncate(rho);
        indices
    }

    /// True if step sizes are recombined by their logarithms.
    fn mixes_logarithms(&self) -> bool {
        self.step_recombination == Recombination::Intermediate
    }

    /// The parents with the numbers that step sizes are recombined by.
    fn recombined(&self, parents: &[Individual]) -> Vec<Individual> {
        let mut parents = parents.to_vec();
        if self.mixes_logarithms() {
            parents.iter_mut().flat_map(|parent| &mut parent.steps).for_each(|step| *step = ln(*step));
        }
        parents
    }

    /// Makes a child of [recombined](Self::recombined) parents.
    fn make(&self, parents: &[Individual], genes: &mut [f64], steps: &mut [f64], stream: &mut Stream) {
        let drawn = self.draw_parents(stream);
        let chosen: Vec<&Individual> = drawn.into_iter().filter_map(|parent| parents.get(parent)).collect();
        recombine(self.step_recombination, &chosen, |parent| &parent.steps, steps, stream);
        recombine(self.recombination, &chosen, |parent| &parent.genes, genes, stream);
        let own = if matches!(self.step_sizes, StepSizes::One { .. }) { 0 } else { steps.len() };
        let mut normal = vec![0.0; 1 + own + genes.len()];
        stream.fill_normal(&mut normal);
        let (of_steps, of_genes) = normal.split_at(1 + own);
        // sigma_i <- sigma_i e^(tau_0 N_0 + tau N_i), then x_i <- x_i + sigma_i N. In this order selection judges a
        // step size by the step that it made. [Beyer2002].
        let common = of_steps.first().copied().unwrap_or_default();
        for (index, step) in steps.iter_mut().enumerate() {
            let power = match self.step_sizes {
                StepSizes::One { tau } => tau * common,
                StepSizes::PerGene { tau_0, tau } => {
                    tau_0 * common + tau * of_steps.get(1 + index).copied().unwrap_or_default()
                }
            };
            let mutated = if self.mixes_logarithms() { exp(*step + power) } else { *step * exp(power) };
            *step = mutated.clamp(self.smallest_step, self.largest_step);
        }
        // A single step size repeats for all genes.
        for ((gene, normal), step) in genes.iter_mut().zip(of_genes).zip(steps.iter().cycle()) {
            *gene = (*gene + step * normal).clamp(-FARTHEST, FARTHEST);
        }
    }

    /// Reads step sizes and genes that are possible.
    fn read_rows(&self, reader: &mut StateReader<'_>, steps: &mut [f64], genes: &mut [f64]) -> Result<(), EvoError> {
        reader.row(steps, "a step size", [self.smallest_step, self.largest_step])?;
        reader.row(genes, "a gene of -1e120 to 1e120", [-FARTHEST, FARTHEST])
    }
}

impl EvolutionStrategyState {
    /// The parents that keep their fitness.
    fn kept(&self, config: &EvolutionStrategyConfig) -> &[Individual] {
        if config.survival == Survival::Plus { &self.parents } else { &[] }
    }

    /// The mu best of those that are selected from.
    fn select(
        &self,
        config: &EvolutionStrategyConfig,
        fitness: &[Fitness],
        genomes: &Population<f64>,
    ) -> Vec<Individual> {
        let (plus, kept) = (config.survival == Survival::Plus, self.kept(config));
        // Parents come first, so they win ties with offspring.
        let all: Vec<Fitness> = kept.iter().map(|parent| parent.fitness).chain(fitness.iter().copied()).collect();
        let asked = |index: usize| Individual {
            genes: genomes.get(index).unwrap_or_default().to_vec(),
            steps: self.steps.chunks_exact(config.width()).nth(index).unwrap_or_default().to_vec(),
            fitness: fitness.get(index).copied().filter(|_| plus).unwrap_or(Fitness::WORST),
            origin: Some(index as u32),
        };
        let individual = |index: usize| match kept.get(index) {
            Some(parent) => Individual { origin: None, ..parent.clone() },
            None => asked(index - kept.len()),
        };
        Fitness::ranking(&all).into_iter().take(config.parents).map(individual).collect()
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

impl Algorithm for EvolutionStrategyState {
    type Gene = f64;
    type Config = EvolutionStrategyConfig;
    const HAS_PARENTS: bool = true;

    fn start(step: &Step<'_, EvolutionStrategyConfig>) -> Result<(Self, Population<f64>), EvoError> {
        let config = step.config;
        config.validate()?;
        let mut population = Population::new(config.asked(), config.mean.len())?;
        for (individual, row) in population.iter_mut().enumerate() {
            step.stream(individual).fill_normal(row);
            for (gene, mean) in row.iter_mut().zip(&config.mean) {
                *gene = mean + config.initial_step * *gene;
            }
        }
        let steps = vec![config.initial_step; config.asked() * config.width()];
        Ok((Self { parents: Vec::new(), steps }, population))
    }

    fn advance(
        &mut self,
        step: &Step<'_, EvolutionStrategyConfig>,
        fitness: &[Fitness],
        genomes: &mut Population<f64>,
    ) {
        let config = step.config;
        let (parents, again) = (self.select(config, fitness, genomes), config.asked_parents());
        let recombined = config.recombined(&parents);
        let rows = genomes.iter_mut().zip(self.steps.chunks_exact_mut(config.width()));
        for (individual, (genes, steps)) in rows.enumerate() {
            if let Some(parent) = parents.get(individual).filter(|_| individual < again) {
                genes.copy_from_slice(&parent.genes);
                steps.copy_from_slice(&parent.steps);
            } else {
                config.make(&recombined, genes, steps, &mut step.stream(individual - again));
            }
        }
        self.parents = parents;
    }

    fn record_kind(config: &EvolutionStrategyConfig) -> RecordKind {
        // Where parents keep their fitness it is compared with that of another generation.
        if config.survival == Survival::Plus { RecordKind::Values } else { RecordKind::Order }
    }

    /// The mean step size of the parents, in generation 0 the first step size.
    fn diagnostics(&self, config: &EvolutionStrategyConfig) -> Vec<f64> {
        let steps = || self.parents.iter().flat_map(|parent| &parent.steps);
        let mean = steps().sum::<f64>() / steps().count().max(1) as f64;
        vec![if self.parents.is_empty() { config.initial_step } else { mean }]
    }

    /// Parents that were not evaluated in the generation before, as those of (mu + lambda) need not be, are left out.
    fn parents_of(&self, step: &Step<'_, EvolutionStrategyConfig>, individual: usize) -> Vec<usize> {
        if step.generation == 0 || individual >= step.config.asked() {
            return Vec::new();
        }
        let mut parents = match individual.checked_sub(step.config.asked_parents()) {
            None => vec![individual],
            // Parents are a stream's first draws, so drawing again replaces storing them.
            Some(child) => step.config.draw_parents(&mut step.stream(child)),
        };
        parents.sort_unstable();
        parents.iter().filter_map(|parent| self.parents.get(*parent)?.origin).map(|origin| origin as usize).collect()
    }

    fn snapshot_interval(genomes: &Population<f64>) -> u32 {
        between_states(genomes)
    }

    fn state_length(&self, step: &Step<'_, EvolutionStrategyConfig>, _: usize) -> usize {
        let row = 8 * (step.config.mean.len() + step.config.width());
        let parents = if step.generation == 0 { 0 } else { step.config.parents };
        parents * (12 + row) + step.config.asked() * row
    }

    fn save(&self, _: &EvolutionStrategyConfig, genomes: &Population<f64>, saved: &mut Vec<u8>) {
        for parent in &self.parents {
            saved.extend(parent.origin.unwrap_or(u32::MAX).to_le_bytes());
            saved.extend(parent.fitness.get().to_le_bytes());
            push_reals(saved, &parent.steps);
            push_reals(saved, &parent.genes);
        }
        push_reals(saved, &self.steps);
        push_reals(saved, genomes.as_slice());
    }

    fn restore(
        &mut self,
        step: &Step<'_, EvolutionStrategyConfig>,
        reader: &mut StateReader<'_>,
        genomes: &mut Population<f64>,
    ) -> Result<(), EvoError> {
        let (config, size) = (step.config, genomes.len());
        self.parents.clear();
        for _ in 0..if step.generation == 0 { 0 } else { config.parents } {
            let origin = Some(reader.u32()?).filter(|origin| *origin != u32::MAX);
            if let Some(individual) = origin.map(|origin| origin as usize).filter(|origin| *origin >= size) {
                return Err(EvoError::no_such_individual(individual, size));
            }
            let (genes, steps) = (vec![0.0; config.mean.len()], vec![0.0; config.width()]);
            let mut parent = Individual { genes, steps, fitness: reader.fitness()?, origin };
            config.read_rows(reader, &mut parent.steps, &mut parent.genes)?;
            self.parents.push(parent);
        }
        config.read_rows(reader, &mut self.steps, genomes.as_mut_slice())
    }
}
