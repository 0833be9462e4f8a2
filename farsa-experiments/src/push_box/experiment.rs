//! The experiment `push-box`. It requires a world with movable objects.

use farsa_lab::{Error, Evaluator, Experiment, Setting, Settings};

use crate::push_box::config::PushConfig;
#[cfg(feature = "rapier")]
use crate::push_box::episode::{OUTPUTS, PushEpisode};
#[cfg(feature = "rapier")]
use crate::push_box::task::{Layer, layer};

/// A robot has to push a box that it can only detect with infrared sensors.
///
/// An e-puck moves on an unbounded plane. A layer of two logistic units reads its eight infrared sensors, which are
/// simulated by rays, and drives the wheels. The robot starts near the box, often without sensing it. The reward of a
/// trial is the displacement of the box after 20 s in meters, and the fitness is the mean over the trials.
///
/// The experiment runs only in rapier, where the robot is a rigid body with driven wheels
/// (`farsa_physics::rapier::ArenaWorld`). Therefore the feature `rapier` must be enabled. All values were chosen for
/// this experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PushBox;

impl Experiment for PushBox {
    fn name(&self) -> &'static str {
        "push-box"
    }

    // 2: wheels keep their speed under load, and a trial takes 20 s.
    fn values_version(&self) -> u32 {
        2
    }

    fn summary(&self) -> &'static str {
        if cfg!(feature = "rapier") {
            "an e-puck pushes a box as far as it can, by its infrared sensors alone, in rapier"
        } else {
            "an e-puck pushes a box as far as it can, in rapier, which needs a build with --features rapier"
        }
    }

    fn settings(&self, _: &str) -> Vec<Setting> {
        PushConfig::default().table()
    }

    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        let config = PushConfig::default().read(settings)?;
        #[cfg(feature = "rapier")]
        return Ok(Box::new(evaluator(config)?));
        #[cfg(not(feature = "rapier"))]
        {
            let _ = config;
            Err(crate::worlds::missing("rapier"))
        }
    }
}

/// Evaluates under a configuration, in rapier.
///
/// # Errors
/// [`Error::Other`] for values that make no world.
#[cfg(feature = "rapier")]
pub(crate) fn evaluator(
    config: PushConfig,
) -> Result<farsa_lab::InWorld<farsa_physics::rapier::ArenaWorld, PushEpisode<Layer>>, Error> {
    let inputs = config.inputs();
    let layer = layer(inputs, vec![0.0; farsa_nn::Perceptron::parameter_count(inputs, OUTPUTS)])?;
    let world = config.world()?;
    Ok(farsa_lab::InWorld::new(world, PushEpisode::new(config, layer)?).with_displacements().with_pushes())
}
