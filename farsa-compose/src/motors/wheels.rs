//! Wheels.

use farsa_body::motors::WheelVelocity;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::motors::wrong;
use crate::part::{MotorPart, PartScene, Quantity};

/// Left and right wheel: 0 backwards .. 1/2 at rest .. 1 ahead.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Wheels {}

impl MotorPart for Wheels {
    type Motor = WheelVelocity;

    fn motor(&self, scene: &PartScene<'_>) -> Result<WheelVelocity, Error> {
        let place = scene.planar()?;
        let largest = place.robot.max_wheel_speed as f32;
        WheelVelocity::new(place.parts.motors, largest).map_err(wrong)
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let largest = scene.mobile_robot().map_or(0.0, |robot| robot.max_wheel_speed);
        let side = ["left", "right"][channel % 2];
        Quantity::new(format!("speed of the {side} wheel"), "rad/s", [-largest, largest])
    }

    fn channels(&self) -> &'static [&'static str] {
        &["left", "right"]
    }

    fn rest(&self, _: usize) -> f32 {
        0.5
    }
}
