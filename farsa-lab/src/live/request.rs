//! Requests to a session and their answers, as JSON.

use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use crate::experiment::{Displacement, Push};
use crate::live::bytes::Bytes;
use crate::live::page_run::PageIndividual;

/// A request to a session.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum Request {
    /// Run and record an episode.
    #[serde(rename = "film")]
    Episode(EpisodeRequest),
    /// Evaluate `count` fresh trials from number `first`, with changes of the controller.
    Fresh {
        individual: usize,
        #[serde(default)]
        lesion: String,
        seed: u64,
        first: usize,
        count: usize,
    },
    /// List the parts of the controller that can be changed.
    Names,
    /// Add an individual.
    Add { individual: PageIndividual },
    /// Return an individual.
    Individual { individual: usize },
    /// Return the genes of an individual as a `.gen` file.
    Genotype { individual: usize },
    /// Identify the state of the evolution.
    State,
    /// Evaluate a part of the current generation.
    Share { part: usize, parts: usize },
    /// Report the outcomes of all parts, from which the next generation is made.
    Tell { outcomes: Vec<Bytes> },
}

/// An episode of an individual, with changes of its controller and with moves and pushes of bodies.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct EpisodeRequest {
    pub(crate) individual: usize,
    pub(crate) trial: TrialRequest,
    #[serde(default)]
    pub(crate) lesion: String,
    #[serde(default)]
    pub(crate) moves: Vec<Displacement>,
    #[serde(default)]
    pub(crate) pushes: Vec<Push>,
    /// Recorded robot, where there are several.
    #[serde(default)]
    pub(crate) watched: Option<u32>,
}

impl EpisodeRequest {
    /// Requests a trial of the run.
    pub(crate) fn of_run(individual: usize, trial: u32) -> Self {
        let (trial, lesion) = (TrialRequest::Number(trial), String::new());
        Self { individual, trial, lesion, moves: Vec::new(), pushes: Vec::new(), watched: None }
    }
}

/// A trial of the run or a fresh one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum TrialRequest {
    /// A trial of the run, by its number.
    Number(u32),
    /// A trial of `farsa test`, by its number there.
    Fresh { number: usize, seed: u64 },
}

/// A recorded episode.
#[derive(Debug, Serialize)]
pub(crate) struct EpisodeAnswer {
    /// An entry of `episodes` of a page.
    #[serde(rename = "film")]
    pub(crate) episode: Box<RawValue>,
    /// Hash of the episode after each step.
    pub(crate) digests: Vec<u32>,
    pub(crate) steps: u32,
    /// NaN if the episode failed.
    pub(crate) fitness: f64,
    /// `None` for a task without a criterion of success.
    pub(crate) success: Option<bool>,
}

/// Number of an added individual.
#[derive(Debug, Serialize)]
pub(crate) struct AddedIndividual {
    pub(crate) individual: usize,
}

/// Genes of an individual.
#[derive(Debug, Serialize)]
pub(crate) struct GenotypeText {
    pub(crate) text: String,
}

/// Outcomes of a part of a generation.
#[derive(Debug, Serialize)]
pub(crate) struct SharedOutcomes {
    pub(crate) outcomes: Bytes,
}

/// Results of fresh trials.
#[derive(Debug, Default, PartialEq, Serialize)]
pub(crate) struct FreshResults {
    pub(crate) trials: usize,
    /// `None` for a task without a criterion of success.
    pub(crate) successes: Option<usize>,
    /// Fitness of each trial, NaN for a failed one.
    pub(crate) fitness: Vec<f64>,
}
