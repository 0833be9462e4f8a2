//! What an experiment is evaluated by: parameters go in, outcomes come out.

use farsa_body::Recorder;
use farsa_body::robot::Robot;
use farsa_evo::ObservationStatistics;
use farsa_models::MjcfOptions;
use farsa_view::Schema;

use crate::error::Error;
use crate::experiment::anatomy::Anatomy;
use crate::experiment::behaviour::Behaviour;
use crate::experiment::controller_export::{ControllerExport, StartExport};
use crate::experiment::disturbance::{Displacement, Push};
use crate::experiment::episode::EpisodeId;
use crate::experiment::intervention::Intervention;
use crate::experiment::lanes::Lanes;
use crate::experiment::outcome::{Description, Outcome};
use crate::experiment::parameter::Parameter;
use crate::experiment::protocol::{CaseId, Protocol};

/// What there is to know of an experiment under its settings before anything is evaluated.
///
/// Beside the two that are required, methods say what is so for some experiments only: several populations, exports,
/// bodies that are made of parameters.
pub trait Task: Send {
    /// The parameters that an evaluation takes, in their order.
    fn parameters(&self) -> Vec<Parameter>;

    /// What an episode records at every step, by name: [`Schema::from_scalars`] if it is a row of numbers.
    fn schema(&self) -> Schema;

    /// What the robot senses, does and computes with, for `farsa info`; by default the number of parameters alone.
    fn description(&self) -> Description {
        Description { parameters: self.parameters().len(), ..Description::default() }
    }

    /// Trials of an evaluation.
    fn trials(&self) -> usize {
        1
    }

    /// The step at which an episode that has not ended is stopped and counts as failed, so that one without an end ends.
    ///
    /// By default the most steps that the [`description`](Self::description) names, or ten million where it names none.
    fn step_budget(&self) -> u64 {
        match self.description().steps {
            0 => 10_000_000,
            steps => steps as u64,
        }
    }

    /// Names of the terms of the fitness that [`Outcome::terms`] holds, in its order.
    fn terms(&self) -> Vec<String> {
        vec!["fitness".into()]
    }

    /// The fitness of an individual from its trials, in the order of trials; `farsa test` asks for single ones too.
    ///
    /// By default the sum of all terms.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        trials.iter().flat_map(|outcome| &outcome.terms).sum()
    }

    /// What the populations that evolve against each other are called, in their order: one word each. By default there is
    /// one population, and it is called 0.
    ///
    /// The individuals of all are numbered through, one population after the other: see [`EpisodeId::population`]. Each
    /// has `evolution.population` individuals and all parameters.
    fn populations(&self) -> Vec<String> {
        vec!["0".into()]
    }

    /// The robots by name, where there are several and the channels of any one of them can be recorded.
    fn robots(&self) -> Vec<String> {
        Vec::new()
    }

    /// How many channels a controller observes, where observations can be normalised: a [`NormalisedController`] does
    /// that, and the [`Outcome`] says what was observed. By default 0: they cannot be.
    ///
    /// [`NormalisedController`]: crate::NormalisedController
    fn observations(&self) -> usize {
        0
    }

    /// More objectives than the fitness, and what an individual did, where the experiment says so.
    fn behaviour(&self) -> Option<&dyn Behaviour> {
        None
    }

    /// The tests that `farsa test --protocol` offers beside its plain one; by default none.
    ///
    /// The same under all settings but those that take away what a protocol is about, and the same whenever it is asked.
    fn protocols(&self) -> Vec<Protocol> {
        Vec::new()
    }

    /// The parts of the controller that `farsa test --lesion` can change; by default none can be.
    ///
    /// An evaluator that names them does what [`Evaluation::intervention`] says, as [`Interventions::applied`] brings it together
    /// with the case.
    ///
    /// [`Interventions::applied`]: crate::Interventions::applied
    fn anatomy(&self) -> Option<Anatomy> {
        None
    }

    /// What can be exported, if anything can.
    fn exports(&self) -> Option<&dyn Exports> {
        None
    }

    /// How bodies are made of parameters, if they are.
    fn bodies(&self) -> Option<&dyn Bodies> {
        None
    }
}

/// What `farsa export` writes of an experiment; each by default nothing.
pub trait Exports {
    /// What a MuJoCo model of the robot in the [`schema`](Task::schema) says beside the robot.
    fn mjcf_options(&self) -> Option<MjcfOptions> {
        None
    }

    /// The robot as other programs may have it, where that is not the one of the [`schema`](Task::schema): of these
    /// parameters where bodies are made of them, else, or without parameters, the experiment's own.
    ///
    /// Its MuJoCo model steps as [`MjcfOptions::default`] does, unless [`mjcf_options`](Self::mjcf_options) says otherwise.
    fn robot(&self, parameters: Option<&[f32]>) -> Option<Robot> {
        let _ = parameters;
        None
    }

    /// The controller with these parameters and its channels.
    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        let _ = parameters;
        None
    }

    /// The same for an individual of the population of this number, where the channels of populations stand for other things.
    fn controller_of(&self, population: usize, parameters: &[f32]) -> Option<ControllerExport> {
        let _ = population;
        self.controller(parameters)
    }

    /// How an episode starts.
    fn start(&self, id: EpisodeId) -> Option<StartExport> {
        let _ = id;
        None
    }
}

/// Bodies that are made of parameters.
pub trait Bodies {
    /// The schema of one evaluation's episodes; its channels are those of [`Task::schema`], whatever the parameters.
    fn schema_with(&self, parameters: &[f32]) -> Schema;
}

/// One trial that is to be evaluated.
#[derive(Debug, Clone, Copy)]
pub struct Evaluation<'p> {
    /// Its number among those that are evaluated together.
    pub number: usize,
    /// The parameters \[[`Task::parameters`]\].
    pub parameters: &'p [f32],
    /// Those of its opponents, one of each other population in the order of the populations; empty where there is only one.
    ///
    /// Which population the parameters are of follows from the episode, [`EpisodeId::population`].
    pub opponents: &'p [&'p [f32]],
    /// What was observed in all generations before, where observations are to be normalised \[[`Task::observations`]\].
    pub normalisation: Option<&'p ObservationStatistics>,
    /// Which episode.
    pub id: EpisodeId,
    /// The case of a test protocol that it belongs to \[[`Task::protocols`]\]; none in a run and in a plain test.
    ///
    /// All cases of a protocol have the same episodes, so that they differ in nothing but the case.
    pub case: Option<CaseId>,
    /// What else is done to the controller, where a test asks for that \[[`Task::anatomy`]\].
    pub intervention: Option<&'p Intervention>,
    /// Bodies that are put elsewhere in its course \[[`Evaluator::displaces`]\]; none in a run and in a test.
    pub displacements: &'p [Displacement],
    /// Forces on bodies in its course \[[`Evaluator::pushes`]\]; none in a run and in a test.
    pub pushes: &'p [Push],
    /// Of several robots the one whose channels are recorded \[[`Task::robots`]\]; by default the individual's first.
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
/// An outcome depends on the [`Evaluation`] alone, never on what was evaluated before: that is what makes runs repeatable,
/// resumable and the same on any number of threads. A run's seeds are below 2^63. In `farsa test` the seed has bit 63 set,
/// so that no number is shared with any run; the individual is then the first of its population and the generation counts
/// the earlier episodes of the same trial.
pub trait Evaluator: Task {
    /// Runs one trial from its start to its end.
    ///
    /// What [`schema`](Task::schema) names goes to the recorder at every step if there is one; whether there is must
    /// not change the outcome. A trial that broke down is [`Outcome::failed`]; one that panics counts as such, and this value is
    /// then dropped and made again. [`InWorld`](crate::InWorld) ends a trial at its [step budget](Task::step_budget); a loop of
    /// one's own has to end by itself.
    fn evaluate(&mut self, evaluation: Evaluation<'_>, recorder: Option<&mut dyn Recorder>) -> Outcome;

    /// Whether bodies are put elsewhere where an evaluation says so; by default they are not.
    fn displaces(&self) -> bool {
        false
    }

    /// Whether bodies are pushed where an evaluation says so; by default they are not.
    fn pushes(&self) -> bool {
        false
    }

    /// How trials are evaluated side by side, if they can be.
    fn in_lanes(&mut self) -> Option<&mut dyn InLanes> {
        None
    }

    /// How it is trained, where the strategy is [`Learning`](crate::Learning).
    fn learner(&mut self) -> Option<&mut dyn Learner> {
        None
    }
}

/// Evaluates trials side by side, one in each lane.
pub trait InLanes {
    /// Gets ready for so many lanes; for one, nothing is kept.
    ///
    /// # Errors
    /// Whatever keeps the lanes from being built.
    fn use_lanes(&mut self, lanes: Lanes) -> Result<(), Error>;

    /// Evaluates until `next` has no more; `done` takes the number of each evaluation with its outcome, which is what
    /// [`Evaluator::evaluate`] would return.
    ///
    /// `next` may be asked in any order of `done`: other threads draw from the same evaluations.
    fn evaluate_all<'p>(
        &mut self,
        next: &mut dyn FnMut() -> Option<Evaluation<'p>>,
        done: &mut dyn FnMut(usize, Outcome),
    );
}

/// Learns from demonstrations: its state is a row of numbers that iterations change.
pub trait Learner {
    /// The state from which learning starts: all that [`iterate`](Self::iterate) depends on besides seed and generation.
    fn initial_state(&self, seed: u64) -> Vec<f64>;

    /// Changes the state by one iteration and says what it was like; `None` for a state that nothing can be learned from.
    ///
    /// The same state, seed and generation must become the same state, whatever this value did before.
    fn iterate(&mut self, state: &mut [f64], seed: u64, generation: u32) -> Option<Iteration>;

    /// What has been learned in this state: a value for each of the task's [`parameters`](Task::parameters), which is evaluated
    /// after it was rounded to the nearest gene.
    fn learned(&self, state: &[f64]) -> Vec<f64>;
}

/// What an iteration was like, [`Learner::iterate`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Iteration {
    /// Root of the mean squared error of motor values before it, on demonstrations that have never been learned from.
    pub before: f64,
    /// The same on the same demonstrations after it.
    pub after: f64,
    /// Share of the demonstrations that succeeded \[0..1\].
    pub successes: f64,
}
