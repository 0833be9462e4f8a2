//! The values of `icub-reach`.

use farsa_body::robots::{Chain, Icub, IcubPosture, JointControl};
use farsa_lab::Error;

use crate::icub_limits::within_limits;

/// Sensory neurons.
pub(crate) const INPUTS: usize = 3;
/// Motor neurons.
pub(crate) const MOTORS: usize = 6;

/// Inputs and commands of the network.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// The target's place is sensed, joint angles are commanded.
    Steady,
    /// The way from hand to target is sensed, joint speeds are commanded.
    Velocity,
}

impl Condition {
    /// The names on the command line.
    pub const NAMES: [&'static str; 2] = ["steady", "velocity"];

    /// The condition of this name, or the first one.
    pub fn from_name(name: &str) -> Self {
        if name == Self::NAMES[1] { Self::Velocity } else { Self::Steady }
    }
}

/// Half an ellipsoid: the part in front of its center.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volume {
    /// Center of the ellipsoid, relative to the body's center \[m\].
    pub centre: [f64; 3],
    /// Its semi-axes along x, y and z \[m\].
    pub semi_axes: [f64; 3],
}

impl Volume {
    /// The least and the greatest x, y or z of its points \[m\].
    pub fn ends(&self, axis: usize) -> [f64; 2] {
        let (centre, half) = (self.centre[axis], self.semi_axes[axis]);
        [if axis == 0 { centre } else { centre - half }, centre + half]
    }

    /// The point at the given multiples of the semi-axes from the center \[m\].
    pub fn at(&self, parts: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| self.centre[k] + self.semi_axes[k] * parts[k])
    }
}

/// All values of the experiment. The settings name their sources.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Inputs and commands.
    pub condition: Condition,
    /// Targets of an evaluation.
    pub targets: u32,
    /// The same targets in all generations.
    pub same_targets: bool,
    /// Steps of a trial.
    pub steps: u32,
    /// Control step \[s\].
    pub time_step: f64,
    /// Dynamics steps of a control step.
    pub substeps: u32,
    /// Where targets are.
    pub volume: Volume,
    /// Pitch, roll and yaw of the trunk at the start \[deg\].
    pub torso: [f64; 3],
    /// The left arm's seven joints at the start \[deg\].
    pub arm: [f64; 7],
    /// The error at which a position servo exerts its joint's effort \[rad\].
    pub saturation_angle: f64,
    /// The lack of speed at which a velocity motor does \[rad/s\].
    pub saturation_speed: f64,
    /// Largest speed that is commanded \[rad/s\].
    pub speed: f64,
    /// Speed at which a joint that is held returns to its angle, for each radian that it is away from it \[1/s\].
    pub hold_rate: f64,
    /// The way from hand to target that is sensed as -1 or 1, backwards or forwards on an axis \[m\].
    pub offset: f64,
    /// The last seconds of a trial, of which the mean distance is taken \[s\].
    pub window: f64,
    /// Start distances below this count as this \[m\].
    pub least_start: f64,
    /// The mean distance below which a trial is a success \[m\].
    pub success: f64,
    /// Weights and biases are decoded to plus and minus this.
    pub weight_range: f64,
}

impl Config {
    /// The defaults of a condition.
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

    /// The robot with these values: torso and left arm are actuated, all else is rigid.
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

    /// Steps at the end of a trial that are looked at, all at most.
    pub fn window_steps(&self) -> u32 {
        ((self.window / self.time_step + 0.5) as u32).clamp(1, self.steps)
    }

    /// Rules between values.
    ///
    /// # Errors
    /// [`Error::Setting`] for a start out of the joints' limits.
    pub fn check(&self) -> Result<(), Error> {
        let icub = self.icub();
        within_limits(&icub, "start.torso", Chain::Torso, &self.torso)?;
        within_limits(&icub, "start.arm", Chain::LeftArm, &self.arm)
    }
}
