//! The experiment `kinesthetic-grasp`: the arm is led, and the network learns to do it alone.

use std::sync::Arc;

use farsa_body::Recorder;
use farsa_physics::articulated::World;

use crate::kinesthetic_grasp::training::{Lessons, School};
use crate::reach_grasp_lift::config::Config as Reach;
use crate::reach_grasp_lift::experiment::evaluator;
use crate::reach_grasp_lift::scene::Scene;
use crate::reach_grasp_lift::task::ReachTask;
use crate::worlds::Engine;
use farsa_lab::{
    Description, ENGINE, Error, Evaluation, Evaluator, Experiment, Exports, InLanes, InWorld, Learner, Outcome,
    Parameter, Search, Setting, Settings, Task,
};
use farsa_view::Stage;

/// Can the network of [`reach-grasp-lift`](crate::ReachGraspLift) learn its task from demonstrations?
///
/// Robot, sensors, motors, trials and fitness are those of `reach-grasp-lift` with labels. Instead of evolving, one network
/// takes lessons: the arm is led through reach, grasp and lift by the scripted grasp, (sensors, desired motors) is recorded,
/// and the network learns the desired motors by back-propagation through time. A generation is a life of the network in the
/// four trials, which is its fitness, and then a lesson; `learning.csv` in the run's directory has the errors.
///
/// What is desired is what the script would do where the arm is, and the arm is led in part by the network's own commands, from
/// not at all in the first demonstration of a lesson to a share in its last one that grows from lesson to lesson \[Ross2011\]: a
/// network that has only seen where the script goes does not know what to do where its own small errors take it. What lives
/// and leads is the mean of the networks after the latest steps of learning \[Polyak1992\].
///
/// Deviations from `reach-grasp-lift`: slope 1 and weights within 20, because with slope 0.2 and weights within 6 two
/// layers cannot amplify as the script's feedback does; 24 hidden neurons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct KinestheticGrasp;

/// The values of `kinesthetic-grasp`.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// The robot, its world, its network and its trials.
    pub reach: Reach,
    /// How lessons are given.
    pub lessons: Lessons,
}

impl Default for Config {
    fn default() -> Self {
        let reach = Reach { hidden: 24, slope: 1.0, weight_range: 20.0, ..Reach::default() };
        Self { reach, lessons: Lessons::default() }
    }
}

impl Config {
    /// The configuration that checked settings describe.
    ///
    /// # Errors
    /// As of `reach-grasp-lift`; [`Error::Setting`] for a world other than ours, in which nobody leads the arm.
    pub fn read(settings: &Settings) -> Result<Self, Error> {
        let reach = Reach::read(true, settings)?;
        if reach.engine != Engine::Articulated {
            return Err(Error::setting(ENGINE, "the arm is led in our own world alone"));
        }
        let count = |key: &str| settings.count(key).map(|count| count as u32);
        let lessons = Lessons {
            demonstrations: count("lessons.demonstrations")?,
            passes: count("lessons.passes")?,
            batch: count("lessons.batch")?,
            rate: settings.number("lessons.rate")?,
            half_rate: settings.number("lessons.half_rate")?,
            mean: count("lessons.mean")?,
            own_say: count("lessons.own_say")?,
        };
        Ok(Self { reach, lessons })
    }
}

impl Experiment for KinestheticGrasp {
    fn name(&self) -> &'static str {
        "kinesthetic-grasp"
    }

    // 2: what lives and leads is the mean over the latest steps of learning; more demonstrations, gone through less often.
    fn values_version(&self) -> u32 {
        2
    }

    fn summary(&self) -> &'static str {
        "the arm is led through reach, grasp and lift, and a network learns by back-propagation to do it alone"
    }

    fn search(&self, _: &str) -> Search {
        Search::Learning
    }

    fn settings(&self, _: &str) -> Vec<Setting> {
        let Config { reach, lessons } = Config::default();
        let whole = |key: &str, value: u32, range| Setting::whole(key, i64::from(value), range);
        let mut table = vec![
            Setting::whole("evolution.generations", 250, 1..=i64::from(u32::MAX) - 1)
                .doc("Lessons, each after a life that shows what is known so far; the one thing that a resumed run may change."),
            whole("lessons.demonstrations", lessons.demonstrations, 1..=10_000)
                .doc("Times that the arm is led in a lesson, each from another start; the four trials take turns."),
            whole("lessons.passes", lessons.passes, 1..=1000).doc("Times that all of them are gone through."),
            whole("lessons.batch", lessons.batch, 1..=10_000).doc("Demonstrations of a step of learning."),
            Setting::number("lessons.rate", lessons.rate, 0.0..=1.0).doc("Size of a step of learning, of Adam."),
            Setting::number("lessons.half_rate", lessons.half_rate, 1.0..=1e9)
                .doc("Lessons after which the step has half that size, and a third after twice as many."),
            whole("lessons.mean", lessons.mean, 1..=1_000_000)
                .doc("Steps of learning over which the network is averaged before it lives and leads; 1: as the latest one left it."),
            whole("lessons.own_say", lessons.own_say, 0..=1_000_000)
                .doc("Lessons until the network leads itself fully in a lesson's last demonstration, 0 if it never does."),
        ];
        table.append(&mut reach.table());
        table
    }

    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(Trainee::new(Config::read(settings)?)?))
    }
}

/// Evaluates as `reach-grasp-lift` does, and takes lessons.
pub struct Trainee {
    evaluator: InWorld<World<f32>, ReachTask>,
    school: School,
}

impl Trainee {
    /// Trials and lessons under a configuration.
    ///
    /// # Errors
    /// [`Error::Other`] for a configuration whose robot or network cannot be built.
    pub fn new(config: Config) -> Result<Self, Error> {
        let scene = Arc::new(Scene::new(config.reach.clone())?);
        Ok(Self { evaluator: evaluator(config.reach)?, school: School::new(scene, config.lessons)? })
    }
}

impl Task for Trainee {
    fn parameters(&self) -> Vec<Parameter> {
        self.evaluator.parameters()
    }

    fn trials(&self) -> usize {
        self.evaluator.trials()
    }

    fn terms(&self) -> Vec<String> {
        self.evaluator.terms()
    }

    fn stage(&self) -> Stage {
        self.evaluator.stage()
    }

    fn description(&self) -> Description {
        self.evaluator.description()
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

    fn in_lanes(&mut self) -> Option<&mut dyn InLanes> {
        self.evaluator.in_lanes()
    }

    fn learner(&mut self) -> Option<&mut dyn Learner> {
        Some(&mut self.school)
    }
}
