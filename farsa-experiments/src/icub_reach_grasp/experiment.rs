//! Registration of `icub-reach-grasp` as an experiment of the `farsa` command.

use farsa_lab::advanced::Lanes;
use farsa_lab::strategy::StrategyDefinition;
use farsa_lab::{Error, Evaluator, Experiment, InWorld, Setting, Settings};
use farsa_physics::articulated::{Batch, Model, World};

use crate::icub_reach_grasp::config::{Area, Config};
use crate::icub_reach_grasp::scene::{Scene, wrong};
use crate::icub_reach_grasp::task::GraspTask;
use crate::strategy::strategy;

/// An iCub has to reach for a ball on a table, grasp it and lift it.
///
/// The left eye measures the offset between the ball and the hand. Since the head follows the ball by a reflex, the
/// angles of the neck and the trunk indicate the position of the ball. In addition there are nine touch sensors. The
/// network commands the joint angles of the trunk, the right arm and the hand.
///
/// Only the first pages of the sources were available. All other values had to be chosen. The settings mark them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct IcubReachGrasp;

impl Experiment for IcubReachGrasp {
    fn name(&self) -> &'static str {
        "icub-reach-grasp"
    }

    fn summary(&self) -> &'static str {
        "the right hand of an iCub reaches for a ball on a table, grasps it and lifts it"
    }

    /// The area in which the ball lies during evolution.
    fn conditions(&self) -> &'static [&'static str] {
        &Area::NAMES
    }

    /// For 198 parameters standard deviations can be learned, and not their covariances.
    fn strategy(&self, _: &str) -> &'static dyn StrategyDefinition {
        strategy("snes")
    }

    // 2: contacts of two boxes. 3: sweeps that settle.
    fn values_version(&self) -> u32 {
        3
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        Config::for_area(Area::from_name(condition)).table()
    }

    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(evaluator(Config::read(settings)?)?))
    }
}

/// Creates an evaluator for the given configuration.
///
/// # Errors
/// Returns [`Error::Setting`] or [`Error::Other`] if the robot cannot be built.
pub fn evaluator(config: Config) -> Result<InWorld<World<f32>, GraspTask>, Error> {
    let scene = Scene::new(config)?;
    let model = Model::new(&scene.robot, &scene.options()).map_err(|error| wrong(&error))?;
    let world = World::new(model.clone());
    let batch = move |lanes: Lanes| {
        Batch::new(model.clone(), lanes.count(), lanes.instructions()).map_err(|error| wrong(&error))
    };
    Ok(InWorld::new(world, GraspTask::new(scene)?).with_lanes(batch).with_displacements().with_pushes())
}
