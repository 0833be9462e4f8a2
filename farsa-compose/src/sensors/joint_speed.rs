//! Speeds of joints.

use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};

/// Speeds of joints or wheels [rad/s or m/s].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct JointSpeed {
    /// Names, `left-wheel` and `right-wheel` of a robot on wheels, by default all.
    #[serde(default)]
    joints: Vec<String>,
}

impl SensorPart for JointSpeed {
    type Sensor = Vec<sensors::JointSpeed>;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<Self::Sensor, Error> {
        Ok(scene.joints(&self.joints)?.into_iter().map(sensors::JointSpeed::new).collect())
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let joint = scene.0.joint(&self.joints, channel, &|_| true);
        let what = if scene.mobile_robot().is_some() { "speed of the" } else { "speed of" };
        Quantity::new(format!("{what} {}", joint.name), joint.units[1], [0.0, 1.0]).as_label()
    }
}
