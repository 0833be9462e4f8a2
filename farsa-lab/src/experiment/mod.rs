//! What an experiment is and how it is evaluated: the contract, and what helps to keep it.
//!
//! - `definition`: what an experiment is to the command: a name, a table of settings, and what evaluates it
//! - `evaluator`: parameters go in, outcomes come out; what only some experiments can do
//! - `anatomy`: the parts of a controller that a test can change, by name
//! - `behaviour`: what an experiment says of an individual beside its fitness
//! - `outcome`: what comes of a trial, and what is told of a robot and its controller
//! - `parameter`: a number that evolution finds, with its range
//! - `protocol`: tests of an individual, as tables of cases
//! - `episode`: one trial in a world, and the loop that runs it
//! - `disturbance`: bodies that are put elsewhere or pushed in the course of an episode
//! - `in_lanes`: the loop that runs many episodes side by side, one in each lane of a batch of worlds
//! - `in_world`: an evaluator made of a world and an episode
//! - `intervention`: what a test does to a controller: silent neurons, cut inputs and links, noise
//! - `interventions`: test protocols that do such things
//! - `lanes`: how many episodes a thread runs side by side, and by which instructions
//! - `limited`: an episode that ends at the latest after so many steps
//! - `genotype`: from genes to the parameters that they stand for
//! - `network_parameters`: the parameters of a network with a bias and a leak for every neuron
//! - `neurocontroller`: sensors, a network and motors, for episodes of one's own
//! - `normalised_controller`: a controller whose observations are normalised
//! - `controlled`: an episode of one robot that a network controls, with an objective of one's own
//! - `controller_export`: a controller, its body's channels and its starts as plain data, for `farsa export`
//! - `network_export`: a network of any kind as plain data, and as bytes
//! - `rescored`: an experiment that there is, under another fitness
//! - `setting`: a setting of an experiment: its key, its default, and which values it takes
//! - `settings`: the configuration of a run: the settings of an experiment and their values
//! - `value`: values of settings

mod anatomy;
pub(crate) mod behaviour;
mod controlled;
pub(crate) mod controller_export;
pub(crate) mod definition;
pub(crate) mod disturbance;
pub(crate) mod episode;
pub(crate) mod evaluator;
pub(crate) mod genotype;
mod in_lanes;
mod in_world;
pub(crate) mod intervention;
mod interventions;
pub(crate) mod lanes;
mod limited;
pub(crate) mod network_export;
mod network_parameters;
mod neurocontroller;
mod normalised_controller;
pub(crate) mod outcome;
pub(crate) mod parameter;
pub(crate) mod protocol;
mod rescored;
mod setting;
pub(crate) mod settings;
mod value;

pub use anatomy::{Anatomy, PartNames};
pub use behaviour::{Behaviour, NotedBehaviour, mean_of_note};
pub use controlled::{Controlled, Objective, PlanarWorld, Trials};
pub use controller_export::{
    ActuatorExport, ControllerExport, JudgeExport, MotorDrive, MotorExport, PointExport, SensorExport, SensorReading,
    ServoExport, StartExport, SurfaceExport,
};
pub use definition::{Experiment, SimpleExperiment};
pub use disturbance::{Displacement, Push};
pub use episode::{Episode, EpisodeId, NoWorld, record_row, run_episode, seconds};
pub use evaluator::{Bodies, Evaluation, Evaluator, Exports, InLanes, Iteration, Learner, Task, TaskInfo};
pub use genotype::Genotype;
pub use in_lanes::{Batch, run_in_lanes};
pub use in_world::{InWorld, Rollout};
pub use intervention::{Intervention, input_ranges};
pub use interventions::Interventions;
pub use lanes::Lanes;
pub use network_export::NetworkExport;
pub use network_parameters::{OwnedNetwork, network_parameters, resting_network};
pub use neurocontroller::Neurocontroller;
pub use normalised_controller::NormalisedController;
pub use outcome::{ChannelGroup, Description, Failure, Note, Outcome, mean_of_trials};
pub use parameter::Parameter;
pub use protocol::{Case, CaseId, Protocol};
pub use rescored::Rescored;
pub use settings::{Setting, Settings, Source, Value};
