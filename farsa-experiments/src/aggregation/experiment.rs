//! The experiment `aggregation`: a team gathers on nests.

use farsa_lab::{EpisodeId, Error, Evaluator, Experiment, Outcome, Setting, Settings};
use farsa_nn::Controller;
use farsa_physics::arena::World;

use crate::aggregation::config::AggregationConfig;
use crate::aggregation::episode::{AggregationEpisode, AggregationScenario};
use crate::team::config::ROBOTS;
use crate::team::task::evaluator;

/// Can robots that feel a nest only when they are on it gather there, with each other's help? \[FARSA2\]
///
/// A team with one genome starts anywhere in an arena. When the time is up, every robot earns 100 on a nest, and up to 1 for being
/// near the others. The condition is the robot. Arena, steps and rewards of the `MarXbot`s are the source's. Nests and all values
/// that the settings call chosen are ours. Sensors and motors are those of `foraging` without energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Aggregation;

impl Experiment for Aggregation {
    fn name(&self) -> &'static str {
        "aggregation"
    }

    fn summary(&self) -> &'static str {
        "a team of robots gathers on nests that each feels only when it is on them"
    }

    fn conditions(&self) -> &'static [&'static str] {
        &ROBOTS
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        AggregationConfig::for_condition(condition).table()
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(evaluator(AggregationScenario::new(AggregationConfig::for_condition(condition).read(settings)?))?))
    }
}

/// Runs one trial of a team of any controllers and returns its outcome.
pub fn aggregate<C: Controller>(episode: &mut AggregationEpisode<C>, world: &mut World, id: EpisodeId) -> Outcome {
    farsa_lab::advanced::run_episode(episode, world, id, None);
    episode.outcome(0)
}
