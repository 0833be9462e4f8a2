//! The experiment `predator-prey`: two populations evolve against each other.

use farsa_lab::{EpisodeId, Error, Evaluator, Experiment, Outcome, Setting, Settings};
use farsa_nn::Controller;
use farsa_physics::arena::World;

use crate::predator_prey::config::PredatorPreyConfig;
use crate::predator_prey::episode::{PredatorPreyEpisode, PredatorPreyScenario};
use crate::team::task::evaluator;

/// Do a predator and a prey that evolve against each other become better at both? \[FARSA2\]
///
/// Two `MarXbots` of the same abilities in a walled arena. The predators, the first population, earn 1 - t/T for touching the prey
/// at step t of T, else nothing. The prey, the second, earn the rest of 1. Arena, starts, T and rewards are the source's. Headings,
/// sensors, network and evolution are ours, as the settings show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PredatorPrey;

impl Experiment for PredatorPrey {
    fn name(&self) -> &'static str {
        "predator-prey"
    }

    fn summary(&self) -> &'static str {
        "a robot chases another one, and both evolve against each other in two populations"
    }

    fn settings(&self, _: &str) -> Vec<Setting> {
        PredatorPreyConfig::default().table()
    }

    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(evaluator(PredatorPreyScenario::new(PredatorPreyConfig::default().read(settings)?))?))
    }
}

/// Runs one trial of any two controllers and returns the predator's outcome.
pub fn chase<C: Controller>(episode: &mut PredatorPreyEpisode<C>, world: &mut World, id: EpisodeId) -> Outcome {
    farsa_lab::advanced::run_episode(episode, world, id, None);
    episode.outcome(0)
}
