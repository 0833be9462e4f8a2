//! Laser range finders.

use farsa_body::robots::MobileRobot;
use farsa_body::sensors::{self, Beam};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::wrong;

/// A fan of laser range finders: 0 at the hull .. 1 nothing within the range.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct LaserDistance {
    /// Beams, from left to right.
    #[schemars(range(min = 1, max = 10000))]
    beams: u32,
    /// Width of the fan around straight ahead [deg].
    #[schemars(range(min = 0.0, max = 360.0))]
    field_of_view: f64,
    /// Range from the hull [m].
    #[schemars(range(min = 0.001, max = 1000.0))]
    range: f64,
    /// Height of the beams [m].
    #[serde(default = "height")]
    #[schemars(range(min = 0.0, max = 100.0))]
    height: f64,
}

fn height() -> f64 {
    0.02
}

impl LaserDistance {
    /// Returns beams from left to right, each from the hull outwards.
    fn fan(&self, radius: f64) -> Vec<Beam> {
        let beam = |beam: u32| {
            let share = if self.beams > 1 { 0.5 - f64::from(beam) / f64::from(self.beams - 1) } else { 0.0 };
            Beam::in_cone(radius, share * self.field_of_view.to_radians(), 0.0, 0, 1)
        };
        (0..self.beams).map(beam).collect()
    }
}

impl SensorPart for LaserDistance {
    type Sensor = sensors::LaserDistance<Vec<Beam>>;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<Self::Sensor, Error> {
        let place = scene.planar()?;
        let (fan, [height, range]) = (self.fan(place.robot.radius), [self.height, self.range].map(|x| x as f32));
        sensors::LaserDistance::new(place.parts.body, fan, height, range).map_err(wrong)
    }

    fn quantity(&self, channel: usize, _: &PartScene<'_>) -> Quantity {
        Quantity::new(format!("distance along beam {} from the left", channel + 1), "m", [0.0, self.range])
    }

    fn rays(&self, _: Option<&MobileRobot>) -> usize {
        self.beams as usize
    }
}
