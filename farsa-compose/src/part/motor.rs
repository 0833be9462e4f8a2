//! Motors.

use farsa_lab::Error;

use crate::part::keys::Keys;
use crate::part::scene::PartScene;
use crate::part::sensor::Quantity;

/// A custom kind of motor. Its fields are the keys of the file.
pub trait MotorPart: Keys {
    /// The motor. It drives a world through its ports, as in `impl<W: Actuated> Motor<W> for ..`.
    type Motor;

    /// Builds the motor of a robot in a scene.
    ///
    /// # Errors
    /// Returns an error if the scene lacks something. Errors of [`PartScene`] name the place in the file.
    fn motor(&self, scene: &PartScene<'_>) -> Result<Self::Motor, Error>;

    /// Describes the quantity of a channel, for pages and exported controllers.
    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let _ = (channel, scene);
        Quantity::default()
    }

    /// Names the channels, by default with numbers.
    fn channels(&self) -> &'static [&'static str] {
        &[]
    }

    /// Returns the value of a channel at rest.
    fn rest(&self, channel: usize) -> f32 {
        let _ = channel;
        0.0
    }

    /// Returns true for a motor that moves other robots and things without touching them.
    fn pulls(&self) -> bool {
        false
    }
}

/// Facts about a motor of unknown type.
pub(crate) trait AnyMotor {
    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity;
    fn channels(&self) -> &'static [&'static str];
    fn rest(&self, channel: usize) -> f32;
    fn pulls(&self) -> bool;
}

impl<T: MotorPart> AnyMotor for T {
    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        MotorPart::quantity(self, channel, scene)
    }

    fn channels(&self) -> &'static [&'static str] {
        MotorPart::channels(self)
    }

    fn rest(&self, channel: usize) -> f32 {
        MotorPart::rest(self, channel)
    }

    fn pulls(&self) -> bool {
        MotorPart::pulls(self)
    }
}
