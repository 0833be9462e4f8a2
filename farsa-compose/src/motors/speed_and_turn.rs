//! Speed and turn of a robot on wheels.

use farsa_body::motors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::motors::wrong;
use crate::part::{MotorPart, PartScene, Quantity};

/// Speed, 0 backwards .. 1 ahead, and turn, 0 right .. 1/2 straight on .. 1 left.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct SpeedAndTurn {
    /// Never drives backwards: 0 is at rest.
    #[serde(default)]
    forwards: bool,
}

impl MotorPart for SpeedAndTurn {
    type Motor = motors::SpeedAndTurn;

    fn motor(&self, scene: &PartScene<'_>) -> Result<motors::SpeedAndTurn, Error> {
        let place = scene.planar()?;
        let largest = place.robot.max_wheel_speed as f32;
        let motor = motors::SpeedAndTurn::new(place.parts.motors, largest).map_err(wrong)?;
        Ok(if self.forwards { motor.forwards() } else { motor })
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let largest = scene.mobile_robot().map_or(0.0, |robot| robot.max_wheel_speed);
        if channel == 0 {
            let zero = if self.forwards { 0.0 } else { -largest };
            return Quantity::new("s, the mean of the wheels' speeds", "rad/s", [zero, largest]);
        }
        Quantity::new("t: the left wheel turns at s - t, the right one at s + t", "rad/s", [-largest, largest])
    }

    fn channels(&self) -> &'static [&'static str] {
        &["speed", "turn"]
    }

    fn rest(&self, channel: usize) -> f32 {
        if self.forwards && channel == 0 { 0.0 } else { 0.5 }
    }
}
