//! Sensors.

use farsa_lab::Error;

use crate::part::keys::Keys;
use crate::part::scene::PartScene;

/// A custom kind of sensor. Its fields are the keys of the file.
pub trait SensorPart: Keys {
    /// The sensor. It reads a world through its ports, as in `impl<W: Kinematics> Sensor<W> for ..`.
    type Sensor;

    /// Builds the sensor of a robot in a scene.
    ///
    /// # Errors
    /// Returns an error if the scene lacks something. Errors of [`PartScene`] name the place in the file.
    fn sensor(&self, scene: &PartScene<'_>) -> Result<Self::Sensor, Error>;

    /// Describes the quantity of a channel, for pages and exported controllers.
    fn quantity(&self, channel: usize) -> Quantity {
        let _ = channel;
        Quantity::default()
    }
}

/// The quantity that a channel carries.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Description, such as `bearing of the nest`.
    pub text: String,
    /// Unit, `1` without one.
    pub unit: &'static str,
    /// Values of the quantity at 0 and at 1 of the channel.
    pub ends: [f64; 2],
}

impl Default for Quantity {
    fn default() -> Self {
        Self { text: "value of a part of the user's program".into(), unit: "1", ends: [0.0, 1.0] }
    }
}
