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
    fn quantity(&self, channel: usize) -> Quantity {
        let _ = channel;
        Quantity::default()
    }
}
