//! Color of the ground.

use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::{first, wrong};

/// Color of the ground under the robot: gray, or red, green and blue, 0 to 1 each.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct GroundColor {
    /// Reads red, green and blue separately.
    #[serde(default)]
    rgb: bool,
    /// Number of the robot's places, from the first. 0 means all.
    #[serde(default)]
    #[schemars(range(min = 0, max = 64))]
    first: u32,
    /// Reads only the place under the robot's center.
    #[serde(default)]
    middle: bool,
}

impl SensorPart for GroundColor {
    type Sensor = sensors::GroundColor<Vec<[f32; 2]>>;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<Self::Sensor, Error> {
        let place = scene.planar()?;
        let places = if self.middle { vec![[0.0; 2]] } else { first(&place.robot.ground, self.first)? };
        let places: Vec<[f32; 2]> = places.into_iter().map(|at| at.map(|x| x as f32)).collect();
        let sensor = sensors::GroundColor::new(place.parts.body, places).map_err(wrong)?;
        Ok(if self.rgb { sensor.rgb() } else { sensor })
    }

    fn quantity(&self, channel: usize, _: &PartScene<'_>) -> Quantity {
        let text = match (self.rgb, self.middle) {
            (false, true) => "grey of the ground under the middle".into(),
            (false, false) => format!("grey of the ground at place {}", channel + 1),
            (true, _) => {
                let color = ["red", "green", "blue"][channel % 3];
                format!("{color} of the ground at place {}", channel / 3 + 1)
            }
        };
        Quantity::new(text, "1", [0.0, 1.0])
    }
}
