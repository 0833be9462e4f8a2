//! An experiment for programs that evaluate, step and search by themselves.

use std::sync::atomic::AtomicBool;

use farsa_evo::{ScoreShape, Scores};

use crate::error::Error;
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::TaskInfo;
use crate::experiment::genotype::Genotype;
use crate::experiment::lanes::{LaneRequest, Lanes};
use crate::experiment::outcome::Outcome;
use crate::experiment::parameter::Parameter;
use crate::experiment::settings::{Settings, Value};
use crate::experiment::stepper::Stepper;
use crate::limits::Limits;
use crate::run::evaluation_backend::Unfinished;
use crate::run::fitness::{FailedTrial, Generation, Individual, Opponents, individuals};
use crate::run::laboratory::Laboratory;
use crate::run::plan::{MAX_SEED, Plan};
use crate::run::pool::{IdlePool, Pool};
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::definition::StrategyStart;
use crate::strategy::settings::NORMALISE;

/// Choices for a [`Problem`].
#[derive(Clone, Debug, Default)]
pub struct ProblemOptions {
    /// Condition of the experiment, by default its first.
    pub condition: Option<String>,
    /// Name of the strategy, by default that of the experiment.
    pub strategy: Option<String>,
    /// Seed of the strategy, up to 2^63 - 1.
    pub seed: u64,
    /// Changed settings with their values.
    pub settings: Vec<(String, Value)>,
    /// Threads of [`Problem::evaluate`]. 0 uses all processors.
    pub threads: usize,
    /// Trials that each thread evaluates in SIMD lanes, by default the usual number of this machine.
    pub lanes: Option<usize>,
}

/// An experiment with settings, for programs that evaluate, step and search by themselves.
pub struct Problem<'e> {
    plan: Plan<'e>,
    workers: (usize, LaneRequest),
    /// Pool of the last evaluation.
    pool: Option<IdlePool<'e>>,
}

/// Result of an individual of [`Problem::evaluate`].
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated {
    /// Fitness, then further objectives and measures. Empty for a failed individual.
    pub scores: Vec<f64>,
    /// Outcomes of all trials. Empty for a failed individual.
    pub trials: Vec<Outcome>,
    /// Failed trial and the reason. The trial is `None` if the fitness itself failed.
    pub failure: Option<(Option<u32>, String)>,
}

impl<'e> Laboratory<'e> {
    /// Prepares an experiment by its name or file.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] and [`Error::Usage`] for unknown names, wrong values and files that cannot be read.
    pub fn problem(&self, experiment: &str, options: &ProblemOptions) -> Result<Problem<'e>, Error> {
        let experiment = self.experiment(experiment, "")?;
        let strategy = options.strategy.as_deref().map(|name| self.strategy(name, "")).transpose()?;
        let mut plan = Plan::with_strategy(experiment, options.condition.as_deref(), "", strategy)?;
        if options.seed > MAX_SEED {
            return Err(Error::Usage(format!("seed {} is above {MAX_SEED}", options.seed)));
        }
        plan.seed = options.seed;
        options.settings.iter().try_for_each(|(key, value)| plan.set("", key, value.clone()))?;
        let lanes = LaneRequest { count: options.lanes, simd: None };
        if let Some(count) = options.lanes {
            Lanes::new(count, Lanes::best().instructions())?;
        }
        let all = || std::thread::available_parallelism().map_or(1, usize::from);
        let threads = if options.threads == 0 { all() } else { options.threads };
        Ok(Problem { plan, workers: (threads, lanes), pool: None })
    }

    /// Starts a strategy over `genes` genes without an experiment. It has one objective and no measures.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] and [`Error::Usage`] for an unknown strategy, wrong values, and a strategy that needs an
    /// experiment.
    pub fn search(&self, strategy: &str, genes: usize, options: &ProblemOptions) -> Result<Search, Error> {
        let definition = self.strategy(strategy, "")?;
        let mut settings = Settings::new(definition.settings())?;
        options.settings.iter().try_for_each(|(key, value)| settings.set("", key, value.clone()))?;
        if !(1..=MAX_GENES).contains(&genes) {
            return Err(Error::Usage(format!("{genes} genes: there must be 1 to {MAX_GENES}")));
        }
        if options.seed > MAX_SEED {
            return Err(Error::Usage(format!("seed {} is above {MAX_SEED}", options.seed)));
        }
        let start = StrategyStart {
            populations: 1,
            trials: 1,
            genes,
            gene_bits: 16,
            objectives: 1,
            measures: &[],
            settings: &settings,
            seed: options.seed,
            evaluator: &|| Err(Error::Usage(format!("the strategy `{strategy}` needs an experiment"))),
            limits: Limits::default(),
        };
        let started = definition.start(&start).map_err(|error| match error {
            Error::Other(why) => Error::Usage(format!("the strategy `{strategy}` {why}")),
            other => other,
        })?;
        Ok(Search { strategy: started, genotype: None })
    }
}

/// Most genes of a search without an experiment.
const MAX_GENES: usize = 10_000_000;

impl Problem<'_> {
    /// Gets the name of the experiment.
    pub fn experiment(&self) -> &'static str {
        self.plan.experiment.name()
    }

    /// Gets the condition. This is empty if the experiment has none.
    pub fn condition(&self) -> &str {
        &self.plan.condition
    }

    /// Gets the name of the strategy.
    pub fn strategy(&self) -> &'static str {
        self.plan.definition().name()
    }

    /// Gets the values of all settings.
    pub fn settings(&self) -> &Settings {
        &self.plan.settings
    }

    /// Describes the task.
    ///
    /// # Errors
    /// Returns the errors of [`Experiment::prepare`](crate::Experiment::prepare).
    pub fn info(&self) -> Result<TaskInfo, Error> {
        Ok(self.plan.evaluator()?.info())
    }

    /// Checks whether trials can run in SIMD lanes.
    ///
    /// # Errors
    /// Returns the errors of [`Experiment::prepare`](crate::Experiment::prepare).
    pub fn has_lanes(&self) -> Result<bool, Error> {
        Ok(self.plan.evaluator()?.in_lanes().is_some())
    }

    /// Builds worlds that the caller steps, one for each lane.
    ///
    /// # Errors
    /// Returns [`Error::Usage`] with the reason if the experiment cannot be stepped or has no lanes.
    pub fn stepper(&self, lanes: Lanes) -> Result<Box<dyn Stepper>, Error> {
        self.plan.evaluator()?.into_stepper(lanes)
    }

    /// Evaluates individuals in all trials, as `farsa evaluate --stdin` does. The `id` holds seed, generation and number of
    /// the first individual.
    ///
    /// # Errors
    /// Returns [`Error::Usage`] for parameters of another number, several populations and normalized observations.
    pub fn evaluate(&mut self, parameters: &[Vec<f32>], id: EpisodeId) -> Result<Vec<Evaluated>, Error> {
        let idle = if let Some(pool) = self.pool.take() {
            pool
        } else {
            if self.plan.no_observations()?.is_some() {
                let why = "observations are normalized by those of a run; set it to false";
                return Err(Error::setting(NORMALISE, why));
            }
            Pool::new(&self.plan, self.workers.0, self.workers.1)?.idle()
        };
        let mut pool = idle.awake();
        let result = evaluate(&mut pool, self.plan.experiment.name(), parameters, id);
        self.pool = Some(pool.idle());
        result
    }

    /// Decodes rows of real genes into parameters. -1 and 1 are the ends of each range, and larger values are reflected.
    ///
    /// # Errors
    /// Returns [`Error::Usage`] for another number of genes and for NaN.
    pub fn decode(&self, genes: &[Vec<f64>]) -> Result<Vec<Vec<f32>>, Error> {
        let genotype = self.plan.genotype(self.plan.evaluator()?.as_ref());
        let row = |(number, row): (usize, &Vec<f64>)| {
            let (found, wanted) = (row.len(), genotype.genes());
            let why =
                || Error::Usage(format!("individual {number} has {found} genes, some NaN, where {wanted} are decoded"));
            genotype.decode_reals(row).ok_or_else(why)
        };
        genes.iter().enumerate().map(row).collect()
    }

    /// Starts the strategy at its first generation.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] and [`Error::Usage`] for a strategy that does not fit the experiment.
    pub fn search(&self) -> Result<Search, Error> {
        let strategy = self.plan.strategy()?;
        let genotype = Some(self.plan.genotype(self.plan.evaluator()?.as_ref()));
        Ok(Search { strategy, genotype })
    }
}

/// Evaluates individuals of a single population.
fn evaluate(pool: &mut Pool<'_>, name: &str, parameters: &[Vec<f32>], id: EpisodeId) -> Result<Vec<Evaluated>, Error> {
    let info = pool.info();
    let (populations, wanted) = (info.populations.len(), info.parameters.len());
    if populations > 1 {
        return Err(Error::Usage(format!("{name} has {populations} populations; `farsa evaluate --stdin` takes them")));
    }
    if let Some(row) = parameters.iter().position(|row| row.len() != wanted) {
        let found = parameters[row].len();
        return Err(Error::Usage(format!("individual {row} has {found} parameters where {name} has {wanted}")));
    }
    for (number, row) in parameters.iter().enumerate() {
        for (value, Parameter { name, ends: [first, other] }) in row.iter().zip(&info.parameters) {
            let (low, high) = (first.min(*other), first.max(*other));
            // A comparison with NaN is false.
            if !(low as f32 <= *value && *value <= high as f32) {
                let why = format!("individual {number}: `{name}` is {value:?}, outside {low:?} to {high:?}");
                return Err(Error::Usage(why));
            }
        }
    }
    if id.seed > MAX_SEED {
        return Err(Error::Usage(format!("seed {} is above {MAX_SEED}", id.seed)));
    }
    let behavior = pool.evaluator().behavior();
    let (objectives, measures) =
        behavior.map_or((0, 0), |behavior| (behavior.objectives().len(), behavior.measures().len()));
    let shape = ScoreShape::new(1 + objectives, measures);
    let generation = Generation { parameters, opponents: Opponents::default(), normalisation: None, id, stop: None };
    let never = AtomicBool::new(false);
    let evaluated = individuals(&mut pool.until(&never), generation, shape, |_| {}).map_err(|error| match error {
        Unfinished::Error(error) => error,
        Unfinished::Stopped => Error::Other("the evaluation was stopped".into()),
    })?;
    Ok(evaluated.into_iter().map(Evaluated::from_result).collect())
}

impl Evaluated {
    fn from_result(result: Result<Individual, FailedTrial>) -> Self {
        match result {
            Ok((scores, trials)) => Self { scores, trials, failure: None },
            Err(failure) => Self { scores: Vec::new(), trials: Vec::new(), failure: Some(failure) },
        }
    }

    /// Gets the fitness, NaN after a failure.
    pub fn fitness(&self) -> f64 {
        self.scores.first().copied().unwrap_or(f64::NAN)
    }
}

/// A search by ask and tell, for programs that evaluate by themselves.
pub struct Search {
    strategy: AnyStrategy,
    /// `None` without an experiment.
    genotype: Option<Genotype>,
}

impl Search {
    /// Gets the number of the generation that is evaluated next, from 0.
    pub fn generation(&self) -> u32 {
        self.strategy.generation()
    }

    /// Gets the numbers of individuals and of genes.
    pub fn shape(&self) -> [usize; 2] {
        [self.strategy.individuals(), self.strategy.genes()]
    }

    /// Gets the numbers of objectives and measures of an individual.
    pub fn score_shape(&self) -> ScoreShape {
        self.strategy.score_shape()
    }

    /// Lists the parameters of the current generation. Without an experiment, these are the genes.
    ///
    /// # Errors
    /// Returns [`Error::Other`] for genomes that do not fit the experiment.
    pub fn ask(&self) -> Result<Vec<Vec<f32>>, Error> {
        match &self.genotype {
            Some(genotype) => self.strategy.parameters(genotype),
            None => Some(self.genes().iter().map(|row| row.iter().map(|gene| *gene as f32).collect()).collect()),
        }
        .ok_or_else(|| Error::Other(format!("generation {}: genomes of another length", self.generation())))
    }

    /// Lists the genes of the current generation. Integer genes are 0 to 65535.
    pub fn genes(&self) -> Vec<Vec<f64>> {
        match &self.strategy {
            AnyStrategy::Words(strategy) => {
                strategy.ask().iter().map(|genes| genes.iter().map(|gene| f64::from(*gene)).collect()).collect()
            }
            AnyStrategy::Reals(strategy) => strategy.ask().iter().map(<[f64]>::to_vec).collect(),
        }
    }

    /// Takes the scores of the current generation and advances to the next one. Each individual has its objectives and then
    /// its measures. NaN is a failed individual.
    ///
    /// # Errors
    /// Returns [`Error::Usage`] for another number of scores and after the last generation. The strategy is then unchanged.
    pub fn tell(&mut self, scores: Vec<f64>) -> Result<(), Error> {
        let (shape, individuals) = (self.score_shape(), self.shape()[0]);
        let (found, wanted) = (scores.len(), individuals * shape.width());
        if found != wanted {
            return Err(Error::Usage(format!("{found} scores where {individuals} individuals have {wanted}")));
        }
        let usage = |error: farsa_evo::EvoError| Error::Usage(error.to_string());
        self.strategy.tell_unrecorded(&Scores::nan_as_failed(shape, scores).map_err(usage)?).map_err(usage)
    }

    /// Saves the state as bytes, or returns `None` if the strategy has no saved states.
    pub fn save(&mut self) -> Option<Vec<u8>> {
        self.strategy.snapshot().map(|snapshot| snapshot.save())
    }

    /// Restores a state that [`save`](Self::save) returned for the same configuration and seed.
    ///
    /// # Errors
    /// Returns [`Error::Usage`] for another state. The strategy is then unchanged.
    pub fn restore(&mut self, state: &[u8]) -> Result<(), Error> {
        let none = || Error::Usage("this strategy has no saved states".into());
        let snapshot = self.strategy.snapshot().ok_or_else(none)?;
        snapshot.restore(state).map_err(|error| Error::Usage(error.to_string()))
    }

    /// Lists the members of the archive or front as rows of generation, individual, objectives and measures. This is `None`
    /// for strategies without one.
    pub fn members(&self) -> Option<Vec<Vec<f64>>> {
        let collection = self.strategy.collection()?;
        let row = |member: farsa_evo::Member<'_>| {
            let place = [f64::from(member.generation), member.individual as f64];
            place.into_iter().chain(member.objectives.iter().copied()).chain(member.measures.iter().copied()).collect()
        };
        let mut rows: Vec<Vec<f64>> = collection.members().into_iter().map(row).collect();
        rows.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
        Some(rows)
    }
}
