//! Rules that end a trial.

use farsa_lab::Error;

use crate::part::keys::Keys;
use crate::part::moment::Moment;
use crate::part::scene::PartScene;

/// A rule that ends a trial before its last step.
pub trait End<W: ?Sized> {
    /// Returns true if the trial ends after this step. `success` is true if all conditions of success hold now. It is
    /// always false for a rule without [`EndPart::DEPENDS_ON_SUCCESS`].
    fn ends(&self, world: &W, now: &Moment<'_>, success: bool) -> bool;
}

/// A custom kind of end, a word for the list `ends` of `[episode]`. It has no keys.
///
/// For a limit of a measure, register a term instead and compare it in `[[end]]`.
pub trait EndPart: Keys {
    /// The rule, as in `impl<W: Kinematics> End<W> for ..`.
    type End;

    /// True for a rule that depends on success, which is then computed in each step.
    const DEPENDS_ON_SUCCESS: bool = false;

    /// Builds the rule in a scene.
    ///
    /// # Errors
    /// Returns an error if the scene lacks something. Errors of [`PartScene`] name the place in the file.
    fn end(&self, scene: &PartScene<'_>) -> Result<Self::End, Error>;
}
