//! The evaluation of an experiment: parameters in, outcomes out.

use farsa_body::Recorder;
use farsa_body::robot::Robot;
use farsa_evo::ObservationStatistics;
use farsa_models::mjcf::MjcfOptions;
use farsa_view::Schema;

use crate::error::Error;
use crate::experiment::anatomy::Anatomy;
use crate::experiment::behavior::Behavior;
use crate::experiment::controller_export::{ControllerExport, StartExport};
use crate::experiment::disturbance::{Displacement, Push};
use crate::experiment::episode::EpisodeId;
use crate::experiment::intervention::Intervention;
use crate::experiment::lanes::Lanes;
use crate::experiment::outcome::{Description, Outcome};
use crate::experiment::parameter::Parameter;
use crate::experiment::protocol::{CaseId, Protocol};

/// The data of a task under its settings: parameters, recording, trials, and what tests can do with it.
///
/// Start from [`new`](Self::new) and name the fields that differ:
///
/// ```
/// use farsa_lab::{Parameter, TaskInfo};
/// use farsa_lab::advanced::Schema;
///
/// let parameters = vec![Parameter::new("gain", [-1.0, 1.0])];
/// let info = TaskInfo { trials: 5, ..TaskInfo::new(parameters, Schema::from_scalars(["angle [rad]"])) };
/// assert_eq!(info.step_budget(), 10_000_000);
/// ```
#[derive(Debug, Clone)]
pub struct TaskInfo {
    /// Parameters of an evaluation, in order.
    pub parameters: Vec<Parameter>,
    /// Names of the values that an episode records at every step: [`Schema::from_scalars`] for a row of numbers.
    pub schema: Schema,
    /// Sensors, motors and network for `farsa info`. By default only the number of parameters.
    pub description: Description,
    /// Trials per evaluation. By default 1.
    pub trials: usize,
    /// Step at which an episode is stopped and counts as failed. By default see [`step_budget`](Self::step_budget).
    pub step_budget: Option<u64>,
    /// Names of the fitness terms in [`Outcome::terms`], in order. By default `fitness`.
    pub terms: Vec<String>,
    /// Names of the populations that evolve against each other, one word each. By default one population, `0`.
    ///
    /// Individuals are numbered through, one population after the other: see [`EpisodeId::population`]. Each population
    /// has `evolution.population` individuals and all parameters.
    pub populations: Vec<String>,
    /// Names of the robots, when the channels of any one of several can be recorded.
    pub robots: Vec<String>,
    /// Number of observed channels that can be normalized. By default 0, without normalization.
    ///
    /// A [`NormalizedController`](crate::advanced::NormalizedController) normalizes, and [`Outcome::observed`] reports its statistics.
    pub observations: usize,
    /// Test protocols of `farsa test --protocol`. By default none.
    ///
    /// They are the same under all settings, except settings that remove the subject of a protocol.
    pub protocols: Vec<Protocol>,
    /// Parts of the controller that `farsa test --lesion` can change. By default none.
    ///
    /// The evaluator must apply [`Evaluation::intervention`]. [`Interventions::applied`] combines it with the case.
    ///
    /// [`Interventions::applied`]: crate::advanced::Interventions::applied
    pub anatomy: Option<Anatomy>,
}

impl TaskInfo {
    /// A task of one population and one trial with these parameters and this recording.
    pub fn new(parameters: Vec<Parameter>, schema: Schema) -> Self {
        let description = Description { parameters: parameters.len(), ..Description::default() };
        Self {
            parameters,
            schema,
            description,
            trials: 1,
            step_budget: None,
            terms: vec!["fitness".into()],
            populations: vec!["0".into()],
            robots: Vec::new(),
            observations: 0,
            protocols: Vec::new(),
            anatomy: None,
        }
    }

    /// Returns the step at which an episode is stopped, so that every episode ends.
    ///
    /// Without a `step_budget` this is the number of steps in the description, or ten million.
    pub fn step_budget(&self) -> u64 {
        self.step_budget.unwrap_or(match self.description.steps {
            0 => 10_000_000,
            steps => steps as u64,
        })
    }
}

/// A task: its data, its fitness, and the abilities of some tasks.
pub trait Task: Send {
    /// Returns the data of the task. The same settings must give the same data.
    fn info(&self) -> TaskInfo;

    /// Returns the fitness of an individual from its trials, in the order of trials.
    ///
    /// By default the sum of all terms. `farsa test` also calls it with single trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        trials.iter().flat_map(|outcome| &outcome.terms).sum()
    }

    /// Returns further objectives and measures of an individual, if the task has any.
    fn behavior(&self) -> Option<&dyn Behavior> {
        None
    }

    /// Returns the exports of the task, if it has any.
    fn exports(&self) -> Option<&dyn Exports> {
        None
    }

    /// Returns the construction of bodies from parameters, if bodies evolve.
    fn bodies(&self) -> Option<&dyn Bodies> {
        None
    }
}

/// The data of `farsa export`. Each method returns nothing by default.
pub trait Exports {
    /// Returns the options of the robot's MuJoCo model.
    fn mjcf_options(&self) -> Option<MjcfOptions> {
        None
    }

    /// Returns the robot for other programs, if it differs from the one of the [`schema`](TaskInfo::schema). Bodies
    /// that evolve are built from the parameters.
    ///
    /// Its MuJoCo model steps by [`MjcfOptions::default`] unless [`mjcf_options`](Self::mjcf_options) differs.
    fn robot(&self, parameters: Option<&[f32]>) -> Option<Robot> {
        let _ = parameters;
        None
    }

    /// The controller with these parameters and its channels.
    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        let _ = parameters;
        None
    }

    /// Returns the controller of an individual of a population, if the channels of populations differ.
    fn controller_of(&self, population: usize, parameters: &[f32]) -> Option<ControllerExport> {
        let _ = population;
        self.controller(parameters)
    }

    /// Returns the start of an episode.
    fn start(&self, id: EpisodeId) -> Option<StartExport> {
        let _ = id;
        None
    }
}

/// Bodies that are made of parameters.
pub trait Bodies {
    /// Returns the schema of one evaluation's episodes. Its channels are those of [`TaskInfo::schema`] for any
    /// parameters.
    fn schema_with(&self, parameters: &[f32]) -> Schema;
}

/// One trial that is to be evaluated.
#[derive(Debug, Clone, Copy)]
pub struct Evaluation<'p> {
    /// Its number among those that are evaluated together.
    pub number: usize,
    /// The parameters \[[`TaskInfo::parameters`]\].
    pub parameters: &'p [f32],
    /// Parameters of the opponents, one of each other population in order. Empty for a single population.
    ///
    /// Which population the parameters are of follows from the episode, [`EpisodeId::population`].
    pub opponents: &'p [&'p [f32]],
    /// Statistics of the observations of all previous generations, if observations are normalized
    /// \[[`TaskInfo::observations`]\].
    pub normalisation: Option<&'p ObservationStatistics>,
    /// Which episode.
    pub id: EpisodeId,
    /// Case of a test protocol \[[`TaskInfo::protocols`]\]. None in a run and in a plain test.
    ///
    /// All cases of a protocol have the same episodes, so that they differ in nothing but the case.
    pub case: Option<CaseId>,
    /// Further change of the controller in a test \[[`TaskInfo::anatomy`]\].
    pub intervention: Option<&'p Intervention>,
    /// Bodies that are moved during the episode \[[`Evaluator::displaces`]\]. None in a run and in a test.
    pub displacements: &'p [Displacement],
    /// Forces on bodies during the episode \[[`Evaluator::pushes`]\]. None in a run and in a test.
    pub pushes: &'p [Push],
    /// Robot whose channels are recorded, of several \[[`TaskInfo::robots`]\]. By default the individual's first.
    pub watched: Option<u32>,
}

impl<'p> Evaluation<'p> {
    /// A trial of these parameters, number 0, without opponents, normalised observations, a case or anything that is done to it.
    pub fn new(parameters: &'p [f32], id: EpisodeId) -> Self {
        Self {
            number: 0,
            parameters,
            opponents: &[],
            normalisation: None,
            id,
            case: None,
            intervention: None,
            displacements: &[],
            pushes: &[],
            watched: None,
        }
    }
}

/// Evaluates trials of an experiment in one thread: its robot, world and scratch memory.
///
/// An outcome depends on the [`Evaluation`] alone, never on previous evaluations. This makes runs repeatable, resumable
/// and equal on any number of threads. A run's seeds are below 2^63. In `farsa test` the seed has bit 63 set, so that
/// no run shares its numbers. The individual is then the first of its population, and the generation counts the earlier
/// episodes of the same trial.
pub trait Evaluator: Task {
    /// Runs one trial from its start to its end.
    ///
    /// A recorder receives the values of the [`schema`](TaskInfo::schema) at every step and must not change the
    /// outcome. A trial that failed is [`Outcome::failed`]. A trial that panics counts as failed, and this value is
    /// then dropped and built again. [`InWorld`](crate::InWorld) ends a trial at its [step
    /// budget](TaskInfo::step_budget). A custom loop must end by itself.
    fn evaluate(&mut self, evaluation: Evaluation<'_>, recorder: Option<&mut dyn Recorder>) -> Outcome;

    /// Returns whether evaluations can move bodies. By default they cannot.
    fn displaces(&self) -> bool {
        false
    }

    /// Returns whether evaluations can push bodies. By default they cannot.
    fn pushes(&self) -> bool {
        false
    }

    /// Returns the evaluation in lanes, if there is one.
    fn in_lanes(&mut self) -> Option<&mut dyn InLanes> {
        None
    }

    /// Returns the training for the strategy [`Learning`](crate::strategy::Learning).
    fn learner(&mut self) -> Option<&mut dyn Learner> {
        None
    }
}

/// Evaluates trials side by side, one in each lane.
pub trait InLanes {
    /// Prepares for a number of lanes. With one lane nothing is kept.
    ///
    /// # Errors
    /// Whatever keeps the lanes from being built.
    fn use_lanes(&mut self, lanes: Lanes) -> Result<(), Error>;

    /// Evaluates until `next` returns none. `done` receives the number of each evaluation and its outcome, equal to
    /// that of [`Evaluator::evaluate`].
    ///
    /// `next` may be asked in any order of `done`: other threads draw from the same evaluations.
    fn run_in_lanes<'p>(
        &mut self,
        next: &mut dyn FnMut() -> Option<Evaluation<'p>>,
        done: &mut dyn FnMut(usize, Outcome),
    );
}

/// Learns from demonstrations: its state is a row of numbers that iterations change.
pub trait Learner {
    /// The state from which learning starts: all that [`iterate`](Self::iterate) depends on besides seed and generation.
    fn initial_state(&self, seed: u64) -> Vec<f64>;

    /// Changes the state by one iteration and returns its errors. Returns `None` for a state without anything to learn
    /// from.
    ///
    /// The same state, seed and generation must become the same state, whatever this value did before.
    fn iterate(&mut self, state: &mut [f64], seed: u64, generation: u32) -> Option<Iteration>;

    /// Returns a value for each of the task's [`parameters`](TaskInfo::parameters). It is rounded to the nearest gene
    /// and evaluated.
    fn learned(&self, state: &[f64]) -> Vec<f64>;
}

/// Errors and successes of an iteration, [`Learner::iterate`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Iteration {
    /// Root of the mean squared error of motor values before it, on demonstrations that have never been learned from.
    pub before: f64,
    /// The same on the same demonstrations after it.
    pub after: f64,
    /// Share of the demonstrations that succeeded \[0..1\].
    pub successes: f64,
}
