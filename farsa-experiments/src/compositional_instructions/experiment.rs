//! The experiment `compositional-instructions` as the `farsa` command runs it.

use farsa_lab::{Error, Evaluator, Experiment, InWorld, Lanes, Setting, Settings, StrategyDefinition};
use farsa_physics::articulated::{Batch, Model, World};

use crate::compositional_instructions::config::Config;
use crate::compositional_instructions::instruction::Condition;
use crate::compositional_instructions::scene::Scene;
use crate::compositional_instructions::task::InstructionTask;
use crate::strategy::strategy;

/// How does an agent come to understand two words that it never heard together? \[Tuci2011; Ferrauto2010, chapter 3\]
///
/// An arm in the plane is told an action and an object, and evolves to follow seven of nine instructions. "TOUCH green" and
/// "MOVE red" are held out: it is asked them in the test only. Under `with-indicate` the actions are INDICATE, TOUCH and MOVE,
/// under `with-ignore` IGNORE takes the place of INDICATE.
///
/// Deviations: what the sources' abstracts and excerpts do not say is of our own making, and the settings say which that is. A
/// sensory neuron reaches the inner ones a step later. IGNORE asks that the target be the object that was seen last: were
/// looking at nothing enough, an agent that did not know the object word could follow all three of its instructions.
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

    // 2: reaching counts while the target is centred, a push in TOUCH costs less, the second joint starts on one side.
    // 3: IGNORE asks in every one of the last steps which object was seen last, not at the end alone, and earns half for a look past
    // it; the standard deviations learn at half the rate.
    fn values_version(&self) -> u32 {
        3
    }

    /// Natural evolution strategies: the truncation algorithm had not found the objects after nine million lives.
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

/// Evaluates under a configuration.
///
/// # Errors
/// [`Error::Setting`] and [`Error::Other`] for a configuration whose scene or network cannot be built.
pub fn evaluator(config: Config) -> Result<InWorld<World<f32>, InstructionTask>, Error> {
    let wrong =
        |error: farsa_physics::articulated::ModelError| Error::Other(format!("compositional-instructions: {error}"));
    let scene = Scene::new(config)?;
    let model = Model::new(&scene.robot, &scene.options()).map_err(wrong)?;
    let world = World::new(model.clone());
    let batch = move |lanes: Lanes| Batch::new(model.clone(), lanes.count(), lanes.instructions()).map_err(wrong);
    Ok(InWorld::new(world, InstructionTask::new(scene)?).with_lanes(batch).with_displacements().with_pushes())
}
