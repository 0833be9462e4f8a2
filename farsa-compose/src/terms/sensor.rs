//! Values of sensors.

use farsa_lab::Error;
use farsa_num::Scalar;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::term::Constants;
use crate::part::{Moment, PartScene, Term, TermPart};

/// Largest value of a sensor's channels.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Sensor {
    /// Name of the sensor.
    sensor: String,
}

/// The number of the robot, with the first channel of a sensor and the one after the last.
#[derive(Clone, Debug)]
pub(super) struct SensorTerm(usize, [usize; 2]);

impl<W: ?Sized> Term<W> for SensorTerm {
    fn value(&self, _: &W, now: &Moment<'_>) -> f64 {
        let Self(robot, [first, end]) = *self;
        let channels = now.sensed(robot).get(first..end).unwrap_or_default();
        channels.iter().map(|x| f64::from(*x)).reduce(Scalar::max).unwrap_or(0.0)
    }

    fn has_state(&self) -> bool {
        false
    }
}

impl TermPart for Sensor {
    type Term = SensorTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<SensorTerm, Error> {
        Ok(SensorTerm(scene.0.robot(), scene.0.sensor_channels(&self.sensor, "sensor")?))
    }

    fn is_constant(&self, of: &dyn Constants) -> bool {
        of.is_constant(&self.sensor)
    }
}
