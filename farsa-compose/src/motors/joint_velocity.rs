//! Speeds of joints.

use farsa_body::motors::VelocityMotor;
use farsa_body::ports::JointId;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::motors::wrong;
use crate::part::wiring::is_velocity;
use crate::part::{MotorPart, PartScene, Quantity};

/// Speeds of joints, one channel each: 0 down .. 1/2 at rest .. 1 up.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct JointVelocity {
    /// Names of joints, by default all of the robot.
    #[serde(default)]
    joints: Vec<String>,
    /// Greatest speed [rad/s or m/s].
    #[schemars(range(min = 1e-6, max = 1e6))]
    largest: f64,
    /// Torque per missing speed [N m s/rad or N s/m], by default that of the model's own motor.
    #[schemars(range(min = 1e-9, max = 1e9))]
    gain: Option<f64>,
    /// Largest torque of a motor with this `gain` [N m or N], by default unlimited.
    #[schemars(range(min = 1e-9, max = 1e9))]
    limit: Option<f64>,
}

impl MotorPart for JointVelocity {
    type Motor = Vec<VelocityMotor>;

    fn motor(&self, scene: &PartScene<'_>) -> Result<Vec<VelocityMotor>, Error> {
        let build = |joint: JointId| {
            let (actuator, gain) = scene.velocity(joint, [self.gain, self.limit])?;
            VelocityMotor::new(actuator, self.largest as f32, gain as f32).map_err(wrong)
        };
        scene.driven(&self.joints, self.gain.is_some(), is_velocity)?.into_iter().map(build).collect()
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let joint = scene.driven_joint(&self.joints, channel, self.gain.is_some(), is_velocity);
        let ends = [-self.largest, self.largest];
        Quantity::new(format!("speed of {}", joint.name), joint.units[1], ends).as_label()
    }
}
