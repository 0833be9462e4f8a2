//! Outcome of a trial, and the description of a robot and its controller.

use std::fmt;

use farsa_evo::ObservationStatistics;

/// Text of the success of a task that does not define it.
pub(crate) const NO_CRITERION: &str = "no criterion";

/// Outcome of one trial.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outcome {
    /// Terms of the fitness, with names given by [`TaskInfo::terms`](crate::TaskInfo::terms).
    ///
    /// If any of them is not finite, the individual counts as failed.
    pub terms: Vec<f64>,
    /// Steps of the episode.
    pub steps: u32,
    /// Success of the trial. Note that its definition may be stricter than the fitness.
    pub success: bool,
    /// Further results for `farsa test` by name, such as `("phase", "lift".into())`. Every trial has the same names.
    pub notes: Vec<(&'static str, Note)>,
    /// Statistics of the observations if the [`Evaluation`](crate::Evaluation) normalizes them, from
    /// [`NormalizedController::observed`](crate::advanced::NormalizedController::observed).
    pub observed: Option<ObservationStatistics>,
    /// Reason of a failure. If this is set, the trial counts as failed, even if all terms are finite.
    pub failure: Option<Failure>,
}

/// Reason for the failure of a trial.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Failure {
    /// A panic, with its message and the position in the source.
    Panicked(String),
    /// This occurs if an episode has not ended after [`TaskInfo::step_budget`](crate::TaskInfo::step_budget) steps.
    Endless(u64),
    /// This occurs if [`Evaluation::stop`](crate::Evaluation::stop) becomes true before the end of an episode.
    Interrupted,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Panicked(why) => write!(f, "panicked: {why}"),
            Self::Interrupted => f.write_str("was interrupted"),
            Self::Endless(steps) => write!(f, "had not ended after {steps} steps, the most that the experiment names"),
        }
    }
}

impl Outcome {
    /// Creates the outcome of a failed trial.
    ///
    /// Its only term is NaN, so the individual counts as failed and ranks last.
    pub fn failed() -> Self {
        Self { terms: vec![f64::NAN], ..Self::default() }
    }

    /// A trial that panicked, with its message.
    pub(crate) fn panicked(why: &str) -> Self {
        Self { failure: Some(Failure::Panicked(why.into())), ..Self::failed() }
    }

    /// Checks that there is no failure and that all terms are finite.
    pub fn is_finite(&self) -> bool {
        self.failure.is_none() && self.terms.iter().all(|term| term.is_finite())
    }

    /// Finds the reason of a failure as text. `names` holds the names of the terms.
    pub(crate) fn why_failed(&self, names: &[String]) -> Option<String> {
        if let Some(failure) = &self.failure {
            return Some(failure.to_string());
        }
        let (place, term) = self.terms.iter().enumerate().find(|(_, term)| !term.is_finite())?;
        let name = names.get(place).map_or("", String::as_str);
        Some(format!("the term `{name}` of the fitness is {term}"))
    }
}

/// Combination of the trials of an individual into its fitness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Combination {
    /// Sum over the trials.
    Sum,
    /// Mean over the trials.
    Mean,
    /// Smallest fitness of a trial.
    Worst,
}

impl fmt::Display for Combination {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Sum => "sum",
            Self::Mean => "mean",
            Self::Worst => "worst",
        })
    }
}

/// Computes the sum of all terms, divided by the number of trials.
///
/// Use this to implement [`Task::fitness`](crate::Task::fitness) if the fitness of your experiment is a mean over trials.
pub fn mean_of_trials(trials: &[Outcome]) -> f64 {
    trials.iter().flat_map(|outcome| &outcome.terms).sum::<f64>() / trials.len().max(1) as f64
}

/// A value of [`Outcome::notes`].
#[derive(Debug, Clone, PartialEq)]
pub enum Note {
    /// A quantity. `farsa test` prints its mean.
    Number(f64),
    /// A category, given by a word. `farsa test` counts how often each word occurs.
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

/// Description of a robot and its controller, as shown by `farsa info`.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
pub struct Description {
    /// Sensors, in the same order as the inputs of the network.
    pub sensors: Vec<ChannelGroup>,
    /// Motors, in the same order as the outputs of the network.
    pub motors: Vec<ChannelGroup>,
    /// Short description of the controller, in one line.
    pub network: String,
    /// Number of parameters that the genes become.
    pub parameters: usize,
    /// Maximum number of steps in a trial.
    pub steps: usize,
    /// Time between two steps \[s\]. Use 0 if your experiment has no clock.
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
    /// Creates a group with the given number of channels.
    pub fn new(name: &str, count: usize, meaning: &str) -> Self {
        Self { name: name.into(), count, meaning: meaning.into() }
    }
}
