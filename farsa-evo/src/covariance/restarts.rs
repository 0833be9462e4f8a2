//! Covariance matrix adaptation in a sequence of runs.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Domain, Stream, exp, ln};

use crate::covariance::config::{CmaEsConfig, STEP_SIZES};
use crate::covariance::distribution::{Covariance, Distribution};
use crate::covariance::full::Full;
use crate::covariance::termination::{LONGEST, Progress};
use crate::error::{EvoError, check_range};
use crate::fitness::Fitness;
use crate::population::Population;
use crate::search::stream;
use crate::snapshot::{Snapshot, StateReader, push_reals};
use crate::strategy::{Strategy, next_generation};

/// The most individuals of a run, in blocks: nine doublings.
const MOST_BLOCKS: u32 = 1 << 9;

/// Determines the population sizes of the runs of [`CmaEsRestarts`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum RestartSchedule {
    /// Twice as many in each run. \[Auger2005\].
    Ipop,
    /// Twice as many in some runs, and few and a small step size in others, so that both kinds evaluate as often. \[Hansen2009\].
    Bipop,
}

/// Configuration of [`CmaEsRestarts`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CmaEsRestartsConfig {
    /// Configuration of the first run. Its number of individuals is also that of every generation.
    pub first: CmaEsConfig,
    /// Determines the population sizes of later runs.
    pub schedule: RestartSchedule,
    /// The largest distance of the first mean to those of later runs, in each gene and in its unit, 0 to 10^100.
    pub spread: f64,
}

impl CmaEsRestartsConfig {
    /// Creates a schedule of runs. As in \[Hansen2009\], their means are at most twice the initial step size away from
    /// the first mean.
    pub fn new(first: CmaEsConfig, schedule: RestartSchedule) -> Self {
        let spread = 2.0 * first.sigma;
        Self { first, schedule, spread }
    }

    /// Checks whether a search can be created with these settings.
    ///
    /// # Errors
    /// Returns the errors of [`CmaEsConfig::validate`]. [`EvoError::Config`] if the largest run, of 512 times as many
    /// individuals as the first, has more genes than [`Population::MAX_GENES`].
    pub fn validate(&self) -> Result<(), EvoError> {
        self.first.validate()?;
        let most = self.first.population.saturating_mul(MOST_BLOCKS as usize);
        Population::check(most, self.first.mean.len())?;
        check_range("spread", self.spread, [0.0, 1e100], "0 to 1e100")
    }
}

/// A run of covariance matrix adaptation.
#[derive(Clone, Debug, PartialEq)]
struct Run {
    /// Its number, from 0.
    number: u32,
    /// Individuals of one of its generations, in blocks.
    blocks: u32,
    /// True for a run of few individuals.
    small: bool,
    /// The step size that it began with.
    sigma: f64,
    /// Blocks that were evaluated.
    evaluated: u64,
    /// The most blocks that it may evaluate, 0 if it may evaluate any number.
    most: u64,
    progress: Progress,
}

/// Covariance matrix adaptation in runs. When one terminates, the next begins at another mean, with more individuals or
/// with few.
///
/// Use this if the fitness has many optima, which a search with few individuals would overlook.
///
/// A strategy has the same number of genomes in all generations, but runs differ in theirs. A generation of this strategy
/// is therefore a block of as many individuals as the first run has. A generation of a run is one to 512 blocks, and the
/// run adapts after its last block.
///
/// Individuals of a block are those of [`CmaEs`](crate::covariance::CmaEs) and draw from the same streams. The mean and the
/// size of run `r` draw from (seed, [`Domain::Mutation`], trial 1, individual 0, `r`).
///
/// A run terminates by `MaxIter`, 100 + 50 (n + 3)^2 / sqrt(lambda) generations, `TolHistFun`, `TolX` (10^-12),
/// `TolUpSigma` (10^4), `ConditionCov` (10^14), `NoEffectAxis`, `NoEffectCoord` or `Stagnation`. See \[Hansen2016\] section
/// B.3 and \[Hansen2009\].
///
/// Source: \[Auger2005\], \[Hansen2009\]. Deviations: the individuals of a run are a multiple of those of the first, where
/// the source rounds down to any number. They double nine times, and later runs stay as large.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::covariance::{CmaEsConfig, CmaEsRestarts, CmaEsRestartsConfig, RestartSchedule};
///
/// let first = CmaEsConfig::new(vec![3.0; 2], 1.0);
/// let mut search = CmaEsRestarts::new(CmaEsRestartsConfig::new(first, RestartSchedule::Bipop), 1)?;
/// search.maximize(400, |x| -x.iter().map(|x| x * x).sum::<f64>())?;
/// assert!(search.run() > 0);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CmaEsRestarts {
    config: CmaEsRestartsConfig,
    seed: u64,
    generation: u32,
    /// Blocks of the latest large run, 1 before there is one.
    large: u32,
    /// Blocks evaluated by all large runs, and by all small ones.
    spent: [u64; 2],
    /// Blocks evaluated by the latest large run.
    latest: u64,
    run: Run,
    distribution: Distribution<Full>,
    /// The fitness of the reported blocks of the run's generation.
    told: Vec<Fitness>,
    /// The individuals of the run's generation.
    points: Population<f64>,
    /// The block that waits for its fitness.
    population: Population<f64>,
}

impl CmaEsRestarts {
    /// Creates a new search at the first generation of its first run.
    ///
    /// # Errors
    /// Returns the errors of [`CmaEsRestartsConfig::validate`].
    pub fn new(config: CmaEsRestartsConfig, seed: u64) -> Result<Self, EvoError> {
        config.validate()?;
        let CmaEsConfig { mean, sigma, population, .. } = &config.first;
        let progress = Progress::default();
        let run = Run { number: 0, blocks: 1, small: false, sigma: *sigma, evaluated: 0, most: 0, progress };
        let population = Population::new(*population, mean.len())?;
        let distribution = Distribution::new(
            mean.clone(),
            *sigma,
            config.first.largest_step,
            config.first.coefficients_of(population.len()),
        );
        let (points, told, spent) = (population.clone(), Vec::new(), [0, 0]);
        let (generation, large, latest) = (0, 1, 0);
        let mut search =
            Self { config, seed, generation, large, spent, latest, run, distribution, told, points, population };
        search.draw();
        Ok(search)
    }

    /// Gets the configuration that this search was created with.
    pub fn config(&self) -> &CmaEsRestartsConfig {
        &self.config
    }

    /// Gets the seed that this search was created with.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Gets the number of the current run, starting at 0.
    pub fn run(&self) -> u32 {
        self.run.number
    }

    /// Number of individuals in a generation of the current run. Note that this can be larger than the number of
    /// genomes in a generation of this strategy.
    pub fn individuals(&self) -> usize {
        self.points.len()
    }

    /// Gets the step size sigma of the current run.
    pub fn sigma(&self) -> f64 {
        self.distribution.sigma
    }

    /// Reported blocks of the run's generation.
    fn block(&self) -> usize {
        self.told.len() / self.population.len()
    }

    /// Draws the run's generation, of which the current block is one, and shows that block.
    fn draw(&mut self) {
        let (seed, block, size) = (self.seed, self.block(), self.population.len());
        // A block is a generation of this search, and each individual draws from the stream of its block's
        // generation.
        let first = self.generation.saturating_sub(block as u32);
        let named =
            |individual: usize| stream(seed, first.saturating_add((individual / size) as u32), individual % size);
        self.distribution.sample_from(named, &mut self.points);
        self.show();
    }

    fn show(&mut self) {
        let (from, length) = (self.block() * self.population.as_slice().len(), self.population.as_slice().len());
        self.population.as_mut_slice().copy_from_slice(&self.points.as_slice()[from..from + length]);
    }

    /// The individuals and the distribution of a run.
    fn begin(&mut self, mean: Vec<f64>, run: Run) -> Result<(), EvoError> {
        let individuals = run.blocks as usize * self.population.len();
        self.points = Population::new(individuals, mean.len())?;
        let CmaEsConfig { largest_step, .. } = self.config.first;
        let coefficients = self.config.first.coefficients_of(individuals);
        self.distribution = Distribution::new(mean, run.sigma, largest_step, coefficients);
        self.run = run;
        Ok(())
    }

    /// Begins the next run.
    fn restart(&mut self) -> Result<(), EvoError> {
        let Run { number, small, evaluated, .. } = self.run;
        // The first run belongs to neither kind.
        if number > 0 {
            let spent = &mut self.spent[usize::from(small)];
            *spent = spent.saturating_add(evaluated);
        }
        if !small {
            self.latest = evaluated;
        }
        let CmaEsConfig { mean, sigma, .. } = self.config.first.clone();
        let number = number.saturating_add(1);
        let mut stream = Stream::new(self.seed, Domain::Mutation, 1, 0, number);
        let spread = self.config.spread;
        let mean = mean.iter().map(|mean| mean + spread * (2.0 * stream.uniform_f64() - 1.0)).collect();
        let [size, shrink] = [stream.uniform_f64(), stream.uniform_f64()];
        // With both kinds, that with fewer evaluations is next, the large one at a tie. [Hansen2009].
        let small = self.config.schedule == RestartSchedule::Bipop && self.spent[1] < self.spent[0];
        let (blocks, sigma, most) = if small {
            // lambda_s = lambda_0 (lambda_l / (2 lambda_0))^(U^2) and sigma_s = sigma 10^(-2 U'). A small run
            // ends at the latest when it has half the evaluations of the latest large one, rounded up to a generation.
            let factor = exp(size * size * ln(0.5 * f64::from(self.large))) as u32;
            let sigma = sigma * exp(-2.0 * core::f64::consts::LN_10 * shrink);
            (factor.clamp(1, self.large), sigma.max(STEP_SIZES[0]), (self.latest / 2).max(1))
        } else {
            self.large = (2 * self.large).min(MOST_BLOCKS);
            (self.large, sigma, 0)
        };
        let progress = Progress::default();
        self.begin(mean, Run { number, blocks, small, sigma, evaluated: 0, most, progress })
    }

    /// Takes all blocks of a run's generation.
    fn adapt(&mut self) -> Result<(), EvoError> {
        let fitness = core::mem::take(&mut self.told);
        let ranked = Fitness::ranking(&fitness);
        if fitness.iter().any(|fitness| !fitness.is_failed()) {
            self.distribution.update(&ranked);
        }
        let Run { sigma, most, evaluated, ref mut progress, .. } = self.run;
        progress.push(&fitness, &ranked);
        if progress.ends(&self.distribution, sigma).is_some() || (most > 0 && evaluated >= most) {
            self.restart()?;
        }
        Ok(())
    }
}

impl Strategy<f64> for CmaEsRestarts {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population<f64> {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        self.generation = next_generation(self.generation, self.population.len(), fitness)?;
        self.told.extend_from_slice(fitness);
        self.run.evaluated = self.run.evaluated.saturating_add(1);
        if self.block() < self.run.blocks as usize {
            self.show();
        } else {
            self.adapt()?;
            self.draw();
        }
        Ok(())
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    /// The step size, the axis ratio, the number of the run and its individuals.
    fn diagnostics(&self) -> Vec<f64> {
        vec![self.sigma(), self.distribution.axis_ratio(), self.run().into(), self.individuals() as f64]
    }
}

/// Numbers at the front of a state: of 4 bytes, then of 8.
const FRONT: (usize, usize) = (8, 6);

impl Snapshot for CmaEsRestarts {
    fn snapshot_interval(&self) -> u32 {
        <Full as Covariance>::snapshot_interval(self.config.first.mean.len())
    }

    fn save(&self) -> Vec<u8> {
        let (run, progress) = (&self.run, &self.run.progress);
        let mut state = Vec::new();
        let small = u32::from(run.small);
        let sizes = [self.block() as u32, progress.best.len() as u32];
        let words = [self.generation, self.large, run.number, run.blocks, small, progress.iterations];
        state.extend(words.into_iter().chain(sizes).flat_map(u32::to_le_bytes));
        let counts = [self.spent[0], self.spent[1], self.latest, run.evaluated, run.most];
        state.extend(counts.into_iter().flat_map(u64::to_le_bytes));
        push_reals(&mut state, &[run.sigma]);
        let values = self.told.iter().chain(&progress.best).chain(&progress.median);
        state.extend(values.flat_map(|fitness| fitness.get().to_le_bytes()));
        self.distribution.save(&mut state);
        state
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let mut front = StateReader::new(state, state.len())?;
        let mut words = [0; FRONT.0];
        for word in &mut words {
            *word = front.u32()?;
        }
        let [generation, large, number, blocks, small, iterations, block, remembered] = words;
        let wrong = |what, found: u32| Err(EvoError::state_content(what, found.into()));
        // Large runs double from 1.
        if !large.is_power_of_two() || large > MOST_BLOCKS {
            return wrong("the blocks of a large run", large);
        }
        if blocks == 0 || blocks > large {
            return wrong("the blocks of a run", blocks);
        }
        if small > 1 {
            return wrong("a kind of run", small);
        }
        if block >= blocks || block > generation {
            return wrong("a block of a run", block);
        }
        // Generations that failed as a whole count as iterations but have no best.
        if remembered > iterations || remembered as usize > LONGEST || iterations > generation {
            return wrong("a number of generations of a run", remembered);
        }
        let (told, remembered) = (block as usize * self.population.len(), remembered as usize);
        let values = told + 2 * remembered;
        let rest = Distribution::<Full>::state_length(self.config.first.mean.len());
        let mut reader = StateReader::new(state, 4 * FRONT.0 + 8 * (FRONT.1 + values) + rest)?;
        // The first reader found the length, which depends on these numbers. This one checks it.
        for _ in 0..FRONT.0 {
            reader.u32()?;
        }
        let mut counts = [0; 5];
        for count in &mut counts {
            *count = reader.u64()?;
        }
        let [large_spent, small_spent, latest, evaluated, most] = counts;
        let sigma = reader.real()?;
        if !(STEP_SIZES[0]..=STEP_SIZES[1]).contains(&sigma) {
            return Err(EvoError::state_content("a step size", sigma.to_bits()));
        }
        let mut row = |length: usize| (0..length).map(|_| reader.fitness()).collect::<Result<Vec<_>, _>>();
        let (told, best, median) = (row(told)?, row(remembered)?, row(remembered)?);
        let progress = Progress { iterations, best, median };
        let run = Run { number, blocks, small: small == 1, sigma, evaluated, most, progress };
        let mut other = Self { generation, large, latest, spent: [large_spent, small_spent], told, ..self.clone() };
        other.begin(self.config.first.mean.clone(), run)?;
        other.distribution.restore(&mut reader)?;
        other.draw();
        *self = other;
        Ok(())
    }
}
