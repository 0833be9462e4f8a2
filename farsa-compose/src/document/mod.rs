//! The content of a file as data, from which the schema of the format is generated.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::name::NAME;

/// Objectives and measures in addition to the fitness.
mod behaviour;
/// Start and end of a trial.
mod episode;
/// Food and energy.
mod foraging;
/// Learning from demonstrations.
mod learning;
/// Motors.
mod motor;
/// Networks.
mod network;
/// Registered parts with their keys.
mod registered;
/// Terms of the fitness, success and failure.
mod reward;
/// Robots.
mod robot;
/// Sensors.
mod sensor;
/// The world and its objects.
mod world;

pub use behaviour::{BehaviourOfTerms, DescriptorTerm, ObjectiveTerm};
pub use episode::{Ending, Episode, Start};
pub use foraging::Foraging;
pub use learning::{Learning, LossName};
pub use motor::Motor;
pub use network::Network;
pub use registered::{MotorKind, NetworkKind, ObjectKind, Placing, RewardKind, SensorKind, Wrapper};
pub use reward::{Condition, Fitness, Over, Reward, Trials};
pub use robot::{Robot, RobotGroup, RobotKind, Team};
pub use sensor::Sensor;
pub use world::{Collisions, Engine, Object, Shape, World};

/// An experiment: robots in a world, their sensors, motors and network, the course of a trial and its reward.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Document {
    /// The question of the experiment, in one line.
    #[serde(default)]
    pub summary: String,
    /// The arena.
    #[serde(default)]
    pub world: World,
    /// Things in the arena other than robots, each with its own name.
    #[serde(default)]
    pub objects: Vec<Object>,
    /// The robot, or the robots of a team with one genome.
    pub robot: Option<Robot>,
    /// Groups of different robots, instead of `robot`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub robots: Vec<RobotGroup>,
    /// Assignment of genomes to robots.
    #[serde(default)]
    pub team: Team,
    /// Sensors of each robot, in the order of the network's inputs.
    pub sensors: Vec<Sensor>,
    /// Motors of each robot, in the order of the network's outputs.
    pub motors: Vec<Motor>,
    /// The network from sensors to motors.
    pub network: Network,
    /// Steps and trials.
    #[serde(default)]
    pub episode: Episode,
    /// Placements at the start of a trial, in this order. All other things stay at their `at`.
    #[serde(default)]
    pub start: Vec<Start>,
    /// Food and energy, if any.
    pub foraging: Option<Foraging>,
    /// Terms of the fitness.
    pub reward: Vec<Reward>,
    /// Combination of the terms into one number.
    #[serde(default)]
    pub fitness: Fitness,
    /// Conditions of success. A trial succeeds if all of them hold at its end. Without conditions there is no criterion.
    #[serde(default)]
    pub success: Vec<Condition>,
    /// Conditions that end a trial. It ends if any of them holds after a step.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub end: Vec<Condition>,
    /// Conditions of failure. A trial fails and ends if any of them holds after a step.
    #[serde(default)]
    pub failure: Vec<Condition>,
    /// Objectives and measures for strategies that use more than the fitness.
    #[serde(default)]
    pub behaviour: BehaviourOfTerms,
    /// Parts that the test protocol `lesions` cuts, by default `parts`.
    pub lesions: Option<Lesions>,
    /// Test protocols in addition to `lesions` and `noise`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub protocols: Vec<TestProtocol>,
    /// Contents of the files that other keys name, by name. The text of a run contains them.
    #[serde(default)]
    pub files: BTreeMap<String, String>,
    /// Conditions for comparison, the default first. At most a hundred, each checked as an experiment.
    #[serde(default)]
    #[schemars(length(max = 100))]
    pub conditions: Vec<ConditionOfRuns>,
    /// The strategy by its `name`, and the settings of its section `strategy`.
    #[serde(default)]
    pub strategy: BTreeMap<String, serde_json::Value>,
    /// The settings of the section `evolution`, such as generations and population.
    #[serde(default)]
    pub evolution: BTreeMap<String, serde_json::Value>,
    /// Learning from demonstrations, for the strategy `learning`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub learning: Option<Learning>,
    /// Genes of strategies with bits.
    #[serde(default)]
    pub genome: Genome,
}

impl Document {
    /// Returns true for a robot with joints instead of wheels.
    pub(crate) fn has_joints(&self) -> bool {
        self.robot.as_ref().is_some_and(|robot| robot.kind.joints)
    }
}

/// A condition of runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConditionOfRuns {
    /// Name of the condition.
    #[schemars(regex(pattern = NAME))]
    pub name: String,
    /// Changed settings, by their full keys in quotes.
    #[serde(default)]
    pub settings: BTreeMap<String, serde_json::Value>,
}

/// Parts that lesions cut, one in each case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Lesions {
    /// Each input.
    Channels,
    /// Each sensor with all its inputs, and each neuron.
    Parts,
}

/// Test protocols that a file adds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TestProtocol {
    /// Fewer robots than evolved together.
    TeamSize,
    /// Each sensor cut in turn.
    Senses,
}

/// Encoding of parameters in bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Genome {
    /// Bits of a gene.
    #[schemars(range(min = 1, max = 16))]
    pub bits: u32,
}

impl Default for Genome {
    fn default() -> Self {
        Self { bits: 16 }
    }
}

fn yes() -> bool {
    true
}

fn one() -> f64 {
    1.0
}
