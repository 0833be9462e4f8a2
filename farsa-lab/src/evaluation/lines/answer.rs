//! Output lines: a description first, then one answer per input line.

use serde::{Serialize, Serializer};

use crate::evaluation::lines::request::RequestSchema;
use crate::experiment::behavior::Behavior;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::outcome::{Note, Outcome};
use crate::experiment::parameter::Parameter;
use crate::run::fitness::{FailedTrial, Individual};

/// First line: what the lines have to give.
#[derive(Serialize)]
pub(super) struct Introduction<'d> {
    experiment: &'d str,
    condition: &'d str,
    /// Seed of lines without one.
    seed: u64,
    populations: &'d [String],
    /// Individuals per population. Null for a single population, which has no limit.
    population_size: Option<usize>,
    trials: usize,
    terms: Vec<String>,
    objectives: Vec<String>,
    behaviour: Vec<Ranged>,
    /// Most bytes of a line.
    longest_line: usize,
    parameters: Vec<Ranged>,
}

/// A number with its range.
#[derive(Serialize)]
struct Ranged {
    name: String,
    /// From low to high.
    range: [f64; 2],
    /// True if gene -1 maps to the high end and 1 to the low end.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    reversed: bool,
}

impl From<&Parameter> for Ranged {
    fn from(parameter: &Parameter) -> Self {
        let Parameter { name, ends: [first, other] } = parameter;
        Self { name: name.clone(), range: [first.min(*other), first.max(*other)], reversed: first > other }
    }
}

impl<'d> Introduction<'d> {
    pub(super) fn new(
        condition: &'d str,
        wanted: &'d RequestSchema,
        evaluator: &dyn Evaluator,
        longest_line: usize,
    ) -> Self {
        let behaviour = evaluator.behavior();
        Self {
            experiment: wanted.experiment,
            condition,
            seed: wanted.seed,
            populations: &wanted.populations,
            population_size: (wanted.size > 0).then_some(wanted.size),
            trials: evaluator.info().trials,
            terms: evaluator.info().terms,
            objectives: behaviour.map(Behavior::objectives).unwrap_or_default(),
            behaviour: behaviour.map(Behavior::measures).unwrap_or_default().iter().map(Ranged::from).collect(),
            longest_line,
            parameters: wanted.parameters.iter().map(Ranged::from).collect(),
        }
    }
}

/// Values of the only population, or of populations by their names.
pub(super) enum ByPopulation<'a, T> {
    Only(T),
    Named(Vec<(&'a str, T)>),
}

impl<T: Serialize> Serialize for ByPopulation<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Only(one) => one.serialize(serializer),
            Self::Named(all) => serializer.collect_map(all.iter().map(|(name, of)| (name, of))),
        }
    }
}

/// Values by their names, in their order.
struct Named<K, T>(Vec<(K, T)>);

impl<K: Serialize, T: Serialize> Serialize for Named<K, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, of)| (name, of)))
    }
}

impl<K, T> Named<K, T> {
    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// Answer to a line.
#[derive(Serialize)]
pub(super) struct Answer<'a> {
    pub(super) line: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) id: Option<serde_json::Value>,
    /// Fitness of every individual. Null for a failed one.
    pub(super) fitness: ByPopulation<'a, Vec<Option<f64>>>,
    pub(super) individuals: ByPopulation<'a, Vec<IndividualResult>>,
}

/// A refused line with the reason.
#[derive(Serialize)]
pub(super) struct Refusal<'a> {
    pub(super) line: u64,
    pub(super) error: &'a str,
}

/// Result of an individual.
#[derive(Serialize)]
pub(super) struct IndividualResult {
    pub(super) fitness: Option<f64>,
    #[serde(skip_serializing_if = "Named::is_empty")]
    objectives: Named<String, f64>,
    #[serde(skip_serializing_if = "Named::is_empty")]
    behaviour: Named<String, f64>,
    /// Why it failed, and in which trial.
    #[serde(skip_serializing_if = "Option::is_none")]
    failed: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    failed_trial: Option<u32>,
    trials: Vec<Trial>,
}

impl IndividualResult {
    /// Builds the result from a row of fitness, objectives and measures, and from the trials.
    pub(super) fn new(found: Result<Individual, FailedTrial>, evaluator: &dyn Evaluator) -> Self {
        let (objectives, behaviour) = (Named(Vec::new()), Named(Vec::new()));
        let (row, outcomes) = match found {
            Ok(found) => found,
            Err((failed_trial, why)) => {
                let (failed, trials) = (Some(why), Vec::new());
                return Self { fitness: None, objectives, behaviour, failed, failed_trial, trials };
            }
        };
        let described = evaluator.behavior();
        let objectives = described.map(Behavior::objectives).unwrap_or_default();
        let behaviour = described.map(Behavior::measures).unwrap_or_default().into_iter().map(|measure| measure.name);
        let mut row = row.into_iter();
        let fitness = row.next();
        let objectives = Named(objectives.into_iter().zip(row.by_ref()).collect());
        let behaviour = Named(behaviour.zip(row).collect());
        let terms = evaluator.info().terms;
        let trials = outcomes.into_iter().map(|outcome| Trial::new(outcome, &terms)).collect();
        Self { fitness, objectives, behaviour, failed: None, failed_trial: None, trials }
    }
}

/// Result of a trial.
#[derive(Serialize)]
struct Trial {
    terms: Named<String, f64>,
    steps: u32,
    success: bool,
    #[serde(skip_serializing_if = "Named::is_empty")]
    notes: Named<&'static str, serde_json::Value>,
}

impl Trial {
    fn new(outcome: Outcome, terms: &[String]) -> Self {
        let Outcome { terms: values, steps, success, notes, .. } = outcome;
        let value = |note: Note| match note {
            // NaN is null in JSON.
            Note::Number(x) => serde_json::Value::from(x),
            Note::Text(text) => text.into(),
        };
        Self {
            terms: Named(terms.iter().cloned().zip(values).collect()),
            steps,
            success,
            notes: Named(notes.into_iter().map(|(name, note)| (name, value(note))).collect()),
        }
    }
}
