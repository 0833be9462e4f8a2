//! LEDs.

use farsa_body::motors;
use farsa_body::ports::{Actuated, ActuatorId, Channels, Handles, Motor};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{MotorPart, PartScene, Quantity};

/// LEDs, 0 dark .. 1.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Leds {
    /// LEDs by color.
    colors: Vec<Led>,
    /// Accepts robots without LEDs, which then show no light.
    #[serde(default)]
    optional: bool,
}

/// An LED of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum Led {
    /// The red one.
    Red,
    /// The green one.
    Green,
    /// The blue one.
    Blue,
}

/// One to three LEDs, or outputs without effect.
#[derive(Clone, Debug)]
pub(super) enum LedMotor {
    One(motors::Leds<ActuatorId, 1>),
    Two(motors::Leds<ActuatorId, 2>),
    Three(motors::Leds<ActuatorId, 3>),
    Absent(usize),
}

impl Channels for LedMotor {
    fn channels(&self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Two(_) => 2,
            Self::Three(_) => 3,
            Self::Absent(channels) => *channels,
        }
    }
}

impl<W: Actuated + Handles<Actuator = ActuatorId>> Motor<W> for LedMotor {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        match self {
            Self::One(leds) => leds.drive(y, world),
            Self::Two(leds) => leds.drive(y, world),
            Self::Three(leds) => leds.drive(y, world),
            Self::Absent(_) => {}
        }
    }
}

impl MotorPart for Leds {
    type Motor = LedMotor;

    fn motor(&self, scene: &PartScene<'_>) -> Result<LedMotor, Error> {
        let place = scene.planar()?;
        let Some(leds) = place.parts.leds else {
            return if self.optional { Ok(LedMotor::Absent(self.colors.len())) } else { Err(place.lacks("LEDs")) };
        };
        let led = |color: &Led| leds[*color as usize];
        match self.colors.as_slice() {
            [a] => Ok(LedMotor::One(motors::Leds::new([led(a)]))),
            [a, b] => Ok(LedMotor::Two(motors::Leds::new([led(a), led(b)]))),
            [a, b, c] => Ok(LedMotor::Three(motors::Leds::new([led(a), led(b), led(c)]))),
            _ => Err(place.lacks("one to three colours of LEDs")),
        }
    }

    fn quantity(&self, channel: usize, _: &PartScene<'_>) -> Quantity {
        let color = self.colors.get(channel).map_or_else(String::new, |color| format!("{color:?}").to_lowercase());
        Quantity::new(format!("brightness of the {color} LED"), "1", [0.0, 1.0])
    }
}
