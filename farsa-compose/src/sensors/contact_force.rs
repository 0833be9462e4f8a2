//! Contact forces.

use farsa_body::ports::PairId;
use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};

/// Sum of the contact forces on the robot [N], nominal in the kinematic arena.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct ContactForce {
    /// Bodies of a robot with joints that sense contact, by default all of them.
    #[serde(default)]
    bodies: Vec<String>,
    /// The only thing that counts, or `floor`, for a robot with joints.
    with: Option<String>,
}

impl SensorPart for ContactForce {
    type Sensor = sensors::ContactForce<Vec<PairId>>;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<Self::Sensor, Error> {
        Ok(sensors::ContactForce::new(scene.0.touching(&self.bodies, self.with.as_ref())?))
    }

    fn quantity(&self, _: usize, _: &PartScene<'_>) -> Quantity {
        Quantity::new("force", "N", [0.0, 1.0])
    }
}
