//! Registration of `icub-reach` as an experiment of the `farsa` command.

use farsa_lab::advanced::Lanes;
use farsa_lab::strategy::StrategyDefinition;
use farsa_lab::{Error, Evaluator, Experiment, InWorld, Setting, Settings};
use farsa_physics::articulated::{Batch, Model, ModelError, World};

use crate::icub_reach::config::{Condition, Config};
use crate::icub_reach::scene::Scene;
use crate::icub_reach::task::ReachTask;
use crate::strategy::strategy;

/// An iCub has to reach any target in front of it with six joints and a network without memory.
///
/// The controlled joints are the yaw and pitch of the torso and the shoulder and elbow of the left arm. All other
/// joints keep their angles. With the condition `steady`, the network senses the target and commands joint angles,
/// which are constant during a trial. With `velocity`, it senses the vector from the hand to the target and commands
/// joint speeds.
///
/// Only the first pages of the sources were available. All other values had to be chosen. The settings mark them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct IcubReach;

impl Experiment for IcubReach {
    fn name(&self) -> &'static str {
        "icub-reach"
    }

    // 2: sweeps of contacts that settle.
    fn values_version(&self) -> u32 {
        2
    }

    fn summary(&self) -> &'static str {
        "the left hand of an iCub reaches for targets in front of it, by angles or by speeds of six joints"
    }

    fn conditions(&self) -> &'static [&'static str] {
        &Condition::NAMES
    }

    /// For 46 parameters the covariances can be learned.
    fn strategy(&self, _: &str) -> &'static dyn StrategyDefinition {
        strategy("cma-es")
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        Config::for_condition(Condition::from_name(condition)).table()
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(evaluator(Config::read(Condition::from_name(condition), settings)?)?))
    }
}

/// Creates an evaluator for the given configuration.
///
/// # Errors
/// Returns [`Error::Setting`] or [`Error::Other`] if the robot cannot be built.
pub fn evaluator(config: Config) -> Result<InWorld<World<f32>, ReachTask>, Error> {
    let wrong = |error: ModelError| Error::Other(format!("icub-reach: {error}"));
    let scene = Scene::new(config)?;
    let model = Model::new(&scene.robot, &scene.options()).map_err(wrong)?;
    let world = World::new(model.clone());
    let batch = move |lanes: Lanes| Batch::new(model.clone(), lanes.count(), lanes.instructions()).map_err(wrong);
    Ok(InWorld::new(world, ReachTask::new(scene)?).with_lanes(batch).with_displacements().with_pushes())
}
