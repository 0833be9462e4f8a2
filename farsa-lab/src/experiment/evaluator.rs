//! Evaluation of an experiment: parameters in, outcomes out.

use std::sync::atomic::AtomicBool;

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
use crate::experiment::outcome::{Combination, Description, Outcome};
use crate::experiment::parameter::Parameter;
use crate::experiment::protocol::{CaseId, Protocol};
use crate::experiment::stepper::{Stepper, not_stepped};

/// Data of a task under its settings: parameters, recording, trials, and what tests can do with it.
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
    /// Step at which an episode is stopped and counts as failed. If this is `None`,
    /// [`step_budget`](Self::step_budget) chooses a default.
    pub step_budget: Option<u64>,
    /// Names of the fitness terms in [`Outcome::terms`], in order. By default `fitness`.
    pub terms: Vec<String>,
    /// Combination of the trials into the fitness, for texts. By default `None`, which names no combination.
    pub combination: Option<Combination>,
    /// Presence of a criterion of success. By default true. Without it a test reports no share of successes.
    pub has_success: bool,
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
    /// Doubts about the task under its settings, one sentence each, such as a fitness that never differs. By default none.
    pub warnings: Vec<String>,
}

impl TaskInfo {
    /// Creates the data of a task with one population and one trial.
    ///
    /// All optional abilities are off. Use the update syntax of structs to change single fields, as in the example above.
    pub fn new(parameters: Vec<Parameter>, schema: Schema) -> Self {
        let description = Description { parameters: parameters.len(), ..Description::default() };
        Self {
            parameters,
            schema,
            description,
            trials: 1,
            step_budget: None,
            terms: vec!["fitness".into()],
            combination: None,
            has_success: true,
            populations: vec!["0".into()],
            robots: Vec::new(),
            observations: 0,
            protocols: Vec::new(),
            anatomy: None,
            warnings: Vec::new(),
        }
    }

    /// Formats the combination of the trials, such as `sum of 5 trials`. Empty without a combination.
    pub(crate) fn combined(&self) -> String {
        match self.combination {
            Some(combination) if self.trials > 1 => format!("{combination} of {} trials", self.trials),
            _ => String::new(),
        }
    }

    /// Gets the step at which an episode is stopped, so that every episode ends.
    ///
    /// If the field `step_budget` is `None`, this is the number of steps in the description. It is ten million if the
    /// description has no steps either.
    pub fn step_budget(&self) -> u64 {
        self.step_budget.unwrap_or(match self.description.steps {
            0 => 10_000_000,
            steps => steps as u64,
        })
    }
}

/// A task: its data, its fitness, and the abilities of some tasks.
pub trait Task: Send {
    /// Describes the task. Note that the same settings must always give the same data.
    fn info(&self) -> TaskInfo;

    /// Computes the fitness of an individual from its trials, in the order of trials.
    ///
    /// The default implementation adds up all terms of all trials. If you override it, note that `farsa test` also
    /// calls it with single trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        trials.iter().flat_map(|outcome| &outcome.terms).sum()
    }

    /// Further objectives and measures of an individual, if the task has any.
    ///
    /// You don't need to implement this if your strategy only uses the fitness.
    fn behavior(&self) -> Option<&dyn Behavior> {
        None
    }

    /// Data for `farsa export`, if the task has any.
    fn exports(&self) -> Option<&dyn Exports> {
        None
    }

    /// Construction of bodies from parameters. Implement this if bodies evolve.
    fn bodies(&self) -> Option<&dyn Bodies> {
        None
    }
}

/// Data for `farsa export`.
///
/// All methods are optional, since each of them returns `None` by default.
pub trait Exports {
    /// Options of the MuJoCo model of the robot.
    fn mjcf_options(&self) -> Option<MjcfOptions> {
        None
    }

    /// Robot for other programs, if it differs from the one of the [`schema`](TaskInfo::schema).
    ///
    /// If bodies evolve, they are built from `parameters`.
    ///
    /// Its MuJoCo model steps by [`MjcfOptions::default`] unless [`mjcf_options`](Self::mjcf_options) differs.
    fn robot(&self, parameters: Option<&[f32]>) -> Option<Robot> {
        let _ = parameters;
        None
    }

    /// Exports the controller with these parameters, together with its channels.
    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        let _ = parameters;
        None
    }

    /// Exports the controller of an individual in the given population.
    ///
    /// You only need to implement this if the channels of populations differ. By default it ignores the population and
    /// calls [`controller`](Self::controller).
    fn controller_of(&self, population: usize, parameters: &[f32]) -> Option<ControllerExport> {
        let _ = population;
        self.controller(parameters)
    }

    /// Exports the start of an episode.
    fn start(&self, id: EpisodeId) -> Option<StartExport> {
        let _ = id;
        None
    }
}

/// Construction of bodies from parameters, for tasks in which bodies evolve.
pub trait Bodies {
    /// Builds the schema for episodes with these parameters.
    ///
    /// Its channels must not depend on the parameters, and must be the same as in [`TaskInfo::schema`].
    fn schema_with(&self, parameters: &[f32]) -> Schema;
}

/// A single trial to evaluate.
///
/// Use [`Evaluation::new`] and change the fields that you need.
#[derive(Debug, Clone, Copy)]
pub struct Evaluation<'p> {
    /// Number of this trial among all that are evaluated together.
    pub number: usize,
    /// Parameters \[[`TaskInfo::parameters`]\].
    pub parameters: &'p [f32],
    /// Parameters of the opponents, one of each other population in order. Empty for a single population.
    ///
    /// Use [`EpisodeId::population`] to find out which population the parameters belong to.
    pub opponents: &'p [&'p [f32]],
    /// Statistics of the observations of all previous generations, if observations are normalized
    /// \[[`TaskInfo::observations`]\].
    pub normalisation: Option<&'p ObservationStatistics>,
    /// Episode to run.
    pub id: EpisodeId,
    /// Case of a test protocol \[[`TaskInfo::protocols`]\]. None in a run and in a plain test.
    ///
    /// This doesn't change the episodes. All cases of a protocol share them, so any difference in the outcome is due to
    /// the case.
    pub case: Option<CaseId>,
    /// Further change of the controller in a test \[[`TaskInfo::anatomy`]\].
    pub intervention: Option<&'p Intervention>,
    /// Bodies that are moved during the episode \[[`Evaluator::displaces`]\]. None in a run and in a test.
    pub displacements: &'p [Displacement],
    /// Forces on bodies during the episode \[[`Evaluator::pushes`]\]. None in a run and in a test.
    pub pushes: &'p [Push],
    /// Robot whose channels are recorded, of several \[[`TaskInfo::robots`]\]. By default the individual's first.
    pub watched: Option<u32>,
    /// Flag that ends the episode early, which then counts as failed. None in a run and in a test.
    pub stop: Option<&'static AtomicBool>,
}

impl<'p> Evaluation<'p> {
    /// Creates a plain trial of these parameters.
    ///
    /// It has number 0 and neither opponents nor a case. Observations are not normalized, and nothing disturbs the
    /// episode.
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
            stop: None,
        }
    }
}

/// Evaluates trials of an experiment in one thread: its robot, world and scratch memory.
///
/// An implementation must make sure that an outcome depends only on the [`Evaluation`], and never on previous
/// evaluations. This makes runs repeatable and resumable, and lets you use any number of threads without changing the
/// results.
///
/// Seeds of a run are below 2^63. In `farsa test` the seed has bit 63 set, so that tests never share random numbers with
/// a run. The individual is then the first of its population, and the generation counts the earlier episodes of the same
/// trial.
pub trait Evaluator: Task {
    /// Runs one trial from its start to its end.
    ///
    /// If there is a recorder, it receives the values of the [`schema`](TaskInfo::schema) at every step. Recording must
    /// not change the outcome.
    ///
    /// Return [`Outcome::failed`] if a trial fails. If this method panics, the trial also counts as failed, and the
    /// evaluator is dropped and built again. Note that a custom loop must end by itself, while
    /// [`InWorld`](crate::InWorld) ends a trial at its [step budget](TaskInfo::step_budget).
    fn evaluate(&mut self, evaluation: Evaluation<'_>, recorder: Option<&mut dyn Recorder>) -> Outcome;

    /// Records the state from which a trial starts as a single tick. Returns false if the evaluator cannot, which is the
    /// default.
    ///
    /// `farsa export` writes this state into the MuJoCo model of the robot.
    fn record_start(&mut self, evaluation: Evaluation<'_>, recorder: &mut dyn Recorder) -> bool {
        let _ = (evaluation, recorder);
        false
    }

    /// Checks whether evaluations support [`Evaluation::displacements`]. This is `false` by default.
    fn displaces(&self) -> bool {
        false
    }

    /// Checks whether evaluations support [`Evaluation::pushes`]. This is `false` by default.
    fn pushes(&self) -> bool {
        false
    }

    /// Gives access to the evaluation in lanes, if this evaluator supports it.
    fn in_lanes(&mut self) -> Option<&mut dyn InLanes> {
        None
    }

    /// Gives access to the training for the strategy [`Learning`](crate::strategy::Learning), if there is any.
    fn learner(&mut self) -> Option<&mut dyn Learner> {
        None
    }

    /// Converts the evaluator into one world per lane, which the caller steps with its own actions.
    ///
    /// # Errors
    /// Returns [`Error::Usage`] with the reason if the experiment cannot be stepped, which is the default.
    fn into_stepper(self: Box<Self>, lanes: Lanes) -> Result<Box<dyn Stepper>, Error> {
        let _ = lanes;
        Err(not_stepped("it evaluates complete trials"))
    }
}

/// Evaluates trials side by side, one in each lane.
pub trait InLanes {
    /// Prepares for the given number of lanes. With a single lane nothing is kept.
    ///
    /// # Errors
    /// Returns an error if the lanes cannot be built.
    fn use_lanes(&mut self, lanes: Lanes) -> Result<(), Error>;

    /// Evaluates trials until `next` returns `None`.
    ///
    /// For each trial `done` is called with its number and its outcome, which must be equal to that of
    /// [`Evaluator::evaluate`]. The calls of `next` and `done` may be interleaved in any order, since other threads draw
    /// from the same evaluations.
    fn run_in_lanes<'p>(
        &mut self,
        next: &mut dyn FnMut() -> Option<Evaluation<'p>>,
        done: &mut dyn FnMut(usize, Outcome),
    );
}

/// Learns from demonstrations. Its state is a row of numbers, which each iteration changes.
pub trait Learner {
    /// Creates the state from which learning starts.
    ///
    /// It must contain everything that [`iterate`](Self::iterate) depends on, except for the seed and the generation.
    fn initial_state(&self, seed: u64) -> Vec<f64>;

    /// Changes the state by one iteration and returns its errors.
    ///
    /// If there is nothing to learn from, this returns `None`. The new state must only depend on the old state, the seed
    /// and the generation, and not on earlier calls.
    fn iterate(&mut self, state: &mut [f64], seed: u64, generation: u32) -> Option<Iteration>;

    /// Converts the state to a value for each of the [`parameters`](TaskInfo::parameters) of the task.
    ///
    /// These values are then rounded to the nearest gene and evaluated.
    fn learned(&self, state: &[f64]) -> Vec<f64>;
}

/// Errors and successes of an iteration, [`Learner::iterate`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Iteration {
    /// Root mean squared error of motor values before the iteration.
    ///
    /// This is measured on demonstrations that have never been used for learning.
    pub before: f64,
    /// Error after the iteration, on the same demonstrations.
    pub after: f64,
    /// Share of the demonstrations that succeeded \[0..1\].
    pub successes: f64,
}
