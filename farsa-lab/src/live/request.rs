//! What is asked of a session and what it answers, as JSON.

use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use crate::experiment::{Displacement, Push};
use crate::live::bytes::Bytes;
use crate::live::script::Evolved;

/// What is asked.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum Request {
    /// A trial, step by step.
    Film(Film),
    /// What comes of so many fresh trials, from one of a number on, with changes.
    Fresh {
        individual: usize,
        #[serde(default)]
        lesion: String,
        seed: u64,
        first: usize,
        count: usize,
    },
    /// The names of what can be changed.
    Names,
    /// Another individual, to be asked for by the number that is the answer.
    Add { individual: Evolved },
    /// What a part of the generation that evolution has come to earns.
    Share { part: usize, parts: usize },
    /// What all parts have come to: the next generation is made.
    Tell { outcomes: Vec<Bytes> },
}

/// A trial of an individual, with changes of its controller, a list or none, and with bodies that are put elsewhere or pushed.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Film {
    pub(crate) individual: usize,
    pub(crate) trial: Trial,
    #[serde(default)]
    pub(crate) lesion: String,
    #[serde(default)]
    pub(crate) moves: Vec<Displacement>,
    #[serde(default)]
    pub(crate) pushes: Vec<Push>,
    /// Of several robots the one that is recorded.
    #[serde(default)]
    pub(crate) watched: Option<u32>,
}

impl Film {
    /// The trial as it was in the run.
    pub(crate) fn of_run(individual: usize, trial: u32) -> Self {
        let (trial, lesion) = (Trial::Number(trial), String::new());
        Self { individual, trial, lesion, moves: Vec::new(), pushes: Vec::new(), watched: None }
    }
}

/// Which trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Trial {
    /// One of the run, by its number.
    Number(u32),
    /// One of `farsa test`, by its number there.
    Fresh { number: usize, seed: u64 },
}

/// A trial that was run.
#[derive(Debug, Serialize)]
pub(crate) struct Filmed {
    /// As a page has it in `lives`.
    pub(crate) film: Box<RawValue>,
    /// What the trial was like up to each step.
    pub(crate) digests: Vec<u32>,
    pub(crate) steps: u32,
    /// No number if it failed.
    pub(crate) fitness: f64,
    pub(crate) success: bool,
}

/// The number by which an individual is asked for.
#[derive(Debug, Serialize)]
pub(crate) struct Added {
    pub(crate) individual: usize,
}

/// What a part of a generation came to.
#[derive(Debug, Serialize)]
pub(crate) struct Shared {
    pub(crate) outcomes: Bytes,
}

/// What came of fresh trials.
#[derive(Debug, Default, PartialEq, Serialize)]
pub(crate) struct Earned {
    pub(crate) trials: usize,
    pub(crate) successes: usize,
    /// Of each trial; no number of one that failed.
    pub(crate) fitness: Vec<f64>,
}
