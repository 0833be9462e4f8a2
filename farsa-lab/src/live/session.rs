//! The agent that a script describes, and its trials.

use farsa_evo::ObservationStatistics;
use farsa_view::{Page, Recording, Schema};
use serde::Serialize;
use serde_json::value::RawValue;

use crate::error::Error;
use crate::evaluation::trials::episode;
use crate::evaluation::trials::{came_to, facts, fitness};
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::{Bodies, Evaluation, Evaluator};
use crate::experiment::intervention::Intervention;
use crate::live::digest::Digest;
use crate::live::request::{Earned, Filmed, Names, Request, Trial};
use crate::live::script::{Evolved, Script};
use crate::run::config_file::ConfigFile;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;

/// Most fresh trials of a request: a page asks again, and shows how far it has come.
const MOST_FRESH: usize = 10_000;

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
}

/// An individual, ready to be evaluated.
struct Agent {
    own: Evolved,
    normalisation: Option<ObservationStatistics>,
}

impl LiveSession {
    /// The agent of a script, whose experiment is one of the laboratory's or described by the script.
    ///
    /// # Errors
    /// [`Error::Other`] for a script that is none, and what keeps its configuration from being run.
    pub fn open(laboratory: &Laboratory<'_>, script: &str) -> Result<Self, Error> {
        let script: Script = serde_json::from_str(script).map_err(|error| Error::Other(format!("script: {error}")))?;
        let plan = Plan::from_file(laboratory, &ConfigFile::parse("config.toml", &script.config)?)?;
        let agent = |own: Evolved| {
            let normalisation = own.normalisation.as_deref().map(ObservationStatistics::from_saved).transpose();
            normalisation.map(|normalisation| Agent { own, normalisation })
        };
        let individuals = script.individuals.into_iter().map(agent).collect::<Result<Vec<_>, _>>();
        let individuals = individuals.map_err(|error| Error::Other(format!("script: {error}")))?;
        if individuals.is_empty() {
            return Err(Error::Other("script: it has no individual".into()));
        }
        Ok(Self { evaluator: plan.evaluator()?, name: plan.experiment.name(), seed: plan.seed, individuals })
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
            Request::Film { individual, trial, lesion } => json(&self.film(individual, trial, &lesion)?),
            Request::Fresh { individual, lesion, seed, first, count } => {
                json(&self.fresh(individual, &lesion, seed, first..first.saturating_add(count))?)
            }
            Request::Names => json(&self.names()),
        }
    }

    /// Kinds of trials.
    pub(crate) fn trials(&self) -> usize {
        self.evaluator.trials()
    }

    /// Runs and records a trial.
    pub(crate) fn film(&mut self, individual: usize, trial: Trial, lesion: &str) -> Result<Filmed, Error> {
        let intervention = self.intervention(lesion)?;
        let Self { evaluator, individuals, seed, .. } = self;
        let (individual, kinds) = (one(individuals, individual)?, evaluator.trials());
        let (id, name) = match trial {
            Trial::Number(trial) if (trial as usize) < kinds => {
                let Evolved { generation, individual, .. } = individual.own;
                (EpisodeId { seed: *seed, generation, individual, trial }, format!("trial {trial}"))
            }
            Trial::Number(trial) => return Err(Error::Usage(format!("trial {trial} of {kinds} (the first is 0)"))),
            Trial::Fresh { number, seed } => (episode(number, kinds, seed), format!("fresh trial {number}")),
        };
        let mut digest = Digest::new(Recording::new(schema(evaluator.as_ref(), &individual.own)));
        let outcome = with_opponents(individual, id.trial, |plain| {
            let evaluation = Evaluation { id, intervention: intervention.as_ref(), ..plain };
            evaluator.evaluate(evaluation, Some(&mut digest))
        });
        let (recording, digests) = digest.into_parts();
        let with = if lesion.is_empty() { String::new() } else { format!("; with {lesion}") };
        let came = came_to(evaluator.as_ref(), &outcome);
        let mut page = Page::new("");
        page.add(&format!("{name}: {came}{with}"), facts(evaluator.as_ref(), &outcome), recording);
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
        let (individual, kinds) = (one(individuals, individual)?, evaluator.trials());
        let mut earned = Earned::default();
        for number in numbers {
            let id = episode(number, kinds, seed);
            let outcome = with_opponents(individual, id.trial, |plain| {
                evaluator.evaluate(Evaluation { id, intervention: intervention.as_ref(), ..plain }, None)
            });
            earned.trials += 1;
            earned.successes += usize::from(outcome.success);
            earned.fitness.push(fitness(evaluator.as_ref(), std::slice::from_ref(&outcome)));
        }
        Ok(earned)
    }

    /// What a list of changes says; none of an empty list.
    fn intervention(&self, lesion: &str) -> Result<Option<Intervention>, Error> {
        if lesion.is_empty() {
            return Ok(None);
        }
        let anatomy = self.evaluator.anatomy();
        let none = || Error::Usage(format!("experiment `{}` has no controller that can be changed", self.name));
        anatomy.ok_or_else(none)?.intervention(lesion).map(Some)
    }

    fn names(&self) -> Vec<Names> {
        let own = |(kind, names): (&str, Vec<&str>)| Names {
            kind: kind.into(),
            names: names.into_iter().map(str::to_owned).collect(),
        };
        self.evaluator.anatomy().map(|anatomy| anatomy.names().into_iter().map(own).collect()).unwrap_or_default()
    }
}

/// An individual by its place in the script.
fn one(individuals: &[Agent], place: usize) -> Result<&Agent, Error> {
    let count = individuals.len();
    individuals.get(place).ok_or_else(|| Error::Usage(format!("individual {place} of {count} (the first is 0)")))
}

/// The schema of an individual's recordings.
fn schema(evaluator: &dyn Evaluator, individual: &Evolved) -> Schema {
    let with = |bodies: &dyn Bodies| bodies.schema_with(&individual.parameters);
    evaluator.bodies().map_or_else(|| evaluator.schema(), with)
}

/// Calls `run` with an evaluation of an individual against those whom it met in a trial.
fn with_opponents<T>(agent: &Agent, trial: u32, run: impl FnOnce(Evaluation<'_>) -> T) -> T {
    let Agent { own: Evolved { parameters, opponents, .. }, normalisation } = agent;
    let met = opponents.get(trial as usize).map_or(&[][..], Vec::as_slice);
    let met: Vec<&[f32]> = met.iter().map(Vec::as_slice).collect();
    let plain = Evaluation::new(parameters, EpisodeId::default());
    run(Evaluation { opponents: &met, normalisation: normalisation.as_ref(), ..plain })
}

/// Anything as JSON for programs.
pub(crate) fn json(what: &impl Serialize) -> Result<String, Error> {
    serde_json::to_string(what).map_err(|error| Error::Other(error.to_string()))
}
