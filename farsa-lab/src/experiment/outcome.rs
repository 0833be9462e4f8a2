//! The outcome of a trial, and the description of a robot and its controller.

use std::fmt;

use farsa_evo::ObservationStatistics;

/// The outcome of one trial.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outcome {
    /// Terms of the fitness, named by [`TaskInfo::terms`](crate::TaskInfo::terms). A term that is not finite makes the
    /// individual a failed one.
    pub terms: Vec<f64>,
    /// Steps of the episode.
    pub steps: u32,
    /// Success of the trial. The definition may be stricter than the fitness.
    pub success: bool,
    /// Further results for `farsa test` by name, such as `("phase", "lift".into())`. Every trial has the same names.
    pub notes: Vec<(&'static str, Note)>,
    /// Statistics of the observations if the [`Evaluation`](crate::Evaluation) normalizes them, from
    /// [`NormalizedController::observed`](crate::advanced::NormalizedController::observed).
    pub observed: Option<ObservationStatistics>,
    /// Reason of a failure. A trial with a reason counts as failed whatever its terms are.
    pub failure: Option<Failure>,
}

/// Why a trial failed.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Failure {
    /// It panicked: the message and the place in the source.
    Panicked(String),
    /// Not ended after this number of steps, [`TaskInfo::step_budget`](crate::TaskInfo::step_budget).
    Endless(u64),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Panicked(why) => write!(f, "panicked: {why}"),
            Self::Endless(steps) => write!(f, "had not ended after {steps} steps, the most that the experiment names"),
        }
    }
}

impl Outcome {
    /// A trial that broke down: its individual is counted as failed and ranks last.
    pub fn failed() -> Self {
        Self { terms: vec![f64::NAN], ..Self::default() }
    }

    /// A trial that panicked, with its message.
    pub(crate) fn panicked(why: &str) -> Self {
        Self { failure: Some(Failure::Panicked(why.into())), ..Self::failed() }
    }

    /// Returns whether nothing failed and all terms are finite.
    pub fn is_finite(&self) -> bool {
        self.failure.is_none() && self.terms.iter().all(|term| term.is_finite())
    }

    /// Returns the reason of a failure as text. `names` holds the names of the terms.
    pub(crate) fn why_failed(&self, names: &[String]) -> Option<String> {
        if let Some(failure) = &self.failure {
            return Some(failure.to_string());
        }
        let (place, term) = self.terms.iter().enumerate().find(|(_, term)| !term.is_finite())?;
        let name = names.get(place).map_or("", String::as_str);
        Some(format!("the term `{name}` of the fitness is {term}"))
    }
}

/// The sum of all terms of all trials over their number: for experiments whose fitness is a mean.
pub fn mean_of_trials(trials: &[Outcome]) -> f64 {
    trials.iter().flat_map(|outcome| &outcome.terms).sum::<f64>() / trials.len().max(1) as f64
}

/// A value of [`Outcome::notes`].
#[derive(Debug, Clone, PartialEq)]
pub enum Note {
    /// A quantity. `farsa test` prints its mean.
    Number(f64),
    /// One of a few words. `farsa test` counts them.
    Text(String),
}

impl From<f64> for Note {
    fn from(x: f64) -> Self {
        Self::Number(x)
    }
}

impl From<&str> for Note {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

/// The robot and its controller in `farsa info`.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
pub struct Description {
    /// The sensors in the order of the network's inputs.
    pub sensors: Vec<ChannelGroup>,
    /// The motors in the order of the network's outputs.
    pub motors: Vec<ChannelGroup>,
    /// The controller in one line.
    pub network: String,
    /// Number of parameters that the genes become.
    pub parameters: usize,
    /// Most steps of a trial.
    pub steps: usize,
    /// Time between two steps \[s\]. 0 for an experiment without a clock.
    pub step_seconds: f64,
}

/// A group of sensor or motor channels.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct ChannelGroup {
    /// Name of the group.
    pub name: String,
    /// Number of channels.
    pub count: usize,
    /// Content with unit and range.
    pub meaning: String,
}

impl ChannelGroup {
    /// A group of channels.
    pub fn new(name: &str, count: usize, meaning: &str) -> Self {
        Self { name: name.into(), count, meaning: meaning.into() }
    }
}
