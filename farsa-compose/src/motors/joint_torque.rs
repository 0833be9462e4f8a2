//! Torques of joints.

use farsa_body::motors::TorqueMotor;
use farsa_body::ports::JointId;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::motors::wrong;
use crate::part::wiring::is_torque;
use crate::part::{MotorPart, PartScene, Quantity};

/// Torques of joints, one channel each: 0 down .. 1/2 none .. 1 up.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct JointTorque {
    /// Names of joints, by default all of the robot.
    #[serde(default)]
    joints: Vec<String>,
    /// Largest torque [N m or N], by default that of the model's own motor.
    #[schemars(range(min = 1e-9, max = 1e9))]
    largest: Option<f64>,
}

impl MotorPart for JointTorque {
    type Motor = Vec<TorqueMotor>;

    fn motor(&self, scene: &PartScene<'_>) -> Result<Vec<TorqueMotor>, Error> {
        let build = |joint: JointId| {
            let (actuator, largest) = scene.torque(joint, self.largest)?;
            TorqueMotor::new(actuator, largest as f32).map_err(wrong)
        };
        scene.driven(&self.joints, self.largest.is_some(), is_torque)?.into_iter().map(build).collect()
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let joint = scene.driven_joint(&self.joints, channel, self.largest.is_some(), is_torque);
        let largest = self.largest.or(joint.torque).unwrap_or(1.0);
        Quantity::new(format!("torque of {}", joint.name), joint.units[2], [-largest, largest]).as_label()
    }
}
