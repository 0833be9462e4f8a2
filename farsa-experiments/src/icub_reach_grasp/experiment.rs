//! The experiment `icub-reach-grasp` as the `farsa` command runs it.

use farsa_lab::advanced::Lanes;
use farsa_lab::strategy::StrategyDefinition;
use farsa_lab::{Error, Evaluator, Experiment, InWorld, Setting, Settings};
use farsa_physics::articulated::{Batch, Model, World};

use crate::icub_reach_grasp::config::{Area, Config};
use crate::icub_reach_grasp::scene::{Scene, wrong};
use crate::icub_reach_grasp::task::GraspTask;
use crate::strategy::strategy;

/// Can an iCub reach a ball anywhere on a table, grasp it and lift it?
///
/// Its left eye sees the offset between ball and hand. Its head follows the ball by a reflex, so that the angles of neck and trunk
/// show the ball's place. Nine touch sensors feel it. The network commands angles of trunk, right arm and hand.
///
/// Deviations: only the openings of the source's pages were available. All other values are ours, and the settings mark them.
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

    fn settings(&self, condition: &str) -> Vec<Setting> {
        Config::for_area(Area::from_name(condition)).table()
    }

    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(evaluator(Config::read(settings)?)?))
    }
}

/// Evaluates under a configuration.
///
/// # Errors
/// [`Error::Setting`] and [`Error::Other`] for a configuration whose robot cannot be built.
pub fn evaluator(config: Config) -> Result<InWorld<World<f32>, GraspTask>, Error> {
    let scene = Scene::new(config)?;
    let model = Model::new(&scene.robot, &scene.options()).map_err(|error| wrong(&error))?;
    let world = World::new(model.clone());
    let batch = move |lanes: Lanes| {
        Batch::new(model.clone(), lanes.count(), lanes.instructions()).map_err(|error| wrong(&error))
    };
    Ok(InWorld::new(world, GraspTask::new(scene)?).with_lanes(batch).with_displacements().with_pushes())
}
