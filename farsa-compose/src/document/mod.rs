//! What a file says, as data: the schema of the format is made of these types.
//!
//! - `world`: the arena and what stands in it
//! - `robot`: the robots
//! - `sensor`: what they sense
//! - `motor`: what they do
//! - `wrapper`: what changes values on their way from a sensor or to a motor
//! - `network`: what connects sensors with motors
//! - `blocks`: a network of clusters of neurons and links between them
//! - `evonet`: the network of the original FARSA
//! - `episode`: how a trial starts, goes on and ends
//! - `behaviour`: what there is to say of an individual beside its fitness
//! - `foraging`: food and energy
//! - `reward`: what a trial earns, and when it has succeeded

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::name::NAME;

mod behaviour;
mod blocks;
mod episode;
mod evonet;
mod foraging;
mod motor;
mod network;
mod reward;
mod robot;
mod sensor;
mod world;
mod wrapper;

pub use behaviour::{BehaviourOfTerms, DescriptorTerm, ObjectiveTerm};
pub use blocks::{Blocks, Cluster, ClusterActivation, Link};
pub use episode::{Ending, Episode, Placing, Start};
pub use evonet::{Evonet, EvonetNeurons};
pub use foraging::Foraging;
pub use motor::{Led, Motor, MotorKind};
pub use network::{Activation, Network, NetworkKind, WeightOrder, Wire};
pub use reward::{Condition, Fitness, Over, Reward, RewardKind, Trials};
pub use robot::{Robot, RobotGroup, RobotKind, Team};
pub use sensor::{AxesName, Camera, ColorRange, Eye, InfraredModel, MeasuredBody, MeasuredTables, Sensor, SensorKind};
pub use world::{Engine, Object, ObjectKind, World};
pub use wrapper::Wrapper;

/// An experiment: robots in a world, what they sense, do and compute with, how a trial goes and what it earns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Document {
    /// What is asked, in one line.
    #[serde(default)]
    pub summary: String,
    /// The arena.
    #[serde(default)]
    pub world: World,
    /// What stands in the arena beside robots, each by a name of its own.
    #[serde(default)]
    pub objects: Vec<Object>,
    /// The robot, or the robots of a team: all alike, with one genome.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robot: Option<Robot>,
    /// Robots that are not all alike, in groups; in place of `robot`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub robots: Vec<RobotGroup>,
    /// Whose genomes robots have.
    #[serde(default)]
    pub team: Team,
    /// What each robot senses, in the order of the network's inputs.
    pub sensors: Vec<Sensor>,
    /// What each robot does, in the order of the network's outputs.
    pub motors: Vec<Motor>,
    /// What turns the sensors' values into the motors'.
    pub network: Network,
    /// Steps and trials.
    #[serde(default)]
    pub episode: Episode,
    /// Where a trial puts things, in this order; what is not named stays where its `at` says.
    #[serde(default)]
    pub start: Vec<Start>,
    /// Food and energy, if there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foraging: Option<Foraging>,
    /// What a trial earns: the terms of the fitness.
    pub reward: Vec<Reward>,
    /// How the terms become one number.
    #[serde(default)]
    pub fitness: Fitness,
    /// When a trial has succeeded: if all of these hold at its end; by default it never does.
    #[serde(default)]
    pub success: Vec<Condition>,
    /// When a trial has failed, which ends it: if any of these holds after a step.
    #[serde(default)]
    pub failure: Vec<Condition>,
    /// What strategies with several objectives or with an archive look at.
    #[serde(default)]
    pub behaviour: BehaviourOfTerms,
    /// Contents of the files that others keys name, by their names. The text of a run has them, so that it needs no other file.
    #[serde(default)]
    pub files: BTreeMap<String, String>,
    /// Conditions that are compared, the default one first: at most a hundred, each of which is checked as an experiment.
    #[serde(default)]
    #[schemars(length(max = 100))]
    pub conditions: Vec<ConditionOfRuns>,
    /// The strategy by its `name`, and its settings of the section `strategy`.
    #[serde(default)]
    pub strategy: BTreeMap<String, serde_json::Value>,
    /// The settings of the section `evolution`: generations, population and what else the strategy has.
    #[serde(default)]
    pub evolution: BTreeMap<String, serde_json::Value>,
    /// Genes of strategies that search with bits.
    #[serde(default)]
    pub genome: Genome,
}

impl Document {
    /// Whether its robot has joints instead of wheels in a plane.
    pub(crate) fn has_joints(&self) -> bool {
        self.robot.as_ref().is_some_and(|robot| robot.kind.has_joints())
    }
}

/// A condition of runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConditionOfRuns {
    /// What it is called.
    #[schemars(regex(pattern = NAME))]
    pub name: String,
    /// The settings that differ from what the file says, by their full keys in quotes.
    #[serde(default)]
    pub settings: BTreeMap<String, serde_json::Value>,
}

/// How parameters are encoded by strategies that search with bits.
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

/// The default of what is there unless it is switched off.
fn yes() -> bool {
    true
}
