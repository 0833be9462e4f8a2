//! Traction.

use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::wrong;

/// Traction force on the robot, ahead and to the left: -1 to 1.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Traction {
    /// Difference of speeds that reads 1 [m/s].
    #[schemars(range(min = 0.0001, max = 100.0))]
    largest: f64,
}

impl SensorPart for Traction {
    type Sensor = sensors::Traction;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<sensors::Traction, Error> {
        let place = scene.planar()?;
        let (parts, radius) = (place.parts, place.robot.wheel_radius as f32);
        sensors::Traction::new(parts.body, parts.wheels, radius, self.largest as f32).map_err(wrong)
    }

    fn quantity(&self, channel: usize, _: &PartScene<'_>) -> Quantity {
        let way = ["ahead", "to the left"][channel % 2];
        Quantity::new(format!("speed at which the robot is pulled {way}"), "m/s", [0.0, self.largest])
    }
}
