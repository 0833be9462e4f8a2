//! The steady state strategy of evorobotpy: parents and one child each, of which the better half stays.

use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::error::{EvoError, check_rate, check_setting};
use crate::fitness::Fitness;
use crate::population::Population;
use crate::real::bounds::{check_bounds, check_within, draw_within};
use crate::real::mutation::RealMutation;
use crate::snapshot::{Snapshot, StateReader, between_states, push_reals};
use crate::strategy::{Genealogy, RecordKind, Strategy, next_generation};

/// The configuration of [`SteadyState`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SteadyStateConfig {
    /// The range of each gene, low to high \[genes\], -1e100 to 1e100. Equal ends freeze a gene.
    pub bounds: Vec<[f64; 2]>,
    /// Number of individuals, parents and offspring together: even. In the source `popsize`.
    pub population: usize,
    /// The probability, 0 to 1, that a gene is mutated. 1 in the source.
    pub rate: f64,
    /// The standard deviation of mutation, as a share of the gene's range, 0 to 1. In the source `mutation`, in the
    /// gene's unit.
    pub sigma: f64,
    /// Stochasticity, the largest amount that is added to or subtracted from the fitness of an individual before it is
    /// ranked. In the unit of fitness, 0 to 1e100, 0 for none.
    pub noise: f64,
}

impl SteadyStateConfig {
    /// The 20 individuals of \[Nolfi2021\], of which every gene is mutated, without noise. Its standard deviation is 0.02
    /// in the unit of the genes, and 0.02 of the range here.
    pub const fn new(bounds: Vec<[f64; 2]>) -> Self {
        Self { bounds, population: 20, rate: 1.0, sigma: 0.02, noise: 0.0 }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::Config`] or [`EvoError::OutOfRange`].
    pub fn validate(&self) -> Result<(), EvoError> {
        let Self { population, rate, sigma, noise, .. } = *self;
        check_bounds(population, &self.bounds)?;
        check_setting(population.is_multiple_of(2), "the population", population as f64, "an even number")?;
        check_rate("the mutation rate", rate)?;
        check_setting((0.0..=1.0).contains(&sigma), "sigma of mutation", sigma, "0 to 1")?;
        check_setting((0.0..=1e100).contains(&noise), "noise", noise, "0 to 1e100")
    }
}

/// A (mu + mu) strategy over real genes within bounds. In every generation the better half stays where it is, and each of
/// them makes one mutated child. The child of the best replaces the best of the worse half, and so on.
///
/// All are evaluated again in every generation, because trials vary. With noise, individuals are ranked by their fitness
/// plus a number that is uniform between -noise and noise, which lowers the selection pressure. Champions are those of the
/// fitness itself. Equals are ranked by index, the lower first, failed ones last.
///
/// The child at the index `i` of generation `g` draws from the stream (seed, [`Domain::Mutation`], trial 0, `i`, `g`). The
/// noise of individual `i` of generation `g` draws from (seed, [`Domain::Mutation`], trial 1, `i`, `g`). Individuals of
/// generation 0 are uniform within the bounds, from (seed, [`Domain::InitialGenome`], trial 0, `i`, 0).
///
/// Source: the program `sss.py` of evorobotpy2 \[Nolfi2021\]. The noise follows the Stochastic Steady State of
/// \[Pagliuca2018\], where it is a share of the largest possible fitness. Its details were not available. Deviations: genes
/// begin uniform within bounds and are reflected at them, where the source has no bounds and begins with the proposal of
/// its network. Sigma is a share of the range, and mutation may leave out genes.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::real::{SteadyState, SteadyStateConfig};
///
/// let mut search = SteadyState::new(SteadyStateConfig::new(vec![[-5.0, 5.0]; 3]), 1)?;
/// let champion = search.maximize(200, |genes| -genes.iter().map(|gene| (gene - 1.0) * (gene - 1.0)).sum::<f64>())?;
/// assert!(champion.fitness.get() > -0.01);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyState {
    config: SteadyStateConfig,
    seed: u64,
    generation: u32,
    /// The parent of each individual, itself for one that stayed. Empty in generation 0.
    parents: Vec<u32>,
    population: Population<f64>,
}

impl SteadyState {
    /// A search at its random initial generation.
    ///
    /// # Errors
    /// The errors of [`SteadyStateConfig::validate`].
    pub fn new(config: SteadyStateConfig, seed: u64) -> Result<Self, EvoError> {
        config.validate()?;
        let mut population = Population::new(config.population, config.bounds.len())?;
        for (individual, genes) in population.iter_mut().enumerate() {
            let mut stream = Stream::new(seed, Domain::InitialGenome, 0, individual as u32, 0);
            draw_within(genes, &config.bounds, &mut stream);
        }
        Ok(Self { config, seed, generation: 0, parents: Vec::new(), population })
    }

    /// The configuration.
    pub fn config(&self) -> &SteadyStateConfig {
        &self.config
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The fitness that individuals of the current generation are ranked by.
    fn noisy(&self, fitness: &[Fitness]) -> Vec<Fitness> {
        let noisy = |(individual, fitness): (usize, &Fitness)| {
            let mut stream = Stream::new(self.seed, Domain::Mutation, 1, individual as u32, self.generation);
            Fitness::nan_as_failed(fitness.get() + self.config.noise * (2.0 * stream.uniform_f64() - 1.0))
        };
        fitness.iter().enumerate().map(noisy).collect()
    }

    /// Bytes of a state at a generation.
    fn state_length(&self, generation: u32) -> usize {
        let parents = if generation == 0 { 0 } else { 4 * self.population.len() };
        4 + parents + 8 * self.population.as_slice().len()
    }
}

impl Strategy<f64> for SteadyState {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population<f64> {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        let generation = next_generation(self.generation, self.population.len(), fitness)?;
        let order =
            if self.config.noise > 0.0 { Fitness::ranking(&self.noisy(fitness)) } else { Fitness::ranking(fitness) };
        let (better, worse) = order.split_at(order.len() / 2);
        let mut parents: Vec<u32> = (0..order.len() as u32).collect();
        for (&parent, &place) in better.iter().zip(worse) {
            if let Some(slot) = parents.get_mut(place) {
                *slot = parent as u32;
            }
        }
        let SteadyStateConfig { rate, sigma, .. } = self.config;
        let mutation = RealMutation::Gaussian { rate, sigma };
        let mut population = self.population.clone();
        for (individual, (genes, &parent)) in population.iter_mut().zip(&parents).enumerate() {
            if let Some(from) = self.population.get(parent as usize).filter(|_| parent as usize != individual) {
                genes.copy_from_slice(from);
                let mut stream = Stream::new(self.seed, Domain::Mutation, 0, individual as u32, generation);
                mutation.apply(genes, sigma, &self.config.bounds, &[], &mut stream);
            }
        }
        (self.generation, self.parents, self.population) = (generation, parents, population);
        Ok(())
    }

    fn record_kind(&self) -> RecordKind {
        if self.config.noise > 0.0 { RecordKind::Values } else { RecordKind::Order }
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn genealogy(&self) -> Option<&dyn Genealogy> {
        Some(self)
    }
}

impl Genealogy for SteadyState {
    fn parents_of(&self, individual: usize) -> Vec<usize> {
        self.parents.get(individual).map(|&parent| parent as usize).into_iter().collect()
    }
}

impl Snapshot for SteadyState {
    fn snapshot_interval(&self) -> u32 {
        between_states(&self.population)
    }

    fn save(&self) -> Vec<u8> {
        let mut state = Vec::with_capacity(self.state_length(self.generation));
        state.extend(self.generation.to_le_bytes());
        state.extend(self.parents.iter().flat_map(|parent| parent.to_le_bytes()));
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
            let parent = reader.u32()?;
            if parent as usize >= size {
                return Err(EvoError::no_such_individual(parent as usize, size));
            }
            parents.push(parent);
        }
        let mut population = Population::new(size, self.population.genome_len())?;
        reader.reals(population.as_mut_slice())?;
        check_within(&population, &self.config.bounds)?;
        (self.generation, self.parents, self.population) = (generation, parents, population);
        Ok(())
    }
}
