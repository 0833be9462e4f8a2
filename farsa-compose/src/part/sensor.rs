//! Sensors.

use farsa_body::robots::MobileRobot;
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
    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let _ = (channel, scene);
        Quantity::default()
    }

    /// Counts the rays of a step, of which an experiment may have a limited number.
    fn rays(&self, robot: Option<&MobileRobot>) -> usize {
        let _ = robot;
        0
    }

    /// Returns true for a sensor that always reads the same.
    fn is_constant(&self) -> bool {
        false
    }

    /// Lists the files that the sensor reads from the experiment's folder, each with its key.
    #[doc(hidden)]
    fn files(&self) -> Vec<(String, String)> {
        Vec::new()
    }
}

/// Facts about a sensor of unknown type.
pub(crate) trait AnySensor {
    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity;
    fn rays(&self, robot: Option<&MobileRobot>) -> usize;
    fn is_constant(&self) -> bool;
    fn files(&self) -> Vec<(String, String)>;
}

impl<T: SensorPart> AnySensor for T {
    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        SensorPart::quantity(self, channel, scene)
    }

    fn rays(&self, robot: Option<&MobileRobot>) -> usize {
        SensorPart::rays(self, robot)
    }

    fn is_constant(&self) -> bool {
        SensorPart::is_constant(self)
    }

    fn files(&self) -> Vec<(String, String)> {
        SensorPart::files(self)
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
    /// True for a linear scale between them.
    pub is_linear: bool,
    /// True if the description names the channel better than the part and a number.
    pub is_label: bool,
}

impl Quantity {
    /// Creates a quantity with a linear scale.
    pub fn new(text: impl Into<String>, unit: &'static str, ends: [f64; 2]) -> Self {
        Self { text: text.into(), unit, ends, is_linear: true, is_label: false }
    }

    /// Appends the changes of wrappers, if any.
    pub(crate) fn with(self, changes: &str) -> Self {
        if changes.is_empty() { self } else { Self { text: format!("{}, with {changes}", self.text), ..self } }
    }

    /// Makes the description the label of the channel.
    #[must_use]
    pub fn as_label(self) -> Self {
        Self { is_label: true, ..self }
    }
}

impl Default for Quantity {
    fn default() -> Self {
        Self::new("value of a part of the user's program", "1", [0.0, 1.0])
    }
}
