//! The agent that a script describes, and its trials.

use farsa_evo::ObservationStatistics;
use farsa_num::Instructions;
use farsa_view::{Page, Recording, Schema};
use serde::Serialize;
use serde_json::value::RawValue;

use crate::error::Error;
use crate::evaluation::trials::episode;
use crate::evaluation::trials::{came_to, facts, fitness};
use crate::experiment::PartNames;
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::{Bodies, Evaluation, Evaluator};
use crate::experiment::intervention::Intervention;
use crate::experiment::lanes::Lanes;
use crate::experiment::outcome::Outcome;
use crate::live::digest::Digest;
use crate::live::evolution::Evolution;
use crate::live::hands::hands;
use crate::live::request::{Added, Earned, Film, Filmed, Request, Shared, Trial};
use crate::live::script::{Evolved, Script};
use crate::run::config_file::ConfigFile;
use crate::run::evaluation_backend::round;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;

/// Most fresh trials of a request: a page asks again, and shows how far it has come.
const MOST_FRESH: usize = 10_000;
/// Most individuals of a session.
const MOST_INDIVIDUALS: usize = 10_000;
/// Trials side by side.
const LANES: usize = 8;

/// An agent in memory: it runs trials of an experiment, whole or changed, as `farsa replay` and `farsa test` do, without files
/// and threads.
///
/// A script says which agent, and requests say what it is to do; both are JSON that `farsa live` and its page write. A program
/// of an experiment of one's own has a page if it does this in WebAssembly.
pub struct LiveSession {
    evaluator: Box<dyn Evaluator>,
    /// The name of the experiment.
    name: &'static str,
    seed: u64,
    individuals: Vec<Agent>,
    /// None where evolution cannot go on here.
    evolution: Option<Evolution>,
}

/// An individual, ready to be evaluated.
struct Agent {
    own: Evolved,
    normalisation: Option<ObservationStatistics>,
}

impl Agent {
    /// # Errors
    /// [`Error::Other`] for an individual of another experiment.
    fn new(own: Evolved, evaluator: &dyn Evaluator) -> Result<Self, Error> {
        let (expected, found) = (evaluator.info().parameters.len(), own.parameters.len());
        if expected != found {
            return Err(Error::Other(format!("script: an individual of {found} parameters where {expected} are")));
        }
        let normalisation = own.normalisation.as_deref().map(ObservationStatistics::from_saved).transpose();
        let normalisation = normalisation.map_err(|error| Error::Other(format!("script: {error}")))?;
        Ok(Self { own, normalisation })
    }

    /// Whom it met in a trial, one of each other population.
    fn met(&self, trial: u32) -> Vec<&[f32]> {
        self.own.opponents.get(trial as usize).into_iter().flatten().map(Vec::as_slice).collect()
    }
}

impl LiveSession {
    /// The agent of a script, whose experiment is one of the laboratory's or described by the script.
    ///
    /// # Errors
    /// [`Error::Other`] for a script that is none, and what keeps its configuration from being run.
    pub fn open(laboratory: &Laboratory<'_>, script: &str) -> Result<Self, Error> {
        let script: Script = serde_json::from_str(script).map_err(|error| Error::Other(format!("script: {error}")))?;
        let plan = Plan::from_file(laboratory, &ConfigFile::parse("config.toml", &script.config)?)?;
        let evaluator = plan.evaluator()?;
        let agent = |own: Evolved| Agent::new(own, evaluator.as_ref());
        let individuals: Vec<Agent> = script.individuals.into_iter().map(agent).collect::<Result<_, _>>()?;
        if individuals.is_empty() {
            return Err(Error::Other("script: it has no individual".into()));
        }
        let resumed = |standing| Evolution::resume(&plan, evaluator.as_ref(), standing);
        let evolution = script.standing.map(resumed).transpose()?;
        Ok(Self { evaluator, name: plan.experiment.name(), seed: plan.seed, individuals, evolution })
    }

    /// Answers a request; what is wrong with one is the answer `{"error": ...}`.
    pub fn answer(&mut self, request: &str) -> String {
        let answered = serde_json::from_str(request)
            .map_err(|error| Error::Other(format!("request: {error}")))
            .and_then(|request| self.answered(request));
        answered.unwrap_or_else(|error| {
            #[derive(Serialize)]
            struct Wrong {
                error: String,
            }
            // Text is always JSON.
            json(&Wrong { error: error.to_string() }).unwrap_or_default()
        })
    }

    fn answered(&mut self, request: Request) -> Result<String, Error> {
        match request {
            Request::Film(film) => json(&self.film(&film)?),
            Request::Fresh { individual, lesion, seed, first, count } => {
                use_lanes(self.evaluator.as_mut())?;
                json(&self.fresh(individual, &lesion, seed, first..first.saturating_add(count))?)
            }
            Request::Names => json(&self.names()),
            Request::Add { individual } => json(&self.add(individual)?),
            Request::Share { part, parts } => {
                use_lanes(self.evaluator.as_mut())?;
                let outcomes = going_on(&mut self.evolution)?.share(self.evaluator.as_mut(), part, parts)?;
                json(&Shared { outcomes })
            }
            Request::Tell { outcomes } => {
                json(&going_on(&mut self.evolution)?.tell(self.evaluator.as_mut(), &outcomes)?)
            }
        }
    }

    /// Adds an individual behind the others.
    fn add(&mut self, individual: Evolved) -> Result<Added, Error> {
        let place = self.individuals.len();
        if place >= MOST_INDIVIDUALS {
            return Err(Error::Usage(format!("a page holds {MOST_INDIVIDUALS} individuals at most")));
        }
        self.individuals.push(Agent::new(individual, self.evaluator.as_ref())?);
        Ok(Added { individual: place })
    }

    /// Kinds of trials.
    pub(crate) fn trials(&self) -> usize {
        self.evaluator.info().trials
    }

    /// Whether bodies can be put elsewhere.
    pub(crate) fn displaces(&self) -> bool {
        self.evaluator.displaces()
    }

    /// Whether bodies can be pushed.
    pub(crate) fn pushes(&self) -> bool {
        self.evaluator.pushes()
    }

    /// The robots of which any can be recorded.
    pub(crate) fn robots(&self) -> Vec<String> {
        self.evaluator.info().robots
    }

    /// The names of the populations, where there are several.
    pub(crate) fn populations(&self) -> Vec<String> {
        let names = self.evaluator.info().populations;
        if names.len() > 1 { names } else { Vec::new() }
    }

    /// Runs and records a trial.
    ///
    /// # Errors
    /// [`Error::Usage`] for what there is not.
    pub(crate) fn film(&mut self, asked: &Film) -> Result<Filmed, Error> {
        let Film { individual, trial, lesion, watched, .. } = asked;
        let schema = schema(self.evaluator.as_ref(), &one(&self.individuals, *individual)?.own);
        let (displacements, pushes) = &hands(self.evaluator.as_ref(), self.name, &schema, asked)?;
        let robots = self.evaluator.info().robots;
        if let Some(robot) = watched.filter(|robot| *robot as usize >= robots.len()) {
            return Err(Error::Usage(format!("robot {robot} of {} (the first is 0)", robots.len())));
        }
        let intervention = self.intervention(lesion)?;
        let Self { evaluator, individuals, seed, .. } = self;
        let (individual, kinds) = (one(individuals, *individual)?, evaluator.info().trials);
        let (id, name) = match *trial {
            Trial::Number(trial) if (trial as usize) < kinds => {
                let Evolved { generation, individual, .. } = individual.own;
                (EpisodeId { seed: *seed, generation, individual, trial }, format!("trial {trial}"))
            }
            Trial::Number(trial) => return Err(Error::Usage(format!("trial {trial} of {kinds} (the first is 0)"))),
            Trial::Fresh { number, seed } => (episode(number, kinds, seed), format!("fresh trial {number}")),
        };
        let mut digest = Digest::new(Recording::new(schema));
        let (opponents, normalisation) = (&individual.met(id.trial)[..], individual.normalisation.as_ref());
        let plain = Evaluation::new(&individual.own.parameters, id);
        let intervention = intervention.as_ref();
        let watched = *watched;
        let evaluation = Evaluation { opponents, normalisation, intervention, displacements, pushes, watched, ..plain };
        let outcome = evaluator.evaluate(evaluation, Some(&mut digest));
        let (recording, digests) = digest.into_parts();
        let said = [
            Some(came_to(evaluator.as_ref(), &outcome)),
            (!lesion.is_empty()).then(|| format!("with {lesion}")),
            (!displacements.is_empty()).then(|| format!("{} moved", displacements.len())),
            (!pushes.is_empty()).then(|| format!("{} pushed", pushes.len())),
            watched.and_then(|robot| robots.get(robot as usize)).map(|robot| format!("{robot} is recorded")),
        ];
        let said: Vec<String> = said.into_iter().flatten().collect();
        let mut page = Page::new("");
        page.add(&format!("{name}: {}", said.join("; ")), facts(evaluator.as_ref(), &outcome), recording);
        let film = page.episode(0).unwrap_or_default();
        let film = RawValue::from_string(film).map_err(|error| Error::Other(error.to_string()))?;
        let fitness = fitness(evaluator.as_ref(), std::slice::from_ref(&outcome));
        Ok(Filmed { film, digests, steps: outcome.steps, fitness, success: outcome.success })
    }

    /// Runs fresh trials.
    fn fresh(
        &mut self,
        individual: usize,
        lesion: &str,
        seed: u64,
        numbers: std::ops::Range<usize>,
    ) -> Result<Earned, Error> {
        if numbers.len() > MOST_FRESH {
            return Err(Error::Usage(format!("{} trials at once, at most {MOST_FRESH}", numbers.len())));
        }
        let intervention = self.intervention(lesion)?;
        let Self { evaluator, individuals, .. } = self;
        let (agent, kinds) = (one(individuals, individual)?, evaluator.info().trials);
        let ids: Vec<EpisodeId> = numbers.map(|number| episode(number, kinds, seed)).collect();
        let met: Vec<Vec<&[f32]>> = ids.iter().map(|id| agent.met(id.trial)).collect();
        let all = ids.iter().zip(&met).enumerate().map(|(number, (id, opponents))| {
            let plain = Evaluation::new(&agent.own.parameters, *id);
            let (normalisation, intervention) = (agent.normalisation.as_ref(), intervention.as_ref());
            Evaluation { number, opponents, normalisation, intervention, ..plain }
        });
        let outcomes = evaluated(evaluator.as_mut(), all.collect());
        let fitness = outcomes.iter().map(|outcome| fitness(evaluator.as_ref(), std::slice::from_ref(outcome)));
        Ok(Earned {
            trials: outcomes.len(),
            successes: outcomes.iter().filter(|outcome| outcome.success).count(),
            fitness: fitness.collect(),
        })
    }

    /// What a list of changes says; none of an empty list.
    fn intervention(&self, lesion: &str) -> Result<Option<Intervention>, Error> {
        if lesion.is_empty() {
            return Ok(None);
        }
        let anatomy = self.evaluator.info().anatomy;
        let none = || Error::Usage(format!("experiment `{}` has no controller that can be changed", self.name));
        anatomy.ok_or_else(none)?.intervention(lesion).map(Some)
    }

    fn names(&self) -> Vec<PartNames> {
        self.evaluator.info().anatomy.map(|anatomy| anatomy.names()).unwrap_or_default()
    }
}

/// The search, if there is one.
fn going_on(evolution: &mut Option<Evolution>) -> Result<&mut Evolution, Error> {
    evolution.as_mut().ok_or_else(|| Error::Usage("evolution does not go on here".into()))
}

/// An individual by its place in the script.
fn one(individuals: &[Agent], place: usize) -> Result<&Agent, Error> {
    let count = individuals.len();
    individuals.get(place).ok_or_else(|| Error::Usage(format!("individual {place} of {count} (the first is 0)")))
}

/// The schema of an individual's recordings.
fn schema(evaluator: &dyn Evaluator, individual: &Evolved) -> Schema {
    let with = |bodies: &dyn Bodies| bodies.schema_with(&individual.parameters);
    evaluator.bodies().map_or_else(|| evaluator.info().schema, with)
}

/// Evaluates these, in lanes where the experiment has them; their numbers are their places.
fn evaluated(evaluator: &mut dyn Evaluator, all: Vec<Evaluation<'_>>) -> Vec<Outcome> {
    let mut found: Vec<Outcome> = vec![Outcome::failed(); all.len()];
    let mut rest = all.into_iter();
    round(evaluator, &mut || rest.next(), &mut |number, outcome| found[number] = outcome);
    found
}

/// Puts trials side by side where the experiment can.
fn use_lanes(evaluator: &mut dyn Evaluator) -> Result<(), Error> {
    let lanes = Lanes::new(LANES, Instructions::detect())?;
    evaluator.in_lanes().map_or(Ok(()), |in_lanes| in_lanes.use_lanes(lanes))
}

/// Anything as JSON for programs.
pub(crate) fn json(what: &impl Serialize) -> Result<String, Error> {
    serde_json::to_string(what).map_err(|error| Error::Other(error.to_string()))
}
