//! The steady state strategy of evorobotpy: parents and one child each, of which the better half stays.

use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::error::{EvoError, check_range, check_setting, check_share};
use crate::fitness::Fitness;
use crate::population::Population;
use crate::real::bounds::{check_bounds, check_within, uniform};
use crate::real::mutation::RealMutation;
use crate::search::{Algorithm, Search, Step};
use crate::snapshot::{StateReader, between_states, push_indices, push_reals};
use crate::strategy::RecordKind;

/// Configuration of [`SteadyState`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SteadyStateConfig {
    /// Range of each gene, from low to high \[genes\], -1e100 to 1e100. You can freeze a gene by giving it equal ends.
    pub bounds: Vec<[f64; 2]>,
    /// Total number of parents and offspring, which must be even. The source calls this `popsize`.
    pub population: usize,
    /// Probability (0 to 1) that a gene is mutated. 1 in the source.
    pub rate: f64,
    /// Standard deviation of mutation as a share of the gene's range, 0 to 1. The source calls this `mutation` and
    /// gives it in the unit of the gene.
    pub sigma: f64,
    /// Largest amount that is randomly added to or subtracted from the fitness of an individual before it is ranked. It
    /// is in the unit of fitness, 0 to 1e100. If this is 0, there is no noise.
    pub noise: f64,
}

impl SteadyStateConfig {
    /// The 20 individuals of \[Nolfi2021\], of which every gene is mutated, without noise. Its standard deviation is 0.02
    /// in the unit of the genes, and 0.02 of the range here.
    pub const fn new(bounds: Vec<[f64; 2]>) -> Self {
        Self { bounds, population: 20, rate: 1.0, sigma: 0.02, noise: 0.0 }
    }

    /// Checks whether a search can be created with these settings.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] or [`EvoError::OutOfRange`] for the first setting that is invalid.
    pub fn validate(&self) -> Result<(), EvoError> {
        let Self { population, rate, sigma, noise, .. } = *self;
        check_bounds(population, &self.bounds)?;
        check_setting(population.is_multiple_of(2), "the population", population as f64, "an even number")?;
        check_share("the mutation rate", rate)?;
        check_share("sigma of mutation", sigma)?;
        check_range("noise", noise, [0.0, 1e100], "0 to 1e100")
    }
}

/// A (mu + mu) strategy over real genes within bounds. In every generation the better half stays where it is, and each of
/// them makes one mutated child. The child of the best replaces the best of the worse half, and so on.
///
/// Since trials vary, all individuals are evaluated again in every generation. If there is noise, individuals are
/// ranked by their fitness plus a number that is uniform between -noise and noise, which lowers the selection pressure.
/// Champions are chosen by the fitness itself. Ties are broken by the lower index, and failed individuals come last.
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
pub type SteadyState = Search<SteadyStateParents>;

/// Internal state of [`SteadyState`].
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyStateParents {
    /// The parent of each individual, itself for one that stayed. Empty in generation 0.
    parents: Vec<u32>,
}

/// The fitness that the individuals of a generation are ranked by.
fn noisy(step: &Step<'_, SteadyStateConfig>, fitness: &[Fitness]) -> Vec<Fitness> {
    let noisy = |(individual, fitness): (usize, &Fitness)| {
        let mut stream = Stream::new(step.seed, Domain::Mutation, 1, individual as u32, step.generation);
        // A failed evaluation remains minus infinity, whatever the noise.
        Fitness::nan_as_failed(fitness.get() + step.config.noise * (2.0 * stream.uniform_f64() - 1.0))
    };
    fitness.iter().enumerate().map(noisy).collect()
}

impl Algorithm for SteadyStateParents {
    type Gene = f64;
    type Config = SteadyStateConfig;
    const HAS_PARENTS: bool = true;

    fn start(step: &Step<'_, SteadyStateConfig>) -> Result<(Self, Population<f64>), EvoError> {
        step.config.validate()?;
        Ok((Self { parents: Vec::new() }, uniform(step, step.config.population, &step.config.bounds)?))
    }

    fn advance(&mut self, step: &Step<'_, SteadyStateConfig>, fitness: &[Fitness], genomes: &mut Population<f64>) {
        let SteadyStateConfig { rate, sigma, noise, .. } = *step.config;
        // Fitness and its noise belong to the previous generation.
        let order =
            if noise > 0.0 { Fitness::ranking(&noisy(&step.previous(), fitness)) } else { Fitness::ranking(fitness) };
        let (better, worse) = order.split_at(order.len() / 2);
        self.parents = (0..order.len() as u32).collect();
        for (&parent, &place) in better.iter().zip(worse) {
            if let Some(slot) = self.parents.get_mut(place) {
                *slot = parent as u32;
            }
        }
        let mutation = RealMutation::Gaussian { rate, sigma };
        let old = genomes.clone();
        for (individual, (genes, &parent)) in genomes.iter_mut().zip(&self.parents).enumerate() {
            if let Some(from) = old.get(parent as usize).filter(|_| parent as usize != individual) {
                genes.copy_from_slice(from);
                mutation.apply(genes, sigma, &step.config.bounds, &[], &mut step.stream(individual));
            }
        }
    }

    fn record_kind(config: &SteadyStateConfig) -> RecordKind {
        // Noise is added to values, so an order does not rebuild the generation.
        if config.noise > 0.0 { RecordKind::Values } else { RecordKind::Order }
    }

    fn parents_of(&self, _: &Step<'_, SteadyStateConfig>, individual: usize) -> Vec<usize> {
        self.parents.get(individual).map(|&parent| parent as usize).into_iter().collect()
    }

    fn snapshot_interval(genomes: &Population<f64>) -> u32 {
        between_states(genomes)
    }

    fn state_length(&self, step: &Step<'_, SteadyStateConfig>, genes: usize) -> usize {
        8 * genes + if step.generation == 0 { 0 } else { 4 * step.config.population }
    }

    fn save(&self, _: &SteadyStateConfig, genomes: &Population<f64>, saved: &mut Vec<u8>) {
        push_indices(saved, &self.parents);
        push_reals(saved, genomes.as_slice());
    }

    fn restore(
        &mut self,
        step: &Step<'_, SteadyStateConfig>,
        reader: &mut StateReader<'_>,
        genomes: &mut Population<f64>,
    ) -> Result<(), EvoError> {
        self.parents = reader.individuals(if step.generation == 0 { 0 } else { genomes.len() }, genomes.len())?;
        reader.reals(genomes.as_mut_slice())?;
        check_within(genomes, &step.config.bounds)
    }
}
