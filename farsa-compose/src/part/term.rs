//! Terms of the fitness.

use farsa_lab::Error;

use crate::part::keys::Keys;
use crate::part::scene::PartScene;

/// A measure of a world, for fitness, success, failure and the end of a trial.
pub trait Term<W: ?Sized> {
    /// Stores the state at the start of a trial.
    fn start(&mut self, world: &W) {
        let _ = world;
    }

    /// Updates the state after a step, before the value is computed.
    fn step(&mut self, world: &W) {
        let _ = world;
    }

    /// Computes the value after a step. NaN makes the trial fail.
    fn value(&self, world: &W) -> f64;
}

/// A custom kind of term. Its fields are the keys of the file.
///
/// A term is also a condition: `[[end]]`, `success` and `failure` compare it with limits.
pub trait TermPart: Keys {
    /// The term, as in `impl<W: Kinematics> Term<W> for ..`.
    type Term;

    /// Builds the term of a robot in a scene.
    ///
    /// # Errors
    /// Returns an error if the scene lacks something. Errors of [`PartScene`] name the place in the file.
    fn term(&self, scene: &PartScene<'_>) -> Result<Self::Term, Error>;
}
