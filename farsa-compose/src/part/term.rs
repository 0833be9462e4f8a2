//! Terms of the fitness.

use farsa_lab::Error;

use crate::part::keys::Keys;
use crate::part::moment::Moment;
use crate::part::scene::PartScene;

/// A measure of a world, for fitness, success, failure and the end of a trial.
pub trait Term<W: ?Sized> {
    /// Stores the state at the start of a trial.
    fn start(&mut self, world: &W, now: &Moment<'_>) {
        let _ = (world, now);
    }

    /// Updates the state after a step, before the value is computed.
    fn step(&mut self, world: &W, now: &Moment<'_>) {
        let _ = (world, now);
    }

    /// Computes the value after a step. NaN makes the trial fail.
    fn value(&self, world: &W, now: &Moment<'_>) -> f64;

    /// Returns true for a term with a state that [`step`](Self::step) updates. Each step measures such a term.
    fn has_state(&self) -> bool {
        true
    }
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

    /// Returns true for a term with one value for all robots, that of the first one.
    fn is_of_team(&self) -> bool {
        false
    }

    /// Returns true if the term has the same value in each trial.
    #[doc(hidden)]
    fn is_constant(&self, of: &dyn Constants) -> bool {
        let _ = of;
        false
    }

    /// Gets the formula of a term that is one.
    #[doc(hidden)]
    fn formula(&self) -> Option<&str> {
        None
    }

    /// Gets the names of the joints whose units the value has, empty for all joints.
    #[doc(hidden)]
    fn joints(&self) -> Option<&[String]> {
        None
    }
}

/// Facts about an experiment, for terms that never change.
pub trait Constants {
    /// Returns true for a single robot.
    fn is_alone(&self) -> bool;
    /// Returns true for robots that can hold something.
    fn pulls(&self) -> bool;
    /// Returns true if there is a section `foraging` without food, or without a cost of energy.
    fn foraging(&self) -> [bool; 2];
    /// Returns true for a thing that stays at its place in a trial.
    fn is_fixed(&self, thing: &str) -> bool;
    /// Returns true for a sensor that always reads the same.
    fn is_constant(&self, sensor: &str) -> bool;
    /// Returns true for a formula of numbers and times only.
    fn is_constant_formula(&self, formula: &str) -> bool;
}

/// Facts about a term of unknown type.
pub(crate) trait AnyTerm {
    fn is_of_team(&self) -> bool;
    fn is_constant(&self, of: &dyn Constants) -> bool;
    fn formula(&self) -> Option<&str>;
    fn joints(&self) -> Option<&[String]>;
}

impl<T: TermPart> AnyTerm for T {
    fn is_of_team(&self) -> bool {
        TermPart::is_of_team(self)
    }

    fn is_constant(&self, of: &dyn Constants) -> bool {
        TermPart::is_constant(self, of)
    }

    fn formula(&self) -> Option<&str> {
        TermPart::formula(self)
    }

    fn joints(&self) -> Option<&[String]> {
        TermPart::joints(self)
    }
}
