//! Energy and load of foragers.

use farsa_body::ports::{Channels, Sensor};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};

/// Energy of the robot, 0 dead .. 1, according to `foraging`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Energy {}

/// Food load of the robot: 1 while it carries food, else 0, according to `foraging`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Carried {}

/// A value of the robot's own state.
#[derive(Clone, Debug)]
pub(crate) struct ForagerSensor {
    value: f32,
    feel: fn(f64, u32) -> f32,
}

impl ForagerSensor {
    /// Creates a sensor of 0.
    fn new(scene: &PartScene<'_>, feel: fn(f64, u32) -> f32) -> Result<Self, Error> {
        if !scene.0.has_food() {
            return Err(scene.error("needs the section `foraging`, which there is not"));
        }
        Ok(Self { value: 0.0, feel })
    }

    /// Updates the value by the energy \[0..1\] and the pieces of food.
    pub(crate) fn feel(&mut self, energy: f64, carried: u32) {
        self.value = (self.feel)(energy, carried);
    }
}

impl Channels for ForagerSensor {
    fn channels(&self) -> usize {
        1
    }
}

impl<W: ?Sized> Sensor<W> for ForagerSensor {
    fn read(&mut self, _: &W, out: &mut [f32]) {
        out.iter_mut().take(1).for_each(|out| *out = self.value);
    }
}

impl SensorPart for Energy {
    type Sensor = ForagerSensor;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<ForagerSensor, Error> {
        ForagerSensor::new(scene, |energy, _| energy as f32)
    }

    fn quantity(&self, _: usize, _: &PartScene<'_>) -> Quantity {
        Quantity::new("energy, 0 dead", "1", [0.0, 1.0])
    }
}

impl SensorPart for Carried {
    type Sensor = ForagerSensor;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<ForagerSensor, Error> {
        ForagerSensor::new(scene, |_, carried| f32::from(u8::from(carried > 0)))
    }

    fn quantity(&self, _: usize, _: &PartScene<'_>) -> Quantity {
        Quantity::new("whether food is carried", "1", [0.0, 1.0])
    }
}
