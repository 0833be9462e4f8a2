//! Agent of a page and its episodes.

use farsa_evo::ObservationStatistics;
use farsa_num::Instructions;
use farsa_view::{Page, Recording, Schema};
use serde::Serialize;
use serde_json::value::RawValue;

use crate::error::Error;
use crate::evaluation::genotypes::written;
use crate::evaluation::trials::episode;
use crate::evaluation::trials::{came_to, facts, fitness, success};
use crate::experiment::PartNames;
use crate::experiment::disturbances::Disturbances;
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::{Bodies, Evaluation, Evaluator};
use crate::experiment::intervention::Intervention;
use crate::experiment::lanes::Lanes;
use crate::experiment::outcome::Outcome;
use crate::live::digest::Digest;
use crate::live::evolution::Evolution;
use crate::live::page_run::{PageIndividual, PageRun};
use crate::live::request::{
    AddedIndividual, EpisodeAnswer, EpisodeRequest, FreshResults, GenotypeText, Request, SharedOutcomes, TrialRequest,
};
use crate::run::config_file::ConfigFile;
use crate::run::evaluation_backend::round;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;

/// Most fresh trials of a request, so that a page stays responsive.
const MAX_FRESH_TRIALS: usize = 10_000;
/// Trials evaluated in parallel lanes.
const LANES: usize = 8;

/// An agent that runs in memory.
///
/// It runs episodes in the same way as `farsa replay` and `farsa test`, but needs neither files nor threads. Agents
/// and requests are JSON that is written by `farsa live` and by its page. To get such a page for your own
/// experiments, export a session from a WebAssembly module.
pub struct LiveSession {
    evaluator: Box<dyn Evaluator>,
    /// Name of the experiment.
    name: &'static str,
    seed: u64,
    individuals: Vec<Agent>,
    /// `None` where evolution cannot continue here.
    evolution: Option<Evolution>,
}

/// An individual, ready to be evaluated.
struct Agent {
    saved: PageIndividual,
    normalisation: Option<ObservationStatistics>,
}

impl Agent {
    /// # Errors
    /// [`Error::Other`] for an individual of another experiment.
    fn new(saved: PageIndividual, evaluator: &dyn Evaluator) -> Result<Self, Error> {
        let (expected, count) = (evaluator.info().parameters.len(), saved.parameters.len());
        if expected != count {
            return Err(Error::Other(format!("script: an individual of {count} parameters where {expected} are")));
        }
        let (populations, trials) = (evaluator.info().populations.len(), evaluator.info().trials);
        let met = saved.opponents.len();
        if populations > 1 && met < trials {
            return Err(Error::Other(format!(
                "script: an individual with opponents in {met} trials where {trials} are"
            )));
        }
        let normalisation = saved.normalisation.as_deref().map(ObservationStatistics::from_saved).transpose();
        let normalisation = normalisation.map_err(|error| Error::Other(format!("script: {error}")))?;
        Ok(Self { saved, normalisation })
    }

    /// Lists the opponents in a trial, one of each other population.
    fn opponents(&self, trial: u32) -> Vec<&[f32]> {
        self.saved.opponents.get(trial as usize).into_iter().flatten().map(Vec::as_slice).collect()
    }
}

impl LiveSession {
    /// Opens the agent of a page. Its experiment must either belong to the laboratory, or be described in the
    /// configuration.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the JSON is invalid, or if the individual does not fit. This also includes errors
    /// of reading the configuration.
    pub fn open(laboratory: &Laboratory<'_>, script: &str) -> Result<Self, Error> {
        let run: PageRun = serde_json::from_str(script).map_err(|error| Error::Other(format!("script: {error}")))?;
        let plan = Plan::from_file(laboratory, &ConfigFile::parse("config.toml", &run.config)?)?;
        let evaluator = plan.evaluator()?;
        let agent = |saved: PageIndividual| Agent::new(saved, evaluator.as_ref());
        let newcomer = if run.newcomer { Some(newcomer(&plan, evaluator.as_ref())?) } else { None };
        let all = run.individuals.into_iter().chain(newcomer);
        let individuals: Vec<Agent> = all.map(agent).collect::<Result<_, _>>()?;
        if individuals.is_empty() {
            return Err(Error::Other("script: it has no individual".into()));
        }
        let resumed = |state| Evolution::resume(&plan, evaluator.as_ref(), state);
        let evolution = run.state.map(resumed).transpose()?;
        Ok(Self { evaluator, name: plan.experiment.name(), seed: plan.seed, individuals, evolution })
    }

    /// Answers a request. If the request is invalid, the answer is `{"error": ...}`.
    pub fn answer(&mut self, request: &str) -> String {
        let answer = serde_json::from_str(request)
            .map_err(|error| Error::Other(format!("request: {error}")))
            .and_then(|request| self.respond(request));
        answer.unwrap_or_else(|error| {
            #[derive(Serialize)]
            struct Refusal {
                error: String,
            }
            // Serializing a string cannot fail.
            json(&Refusal { error: error.to_string() }).unwrap_or_default()
        })
    }

    fn respond(&mut self, request: Request) -> Result<String, Error> {
        match request {
            Request::Episode(request) => json(&self.episode(&request)?),
            Request::Fresh { individual, lesion, seed, first, count } => {
                use_lanes(self.evaluator.as_mut())?;
                json(&self.fresh(individual, &lesion, seed, first..first.saturating_add(count))?)
            }
            Request::Names => json(&self.names()),
            Request::Add { individual } => json(&self.add(individual)?),
            Request::Individual { individual } => json(&agent(&self.individuals, individual)?.saved),
            Request::Genotype { individual } => json(&self.genotype(individual)?),
            Request::State => json(&continued(&mut self.evolution)?.mark()?),
            Request::Share { part, parts } => {
                use_lanes(self.evaluator.as_mut())?;
                let outcomes = continued(&mut self.evolution)?.share(self.evaluator.as_mut(), part, parts)?;
                json(&SharedOutcomes { outcomes })
            }
            Request::Tell { outcomes } => {
                json(&continued(&mut self.evolution)?.tell(self.evaluator.as_mut(), &outcomes)?)
            }
        }
    }

    /// Adds an individual after the others.
    fn add(&mut self, individual: PageIndividual) -> Result<AddedIndividual, Error> {
        let index = self.individuals.len();
        self.individuals.push(Agent::new(individual, self.evaluator.as_ref())?);
        Ok(AddedIndividual { individual: index })
    }

    /// Writes the genes of an individual.
    fn genotype(&self, individual: usize) -> Result<GenotypeText, Error> {
        let PageIndividual { generation, individual, genes, .. } = &agent(&self.individuals, individual)?.saved;
        let genes = genes.as_ref().ok_or_else(|| Error::Usage("its genes are no integers".into()))?;
        Ok(GenotypeText { text: written(&format!("{generation}_{individual}_0.wts"), genes) })
    }

    /// Gets the number of kinds of trials.
    pub(crate) fn trials(&self) -> usize {
        self.evaluator.info().trials
    }

    /// Checks if bodies can be moved.
    pub(crate) fn displaces(&self) -> bool {
        self.evaluator.displaces()
    }

    /// Checks if bodies can be pushed.
    pub(crate) fn pushes(&self) -> bool {
        self.evaluator.pushes()
    }

    /// Lists the names of the robots that can be recorded.
    pub(crate) fn robots(&self) -> Vec<String> {
        self.evaluator.info().robots
    }

    /// Lists the names of the populations, none of a single one.
    pub(crate) fn populations(&self) -> Vec<String> {
        let names = self.evaluator.info().populations;
        if names.len() > 1 { names } else { Vec::new() }
    }

    /// Runs and records an episode.
    ///
    /// # Errors
    /// [`Error::Usage`] for an unknown individual, trial, robot, body or part of the controller.
    pub(crate) fn episode(&mut self, request: &EpisodeRequest) -> Result<EpisodeAnswer, Error> {
        let EpisodeRequest { individual, trial, lesion, moves, pushes, watched } = request;
        let schema = schema(self.evaluator.as_ref(), &agent(&self.individuals, *individual)?.saved);
        let disturbances = Disturbances { moves: moves.clone(), pushes: pushes.clone() };
        let disturbances = disturbances.in_world(self.evaluator.as_ref(), self.name, &schema)?;
        let Disturbances { moves: displacements, pushes } = &disturbances;
        let robots = self.evaluator.info().robots;
        if let Some(robot) = watched.filter(|robot| *robot as usize >= robots.len()) {
            return Err(Error::Usage(format!("robot {robot} of {} (the first is 0)", robots.len())));
        }
        let intervention = self.intervention(lesion)?;
        let Self { evaluator, individuals, seed, .. } = self;
        let (agent, kinds) = (agent(individuals, *individual)?, evaluator.info().trials);
        let (id, name) = match *trial {
            TrialRequest::Number(trial) if (trial as usize) < kinds => {
                let PageIndividual { generation, individual, .. } = agent.saved;
                (EpisodeId { seed: *seed, generation, individual, trial }, format!("trial {trial}"))
            }
            TrialRequest::Number(trial) => {
                return Err(Error::Usage(format!("trial {trial} of {kinds} (the first is 0)")));
            }
            TrialRequest::Fresh { number, seed } => (episode(number, kinds, seed), format!("fresh trial {number}")),
        };
        let mut digest = Digest::new(Recording::new(schema));
        let (opponents, normalisation) = (&agent.opponents(id.trial)[..], agent.normalisation.as_ref());
        let plain = Evaluation::new(&agent.saved.parameters, id);
        let intervention = intervention.as_ref();
        let watched = *watched;
        let evaluation = Evaluation { opponents, normalisation, intervention, displacements, pushes, watched, ..plain };
        let outcome = evaluator.evaluate(evaluation, Some(&mut digest));
        let (recording, digests) = digest.into_parts();
        let first =
            [Some(came_to(evaluator.as_ref(), &outcome)), (!lesion.is_empty()).then(|| format!("with {lesion}"))];
        let last = watched.and_then(|robot| robots.get(robot as usize)).map(|robot| format!("{robot} is recorded"));
        let remarks: Vec<String> = first.into_iter().flatten().chain(disturbances.remarks()).chain(last).collect();
        let mut page = Page::new("");
        page.add(&format!("{name}: {}", remarks.join("; ")), facts(evaluator.as_ref(), &outcome), recording);
        let episode = page.episode(0).unwrap_or_default();
        let episode = RawValue::from_string(episode).map_err(|error| Error::Other(error.to_string()))?;
        let fitness = fitness(evaluator.as_ref(), std::slice::from_ref(&outcome));
        let success = success(evaluator.as_ref(), &outcome);
        Ok(EpisodeAnswer { episode, digests, steps: outcome.steps, fitness, success })
    }

    /// Evaluates fresh trials.
    fn fresh(
        &mut self,
        individual: usize,
        lesion: &str,
        seed: u64,
        numbers: std::ops::Range<usize>,
    ) -> Result<FreshResults, Error> {
        if numbers.len() > MAX_FRESH_TRIALS {
            return Err(Error::Usage(format!("{} trials at once, at most {MAX_FRESH_TRIALS}", numbers.len())));
        }
        let intervention = self.intervention(lesion)?;
        let Self { evaluator, individuals, .. } = self;
        let (agent, kinds) = (agent(individuals, individual)?, evaluator.info().trials);
        let ids: Vec<EpisodeId> = numbers.map(|number| episode(number, kinds, seed)).collect();
        let opponents: Vec<Vec<&[f32]>> = ids.iter().map(|id| agent.opponents(id.trial)).collect();
        let evaluations = ids.iter().zip(&opponents).enumerate().map(|(number, (id, opponents))| {
            let plain = Evaluation::new(&agent.saved.parameters, *id);
            let (normalisation, intervention) = (agent.normalisation.as_ref(), intervention.as_ref());
            Evaluation { number, opponents, normalisation, intervention, ..plain }
        });
        let outcomes = outcomes(evaluator.as_mut(), evaluations.collect());
        let fitness = outcomes.iter().map(|outcome| fitness(evaluator.as_ref(), std::slice::from_ref(outcome)));
        let fitness: Vec<f64> = fitness.collect();
        let successes = outcomes
            .iter()
            .try_fold(0, |count, outcome| Some(count + usize::from(success(evaluator.as_ref(), outcome)?)));
        Ok(FreshResults { trials: outcomes.len(), successes, fitness })
    }

    /// Parses a list of changes, `None` of an empty list.
    fn intervention(&self, lesion: &str) -> Result<Option<Intervention>, Error> {
        if lesion.is_empty() {
            return Ok(None);
        }
        let anatomy = self.evaluator.info().anatomy;
        let absent = || Error::Usage(format!("experiment `{}` has no controller that can be changed", self.name));
        anatomy.ok_or_else(absent)?.intervention(lesion).map(Some)
    }

    fn names(&self) -> Vec<PartNames> {
        self.evaluator.info().anatomy.map(|anatomy| anatomy.names()).unwrap_or_default()
    }
}

/// Draws an individual, the first of the plan's first generation. The first of each other population are its opponents.
fn newcomer(plan: &Plan<'_>, evaluator: &dyn Evaluator) -> Result<PageIndividual, Error> {
    let (strategy, genotype) = (plan.strategy()?, plan.genotype(evaluator));
    let size = strategy.individuals() / strategy.populations();
    let first = |population: usize| {
        let genome = strategy.genome(population * size)?;
        Some((genome.decode(&genotype)?, genome.words().map(<[u16]>::to_vec)))
    };
    let all: Option<Vec<_>> = (0..strategy.populations()).map(first).collect();
    let mut all = all.into_iter().flatten();
    let (parameters, genes) = all.next().ok_or_else(|| Error::Other("script: no individual can be drawn".into()))?;
    let opponents = vec![all.map(|(parameters, _)| parameters).collect(); evaluator.info().trials];
    Ok(PageIndividual { generation: 0, individual: 0, genes, parameters, opponents, normalisation: None })
}

/// Returns the search, if the page has one.
fn continued(evolution: &mut Option<Evolution>) -> Result<&mut Evolution, Error> {
    evolution.as_mut().ok_or_else(|| Error::Usage("evolution cannot continue here".into()))
}

/// Returns an individual by its index.
fn agent(individuals: &[Agent], index: usize) -> Result<&Agent, Error> {
    let count = individuals.len();
    individuals.get(index).ok_or_else(|| Error::Usage(format!("individual {index} of {count} (the first is 0)")))
}

/// Builds the schema of an individual's recordings.
fn schema(evaluator: &dyn Evaluator, individual: &PageIndividual) -> Schema {
    let with = |bodies: &dyn Bodies| bodies.schema_with(&individual.parameters);
    evaluator.bodies().map_or_else(|| evaluator.info().schema, with)
}

/// Evaluates numbered episodes, in lanes where the experiment has them.
fn outcomes(evaluator: &mut dyn Evaluator, evaluations: Vec<Evaluation<'_>>) -> Vec<Outcome> {
    let mut outcomes: Vec<Outcome> = vec![Outcome::failed(); evaluations.len()];
    let mut rest = evaluations.into_iter();
    round(evaluator, &mut || rest.next(), &mut |number, outcome| outcomes[number] = outcome);
    outcomes
}

/// Enables parallel lanes where the experiment has them.
fn use_lanes(evaluator: &mut dyn Evaluator) -> Result<(), Error> {
    let lanes = Lanes::new(LANES, Instructions::detect())?;
    evaluator.in_lanes().map_or(Ok(()), |in_lanes| in_lanes.use_lanes(lanes))
}

/// Serializes a value as JSON without white space.
pub(crate) fn json(value: &impl Serialize) -> Result<String, Error> {
    serde_json::to_string(value).map_err(|error| Error::Other(error.to_string()))
}
