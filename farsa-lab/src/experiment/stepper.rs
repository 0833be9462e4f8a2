//! Worlds that a caller steps with its own actions.

use farsa_body::Recorder;

use crate::error::Error;
use crate::experiment::episode::EpisodeId;
use crate::experiment::outcome::Outcome;

/// Result of a step in a world.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct StepResult {
    /// Increase of the trial's fitness. It is 0 in a step that failed.
    pub reward: f64,
    /// True if the task ended the episode, or if the step failed.
    pub terminated: bool,
    /// True if the number of steps ended the episode.
    pub truncated: bool,
    /// True if a number is not finite. Such a trial has no fitness.
    pub failed: bool,
}

impl StepResult {
    /// Checks whether the episode ended.
    pub fn is_last(&self) -> bool {
        self.terminated || self.truncated
    }
}

/// Worlds that a caller steps, each with its own episode. Created by
/// [`Evaluator::into_stepper`](crate::Evaluator::into_stepper).
///
/// A world has the same bits alone and in a lane. Worlds whose episode has ended are not stepped until their next start.
pub trait Stepper: Send {
    /// Gets the number of worlds.
    fn worlds(&self) -> usize;

    /// Gets the numbers of observed channels and of actions.
    fn channels(&self) -> [usize; 2];

    /// Starts an episode in a world and writes its first observation. Returns false if something finds no place.
    fn start(&mut self, world: usize, id: EpisodeId, observation: &mut [f32]) -> bool;

    /// Steps all worlds with an episode. Rows of actions and observations belong to the worlds in order, and there is a
    /// result for each. Fewer rows than worlds are allowed. The rows of worlds without an episode do not change.
    fn step(&mut self, actions: &[f32], results: &mut [StepResult], observations: &mut [f32]);

    /// Gets the fitness of a world's episode so far, which is the sum of its rewards.
    fn earned(&self, world: usize) -> f64;

    /// Builds the outcome of the last episode of a world that has ended.
    fn outcome(&self, world: usize) -> Outcome;

    /// Records the current state of a world, as after a step.
    fn record(&mut self, world: usize, recorder: &mut dyn Recorder);
}

/// Creates the error of an experiment that cannot be stepped.
pub(crate) fn not_stepped(why: &str) -> Error {
    Error::Usage(format!("this experiment cannot be stepped: {why}"))
}
