//! What an experiment is and how it is lived: the contract, and what helps to keep it.
//!
//! - `controller_export`: a controller, its body's channels and its starts as plain data, for `farsa export`
//! - `definition`: what an experiment is to the command: a name, a table of settings, and lives of genomes
//! - `lanes`: how many lives a thread lives side by side, and by which instructions
//! - `life`: a life: what an experiment does with a world from the first to the last step
//! - `live_in_lanes`: many lives side by side, one in each lane of a batch of worlds
//! - `network_decoder`: from genes to a network with a bias and a leak for every neuron
//! - `neurocontroller`: what genes control a robot by: its sensors, a network, and its motors
//! - `search_kind`: how an experiment searches, in a word
//! - `settings`: the configuration of an experiment: flat `section.key` settings with types, limits, units and sources

pub(crate) mod controller_export;
pub(crate) mod definition;
pub(crate) mod lanes;
pub(crate) mod life;
mod live_in_lanes;
mod network_decoder;
mod neurocontroller;
pub(crate) mod search_kind;
pub(crate) mod settings;

pub use controller_export::{
    ActuatorExport, ControllerExport, CtrnnExport, JudgeExport, MotorDrive, MotorExport, NetworkExport, PointExport,
    SensorExport, SensorReading, ServoExport, StartExport, SurfaceExport,
};
pub use definition::{ChannelGroup, Description, Experiment, Lesson, Note, Outcome, Setup, Tape, Task};
pub use lanes::Lanes;
pub use life::{Job, Life, live};
pub use live_in_lanes::live_in_lanes;
pub use network_decoder::{NetworkDecoder, TeamNetwork};
pub use neurocontroller::Neurocontroller;
pub use search_kind::Search;
pub use settings::{Setting, Settings, Source, Value};
