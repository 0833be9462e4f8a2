//! Configuration of the experiment `icub-reach`.

use farsa_body::robots::{Chain, Icub, IcubPosture, JointControl};
use farsa_lab::Error;

use crate::icub_limits::within_limits;

/// Sensory neurons.
pub(crate) const INPUTS: usize = 3;
/// Motor neurons.
pub(crate) const MOTORS: usize = 6;

/// Defines the inputs of the network and the commands that it sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// The network senses the position of the target and commands joint angles.
    Steady,
    /// The network senses the vector from the hand to the target and commands joint speeds.
    Velocity,
}

impl Condition {
    /// The names of the conditions, as they are used on the command line.
    pub const NAMES: [&'static str; 2] = ["steady", "velocity"];

    /// Returns the condition with the given name. An unknown name results in the first condition.
    pub fn from_name(name: &str) -> Self {
        if name == Self::NAMES[1] { Self::Velocity } else { Self::Steady }
    }
}

/// A volume in the shape of half an ellipsoid. Only the part in front of its center belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volume {
    /// Center of the ellipsoid, relative to the center of the robot's body (in meters).
    pub centre: [f64; 3],
    /// Semi-axes of the ellipsoid along x, y and z (in meters).
    pub semi_axes: [f64; 3],
}

impl Volume {
    /// Returns the smallest and the largest coordinate of the volume along an axis (in meters).
    pub fn ends(&self, axis: usize) -> [f64; 2] {
        let (centre, half) = (self.centre[axis], self.semi_axes[axis]);
        [if axis == 0 { centre } else { centre - half }, centre + half]
    }

    /// Returns the point whose distance from the center is given in multiples of the semi-axes (in meters).
    pub fn at(&self, parts: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| self.centre[k] + self.semi_axes[k] * parts[k])
    }
}

/// The complete configuration of the experiment. The table of settings gives the source of each value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Selects the inputs and the commands.
    pub condition: Condition,
    /// Number of targets in an evaluation.
    pub targets: u32,
    /// If true, all generations use the same targets.
    pub same_targets: bool,
    /// Number of steps of a trial.
    pub steps: u32,
    /// Duration of a control step (in seconds).
    pub time_step: f64,
    /// Number of dynamics steps in each control step.
    pub substeps: u32,
    /// Volume in which the targets are placed.
    pub volume: Volume,
    /// Initial pitch, roll and yaw of the trunk (in degrees).
    pub torso: [f64; 3],
    /// Initial angles of the seven joints of the left arm (in degrees).
    pub arm: [f64; 7],
    /// Position error at which a servo reaches the maximum effort of its joint (in radians). The default is 0.1.
    pub saturation_angle: f64,
    /// Difference between the commanded and the actual speed at which a motor reaches its maximum effort (in
    /// radians per second).
    pub saturation_speed: f64,
    /// Largest speed that the network can command (in radians per second).
    pub speed: f64,
    /// Rate at which a joint that should not move returns to its angle, in 1/s. The commanded speed is proportional
    /// to the deviation.
    pub hold_rate: f64,
    /// Distance between hand and target that is sensed as 1 along an axis (in meters). In the opposite direction it
    /// is sensed as -1.
    pub offset: f64,
    /// Length of the period at the end of a trial over which the distance is averaged (in seconds).
    pub window: f64,
    /// A lower bound of the start distance in the fitness (in meters).
    pub least_start: f64,
    /// Mean distance below which a trial is successful (in meters).
    pub success: f64,
    /// Largest absolute value of a weight or bias.
    pub weight_range: f64,
}

impl Config {
    /// Returns the default configuration of a condition.
    pub const fn for_condition(condition: Condition) -> Self {
        Self {
            condition,
            targets: 20,
            same_targets: false,
            steps: 200,
            time_step: 0.05,
            substeps: match condition {
                Condition::Steady => 8,
                Condition::Velocity => 5,
            },
            volume: Volume { centre: [0.22, 0.11, 0.20], semi_axes: [0.16, 0.18, 0.18] },
            torso: [0.0; 3],
            arm: [-30.0, 30.0, 0.0, 60.0, 0.0, 0.0, 0.0],
            saturation_angle: 0.1,
            saturation_speed: 0.02,
            speed: 1.0,
            hold_rate: 5.0,
            offset: 0.1,
            window: 2.0,
            least_start: 0.3,
            success: 0.03,
            weight_range: 4.0,
        }
    }

    /// Builds the description of the robot. The torso and the left arm are actuated, and all other joints are rigid.
    pub fn icub(&self) -> Icub {
        let posture = IcubPosture {
            torso: self.torso.map(f64::to_radians),
            left_arm: self.arm.map(f64::to_radians),
            ..IcubPosture::default()
        };
        Icub {
            actuated: vec![Chain::Torso, Chain::LeftArm],
            posture,
            control: match self.condition {
                Condition::Steady => JointControl::Position,
                Condition::Velocity => JointControl::Velocity,
            },
            saturation_angle: self.saturation_angle,
            saturation_speed: self.saturation_speed,
            ..Icub::default()
        }
    }

    /// Returns the number of steps in the final period. It never exceeds the length of the trial.
    pub fn window_steps(&self) -> u32 {
        ((self.window / self.time_step + 0.5) as u32).clamp(1, self.steps)
    }

    /// Checks that the values are compatible with each other.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if the initial posture violates a joint limit.
    pub fn check(&self) -> Result<(), Error> {
        let icub = self.icub();
        within_limits(&icub, "start.torso", Chain::Torso, &self.torso)?;
        within_limits(&icub, "start.arm", Chain::LeftArm, &self.arm)
    }
}
