//! Contract of experiments and its parts.

/// Named parts of a controller that a test can change.
mod anatomy;
/// Objectives and measures of an individual in addition to its fitness.
pub(crate) mod behavior;
/// An episode of one robot with a network and a custom objective.
mod controlled;
/// A controller, its channels and its starts as plain data for `farsa export`.
pub(crate) mod controller_export;
/// Bodies that are moved or pushed during an episode.
pub(crate) mod disturbance;
/// Moves and pushes of bodies in an episode.
pub(crate) mod disturbances;
/// One trial in a world, and its loop.
pub(crate) mod episode;
/// Tasks and evaluators: parameters in, outcomes out.
pub(crate) mod evaluator;
/// Control of an episode from outside.
pub(crate) mod external;
/// Decoding of genes into parameters.
pub(crate) mod genotype;
/// Loop over many episodes in the lanes of a batch of worlds.
mod in_lanes;
/// An evaluator made of a world and an episode.
mod in_world;
/// Changes of a controller in a test: silent neurons, cut inputs and links, noise.
pub(crate) mod intervention;
/// Test protocols of such changes.
mod interventions;
/// Number of lanes per thread, and their instructions.
pub(crate) mod lanes;
/// An episode with a maximum number of steps.
mod limited;
/// A network of any kind as plain data and as bytes.
pub(crate) mod network_export;
/// Parameters of a network with a bias and a leak for every neuron.
mod network_parameters;
/// Controller of a robot: its sensors, a network, and its motors.
mod neurocontroller;
/// A controller with normalized observations.
pub(crate) mod normalized_controller;
/// Outcome of a trial, and the description of a robot.
pub(crate) mod outcome;
/// A number that evolution sets, with its range.
pub(crate) mod parameter;
/// Tests of an individual as tables of cases.
pub(crate) mod protocol;
/// An existing experiment with another fitness.
mod rescored;
/// An episode of a task.
mod rollout;
/// A setting: its key, default, and allowed values.
mod setting;
/// Configuration of a run: settings and their values.
pub(crate) mod settings;
/// Episodes that a caller steps, in one world or in lanes.
mod stepped;
/// Worlds that a caller steps with its own actions.
pub(crate) mod stepper;
/// Values of settings.
mod value;

pub use anatomy::{Anatomy, PartNames};
pub use behavior::{Behavior, NotedBehavior, mean_of_note};
pub use controlled::{Controlled, Objective, PlanarWorld, Trials};
pub use controller_export::{
    ActuatorExport, ControllerExport, JudgeExport, MotorDrive, MotorExport, PointExport, SensorExport, SensorReading,
    ServoExport, StartExport, SurfaceExport,
};
pub use disturbance::{Displacement, Push};
pub use episode::{Episode, EpisodeId, NoWorld, record_row, run_episode, seconds};
pub use evaluator::{Bodies, Evaluation, Evaluator, Exports, InLanes, Iteration, Learner, Task, TaskInfo};
pub use external::ExternalControl;
pub use genotype::Genotype;
pub use in_lanes::{Batch, run_in_lanes};
pub use in_world::InWorld;
pub use intervention::{Intervention, input_ranges};
pub use interventions::Interventions;
pub use lanes::Lanes;
pub use network_export::NetworkExport;
pub use network_parameters::{OwnedNetwork, network_parameters, resting_network};
pub use neurocontroller::Neurocontroller;
pub use normalized_controller::NormalizedController;
pub use outcome::{ChannelGroup, Combination, Description, Failure, Note, Outcome, mean_of_trials};
pub use parameter::Parameter;
pub use protocol::{Case, CaseId, Protocol};
pub use rescored::Rescored;
pub use rollout::Rollout;
pub use settings::{Setting, Settings, Source, Value};
pub use stepper::{StepResult, Stepper};
