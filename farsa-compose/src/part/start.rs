//! Placements.

use farsa_body::Pose;
use farsa_lab::Error;
use farsa_num::Stream;

use crate::part::keys::Keys;
use crate::part::scene::PartScene;

/// A rule for the place of a thing or robot at the start of a trial.
pub trait Start<W: ?Sized> {
    /// Draws the pose of a body. `number` counts the bodies of the rule from 0. Everything placed earlier is already
    /// in the world. Returns `None` if there is no free place, which makes the trial fail.
    fn pose(&self, world: &W, number: usize, stream: &mut Stream) -> Option<Pose>;
}

/// A custom kind of placement, for the key `at` of `[[start]]`. Its fields are the other keys.
pub trait StartPart: Keys {
    /// The rule, as in `impl<W: Kinematics> Start<W> for ..`.
    type Start;

    /// Builds the rule in a scene.
    ///
    /// # Errors
    /// Returns an error if the scene lacks something. Errors of [`PartScene`] name the place in the file.
    fn start(&self, scene: &PartScene<'_>) -> Result<Self::Start, Error>;
}
