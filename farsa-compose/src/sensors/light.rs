//! Light.

use farsa_body::sensors::{Beam, LightSensors};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::wrong;

/// Light intensity at the places of the infrared sensors: 0 dark .. 1.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Light {
    /// Distance at which a sensor that faces a lamp of intensity 1 reads 1 [m].
    #[serde(default = "reference")]
    #[schemars(range(min = 0.0001, max = 100.0))]
    reference: f64,
}

fn reference() -> f64 {
    0.25
}

impl SensorPart for Light {
    type Sensor = LightSensors<Vec<Beam>>;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<Self::Sensor, Error> {
        let place = scene.planar()?;
        LightSensors::for_robot(place.robot, place.parts.body, self.reference as f32).map_err(wrong)
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let angle = scene.mobile_robot().and_then(|robot| robot.infrared.angles.get(channel));
        let angle = angle.map_or(0.0, |angle| angle.to_degrees());
        Quantity::new(format!("light, at {angle:.0} degrees to the left of ahead"), "1", [0.0, 1.0])
    }
}
