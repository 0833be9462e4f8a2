//! The experiment `kinesthetic-grasp`, in which a network learns to grasp from demonstrations.

use std::sync::Arc;

use farsa_body::Recorder;
use farsa_physics::articulated::World;

use crate::kinesthetic_grasp::trainer::{Trainer, Training};
use crate::reach_grasp_lift::config::{Config as Reach, Labels};
use crate::reach_grasp_lift::experiment::evaluator;
use crate::reach_grasp_lift::scene::Scene;
use crate::reach_grasp_lift::task::ReachTask;
use crate::worlds::Engine;
use farsa_lab::advanced::{ENGINE, InLanes, Learner};
use farsa_lab::exports::Exports;
use farsa_lab::strategy::{Learning, StrategyDefinition};
use farsa_lab::{Error, Evaluation, Evaluator, Experiment, InWorld, Outcome, Setting, Settings, Task, TaskInfo};

/// Trains the network of [`reach-grasp-lift`](crate::reach_grasp_lift::ReachGraspLift) with demonstrations of the task.
///
/// The robot, the sensors, the motors, the trials and the fitness are those of `reach-grasp-lift` with labels. Instead
/// of evolving a population, this experiment trains a single network. A scripted grasp guides the arm through the
/// phases reach, grasp and lift while the sensor values and the desired motor values are recorded. The network learns
/// the desired motor values with back-propagation through time. In every generation the network is first evaluated in
/// the four trials to determine its fitness. Then an iteration of the training follows. The errors are written to
/// `learning.csv` in the directory of the run.
///
/// The desired motor values are computed by the script for the current state of the arm. A network trained only with
/// states of the script cannot correct its errors. Therefore the commands of the network are mixed into the
/// demonstrations \[Ross2011\]. The first demonstration of an iteration is executed by the script alone, and the share
/// of the network in the last one increases with each iteration. The network that is evaluated and mixed in is an
/// average over the latest gradient steps \[Polyak1992\].
///
/// Unlike `reach-grasp-lift`, the network has 24 hidden neurons, a slope of 1 and weights up to 20. With a slope of 0.2
/// and weights up to 6, two layers do not reach the gain of the script's feedback.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct KinestheticGrasp;

/// The configuration of `kinesthetic-grasp`.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// Configuration of the robot, its world, its network and its trials.
    pub reach: Reach,
    /// Configuration of the training.
    pub training: Training,
}

impl Default for Config {
    fn default() -> Self {
        let reach = Reach { hidden: 24, slope: 1.0, weight_range: 20.0, ..Reach::default() };
        Self { reach, training: Training::default() }
    }
}

impl Config {
    /// Reads a configuration from settings that have been checked.
    ///
    /// # Errors
    /// Returns the errors of `reach-grasp-lift`. It returns [`Error::Setting`] if another world is selected, because
    /// the arm can only be guided in the articulated world.
    pub fn read(settings: &Settings) -> Result<Self, Error> {
        let reach = Reach::read(Labels::Given, settings)?;
        if reach.engine != Engine::Articulated {
            return Err(Error::setting(ENGINE, "the arm is guided in our own world alone"));
        }
        let count = |key: &str| settings.count(key).map(|count| count as u32);
        let training = Training {
            demonstrations: count("lessons.demonstrations")?,
            epochs: count("lessons.passes")?,
            batch: count("lessons.batch")?,
            rate: settings.number("lessons.rate")?,
            half_rate: settings.number("lessons.half_rate")?,
            averaging: count("lessons.mean")?,
            mixing: count("lessons.own_say")?,
        };
        Ok(Self { reach, training })
    }
}

impl Experiment for KinestheticGrasp {
    fn name(&self) -> &'static str {
        "kinesthetic-grasp"
    }

    // 2: the network is averaged over the latest gradient steps, with more demonstrations and fewer epochs.
    // 3: contacts of palm and table are those of two boxes. 4: dynamics steps of 5 ms in halves, and sweeps that settle.
    fn values_version(&self) -> u32 {
        4
    }

    fn summary(&self) -> &'static str {
        "the arm is guided through reach, grasp and lift, and a network learns by back-propagation to do it alone"
    }

    fn strategy(&self, _: &str) -> &'static dyn StrategyDefinition {
        &Learning
    }

    fn settings(&self, _: &str) -> Vec<Setting> {
        let Config { reach, training } = Config::default();
        let whole = |key: &str, value: u32, range| Setting::whole(key, i64::from(value), range);
        let mut table = vec![
            Setting::whole("evolution.generations", 250, 1..=i64::from(u32::MAX) - 1)
                .doc("Iterations of training, each after an evaluation of the network. A resumed run may change it, and nothing else."),
            whole("lessons.demonstrations", training.demonstrations, 1..=10_000)
                .doc("Demonstrations in an iteration, each from another start. The four trials take turns."),
            whole("lessons.passes", training.epochs, 1..=1000).doc("Epochs: how often an iteration learns from each of them."),
            whole("lessons.batch", training.batch, 1..=10_000).doc("Demonstrations in a gradient step."),
            Setting::number("lessons.rate", training.rate, 0.0..=1.0).doc("Learning rate of Adam."),
            Setting::number("lessons.half_rate", training.half_rate, 1.0..=1e9)
                .doc("Iterations after which the rate is half, and a third after twice as many."),
            whole("lessons.mean", training.averaging, 1..=1_000_000)
                .doc("Gradient steps over which the network is averaged. 1 takes the latest network."),
            whole("lessons.own_say", training.mixing, 0..=1_000_000)
                .doc("Iterations until the network alone acts in the last demonstration of an iteration, 0 if it never does."),
        ];
        table.append(&mut reach.table());
        table
    }

    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(Trainee::new(Config::read(settings)?)?))
    }
}

/// Evaluates a network in the trials of `reach-grasp-lift` and trains it after each evaluation.
pub struct Trainee {
    evaluator: InWorld<World<f32>, ReachTask>,
    trainer: Trainer,
}

impl Trainee {
    /// Creates the trials and the training for a configuration.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the robot or the network cannot be built.
    pub fn new(config: Config) -> Result<Self, Error> {
        let scene = Arc::new(Scene::new(config.reach.clone())?);
        Ok(Self { evaluator: evaluator(config.reach)?, trainer: Trainer::new(scene, config.training)? })
    }
}

impl Task for Trainee {
    fn info(&self) -> TaskInfo {
        self.evaluator.info()
    }

    fn fitness(&self, trials: &[Outcome]) -> f64 {
        self.evaluator.fitness(trials)
    }

    fn exports(&self) -> Option<&dyn Exports> {
        self.evaluator.exports()
    }
}

impl Evaluator for Trainee {
    fn evaluate(&mut self, evaluation: Evaluation<'_>, recorder: Option<&mut dyn Recorder>) -> Outcome {
        self.evaluator.evaluate(evaluation, recorder)
    }

    fn record_start(&mut self, evaluation: Evaluation<'_>, recorder: &mut dyn Recorder) -> bool {
        self.evaluator.record_start(evaluation, recorder)
    }

    fn in_lanes(&mut self) -> Option<&mut dyn InLanes> {
        self.evaluator.in_lanes()
    }

    fn learner(&mut self) -> Option<&mut dyn Learner> {
        Some(&mut self.trainer)
    }
}
