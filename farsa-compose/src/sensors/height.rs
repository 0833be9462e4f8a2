//! Heights.

use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};

/// Height of the robot's origin [m].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Height {
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
    /// Point of that body [m].
    #[serde(default)]
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    point: [f64; 3],
}

impl SensorPart for Height {
    type Sensor = sensors::Height;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<sensors::Height, Error> {
        Ok(sensors::Height::new(scene.0.point(self.body.as_ref(), self.point)?))
    }

    fn quantity(&self, _: usize, scene: &PartScene<'_>) -> Quantity {
        Quantity::new(format!("height of {}", scene.0.called(self.body.as_ref())), "m", [0.0, 1.0])
    }
}
