//! Registration of `compositional-instructions` as an experiment of the `farsa` command.

use farsa_lab::advanced::Lanes;
use farsa_lab::strategy::StrategyDefinition;
use farsa_lab::{Error, Evaluator, Experiment, InWorld, Setting, Settings};
use farsa_physics::articulated::{Batch, Model, World};

use crate::compositional_instructions::config::Config;
use crate::compositional_instructions::instruction::Condition;
use crate::compositional_instructions::scene::Scene;
use crate::compositional_instructions::task::InstructionTask;
use crate::strategy::strategy;

/// Tests if an agent can combine two words that it has never received together \[Tuci2011\] \[Ferrauto2010, chapter
/// 3\].
///
/// An arm in the plane receives an action and an object, and evolves to follow seven of nine instructions. The
/// instructions "TOUCH green" and "MOVE red" are held out for the test. With the condition `with-indicate`, the actions
/// are INDICATE, TOUCH and MOVE. With `with-ignore`, IGNORE replaces INDICATE.
///
/// The implementation deviates from the sources, of which only abstracts and excerpts were available. The settings mark
/// all values that had to be chosen. A sensory neuron influences the inner neurons one step later. IGNORE requires that
/// the target was the last object in view. Otherwise an agent without access to the object word could follow all three
/// instructions with this action by looking away from everything.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct CompositionalInstructions;

impl Experiment for CompositionalInstructions {
    fn name(&self) -> &'static str {
        "compositional-instructions"
    }

    fn summary(&self) -> &'static str {
        "an arm learns instructions of two words, and is asked some that it never heard"
    }

    fn conditions(&self) -> &'static [&'static str] {
        &Condition::NAMES
    }

    // 2: reaching counts while the target is centered, a push in TOUCH costs less, the second joint starts on one side. 3: IGNORE
    // checks the object last in view in every one of the last steps, and earns half for a look past it. The standard deviations
    // learn at half the rate.
    fn values_version(&self) -> u32 {
        3
    }

    /// Natural evolution strategies: truncation selection did not find the objects in nine million trials.
    fn strategy(&self, _: &str) -> &'static dyn StrategyDefinition {
        strategy("snes")
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
/// Returns [`Error::Setting`] or [`Error::Other`] if the scene or the network cannot be built.
pub fn evaluator(config: Config) -> Result<InWorld<World<f32>, InstructionTask>, Error> {
    let wrong =
        |error: farsa_physics::articulated::ModelError| Error::Other(format!("compositional-instructions: {error}"));
    let scene = Scene::new(config)?;
    let model = Model::new(&scene.robot, &scene.options()).map_err(wrong)?;
    let world = World::new(model.clone());
    let batch = move |lanes: Lanes| Batch::new(model.clone(), lanes.count(), lanes.instructions()).map_err(wrong);
    Ok(InWorld::new(world, InstructionTask::new(scene)?).with_lanes(batch).with_displacements().with_pushes())
}
