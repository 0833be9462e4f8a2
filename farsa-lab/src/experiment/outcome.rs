//! What comes of a trial, and what is told of a robot and its controller.

/// What came of one trial.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outcome {
    /// The terms of the fitness, named by [`Task::terms`](crate::Task::terms); a term that is not finite makes the individual a failed one.
    pub terms: Vec<f64>,
    /// Steps of the episode.
    pub steps: u32,
    /// Whether the trial succeeded, by a definition that may be stricter than the fitness.
    pub success: bool,
    /// What else `farsa test` tells about the trial, by name: `("phase", "lift".into())`; the same names in every trial.
    pub notes: Vec<(&'static str, Note)>,
}

impl Outcome {
    /// A trial that broke down: its individual is counted as failed and ranks last.
    pub fn failed() -> Self {
        Self { terms: vec![f64::NAN], ..Self::default() }
    }

    /// Whether all terms are finite.
    pub fn is_finite(&self) -> bool {
        self.terms.iter().all(|term| term.is_finite())
    }
}

/// The sum of all terms of all trials over their number: for experiments whose fitness is a mean.
pub fn mean_of_trials(trials: &[Outcome]) -> f64 {
    trials.iter().flat_map(|outcome| &outcome.terms).sum::<f64>() / trials.len().max(1) as f64
}

/// A value of [`Outcome::notes`].
#[derive(Debug, Clone, PartialEq)]
pub enum Note {
    /// A quantity; `farsa test` gives its mean.
    Number(f64),
    /// One of a few words; `farsa test` counts them.
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

/// What `farsa info` tells about a robot and its controller.
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
    /// Time between two steps \[s\]; 0 if the experiment has no clock.
    pub step_seconds: f64,
}

/// A group of sensor or motor channels.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct ChannelGroup {
    /// What they are called.
    pub name: String,
    /// How many there are.
    pub count: usize,
    /// What they hold, with unit and range.
    pub meaning: String,
}

impl ChannelGroup {
    /// A group of channels.
    pub fn new(name: &str, count: usize, meaning: &str) -> Self {
        Self { name: name.into(), count, meaning: meaning.into() }
    }
}
