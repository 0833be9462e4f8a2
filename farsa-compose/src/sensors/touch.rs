//! Contacts.

use farsa_body::ports::PairId;
use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::wrong;

/// Contact of the robot: 1 while it touches something, else 0.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Touch {
    /// Bodies of a robot with joints that sense contact, by default all of them.
    #[serde(default)]
    bodies: Vec<String>,
    /// The only thing that counts, or `floor`, for a robot with joints.
    with: Option<String>,
}

impl SensorPart for Touch {
    type Sensor = sensors::Touch<Vec<PairId>>;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<Self::Sensor, Error> {
        sensors::Touch::new(scene.0.touching(&self.bodies, self.with.as_ref())?, 1.0).map_err(wrong)
    }

    fn quantity(&self, _: usize, _: &PartScene<'_>) -> Quantity {
        Quantity::new("whether something is touched", "1", [0.0, 1.0])
    }
}
