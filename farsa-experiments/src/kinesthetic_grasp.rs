//! The experiment `kinesthetic-grasp`: the arm is led, and the network learns to do it alone.

pub use crate::kinesthetic_grasp_school::Lessons;

use std::sync::Arc;

use farsa_models::MjcfOptions;

use crate::controller_export::{ControllerExport, StartExport};
use crate::engine::{ENGINE, Engine};
use crate::error::Error;
use crate::experiment::{Description, Experiment, Lesson, Outcome, Setup, Tape, Task};
use crate::kinesthetic_grasp_school::School;
use crate::lanes::Lanes;
use crate::life::Job;
use crate::reach_grasp_lift::{Config as Reach, Lives as ReachLives, Scene};
use crate::search::Search;
use crate::settings::{Setting, Settings};
use crate::stage::Stage;

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

    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Setup>, Error> {
        Ok(Box::new(Lives::new(Config::read(settings)?)?))
    }
}

/// The lives of `reach-grasp-lift`, and a school.
pub struct Lives {
    lives: ReachLives,
    school: School,
}

impl Lives {
    /// Lives and lessons under a configuration.
    ///
    /// # Errors
    /// [`Error::Other`] for a configuration whose robot or network cannot be built.
    pub fn new(config: Config) -> Result<Self, Error> {
        let scene = Arc::new(Scene::new(config.reach.clone())?);
        Ok(Self { lives: ReachLives::new(config.reach)?, school: School::new(scene, config.lessons)? })
    }
}

impl Setup for Lives {
    fn genes(&self) -> usize {
        self.lives.genes()
    }

    fn trials(&self) -> usize {
        self.lives.trials()
    }

    fn terms(&self) -> Vec<String> {
        self.lives.terms()
    }

    fn stage(&self) -> Stage {
        self.lives.stage()
    }

    fn mjcf_options(&self) -> MjcfOptions {
        self.lives.mjcf_options()
    }

    fn controller(&self, genes: &[u16]) -> Option<ControllerExport> {
        self.lives.controller(genes)
    }

    fn start(&self, job: Job) -> Option<StartExport> {
        self.lives.start(job)
    }

    fn description(&self) -> Description {
        self.lives.description()
    }

    fn live(&mut self, genes: &[u16], job: Job, tape: &mut Tape<'_>) -> Outcome {
        self.lives.live(genes, job, tape)
    }

    fn use_lanes(&mut self, lanes: Lanes) -> Result<Lanes, Error> {
        self.lives.use_lanes(lanes)
    }

    fn live_many<'g>(&mut self, next: &mut dyn FnMut() -> Option<Task<'g>>, done: &mut dyn FnMut(usize, Outcome)) {
        self.lives.live_many(next, done);
    }

    fn first_words(&self, seed: u64) -> Vec<f64> {
        self.school.first_words(seed)
    }

    fn lesson(&mut self, words: &mut [f64], seed: u64, generation: u32) -> Option<Lesson> {
        self.school.lesson(words, seed, generation)
    }

    fn learned(&self, words: &[f64]) -> Vec<u16> {
        self.school.genes(words)
    }

    fn fitness(&self, trials: &[Outcome]) -> f64 {
        self.lives.fitness(trials)
    }
}
