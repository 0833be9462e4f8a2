//! Speeds of wheels.

use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::wrong;

/// Wheel speeds, left and right: 0 backwards .. 1/2 at rest .. 1 ahead.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct WheelSpeed {
    /// Reads -1 .. 0 at rest .. 1 instead.
    #[serde(default)]
    signed: bool,
}

impl SensorPart for WheelSpeed {
    type Sensor = sensors::WheelSpeed;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<sensors::WheelSpeed, Error> {
        let place = scene.planar()?;
        let largest = place.robot.max_wheel_speed as f32;
        let sensor = sensors::WheelSpeed::new(place.parts.wheels, largest).map_err(wrong)?;
        Ok(if self.signed { sensor.signed() } else { sensor })
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let largest = scene.mobile_robot().map_or(0.0, |robot| robot.max_wheel_speed);
        let side = ["left", "right"][channel % 2];
        let zero = if self.signed { 0.0 } else { -largest };
        Quantity::new(format!("speed of the {side} wheel"), "rad/s", [zero, largest])
    }
}
