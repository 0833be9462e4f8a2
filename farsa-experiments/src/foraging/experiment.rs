//! The experiment `foraging`: a team carries food to its nest.

use farsa_lab::{EpisodeId, Error, Evaluator, Experiment, Outcome, Setting, Settings};
use farsa_nn::Controller;
use farsa_physics::arena::World;

use crate::foraging::config::ForagingConfig;
use crate::foraging::episode::{ForagingEpisode, ForagingScenario};
use crate::team::config::ROBOTS;
use crate::team::task::evaluator;

/// Can robots that see little and die soon feed a nest together? \[FARSA2\]
///
/// A team with one genome leaves the nest, takes the food that it drives over, and must be back before its energy is used up. The
/// condition is the robot. Arenas, nests, energy, steps, sensors, motors and hidden neurons are the source's. The number of robots,
/// the time step, the camera's view and the network's other traits are ours, as the settings show. The load of a robot is not
/// limited. Each infrared channel of a `MarXbot` is the largest of three of its 24 sensors. The source's bias neuron is the
/// network's biases, which only its hidden neurons have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Foraging;

impl Experiment for Foraging {
    fn name(&self) -> &'static str {
        "foraging"
    }

    fn summary(&self) -> &'static str {
        "a team of robots carries food to its nest and must be back there before its energy is used up"
    }

    fn conditions(&self) -> &'static [&'static str] {
        &ROBOTS
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        ForagingConfig::for_condition(condition).table()
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(evaluator(ForagingScenario::new(ForagingConfig::for_condition(condition).read(settings)?))?))
    }
}

/// Runs one trial of a team of any controllers and returns its outcome.
pub fn forage<C: Controller>(episode: &mut ForagingEpisode<C>, world: &mut World, id: EpisodeId) -> Outcome {
    farsa_lab::advanced::run_episode(episode, world, id, None);
    episode.outcome(0)
}
