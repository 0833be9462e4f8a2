//! Placements.

use farsa_body::Pose;
use farsa_lab::Error;
use farsa_num::Stream;

use crate::part::keys::Keys;
use crate::part::scene::PartScene;
use crate::part::spot::Spot;

/// A rule for the place of a thing or robot at the start of a trial.
pub trait Start<W: ?Sized> {
    /// Draws the pose of a body. Everything placed earlier is already in the world. Returns `None` if there is no free
    /// place, which makes the trial fail.
    fn pose(&self, world: &W, spot: &mut Spot<'_>, stream: &mut Stream) -> Option<Pose>;

    /// Draws the position of a joint \[rad or m\].
    fn position(&self, stream: &mut Stream) -> Option<f32> {
        let _ = stream;
        None
    }

    /// Draws the position \[rad or m\] and the speed of a joint, or one number of the pose and velocity of a free body, around a
    /// position of the posture.
    #[doc(hidden)]
    fn around(&self, position: f32, stream: &mut Stream) -> Option<[f32; 2]> {
        let _ = (position, stream);
        None
    }
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

    /// Returns true for a rule of joints, which has [`Start::position`].
    fn is_of_joints(&self) -> bool {
        false
    }

    /// Returns true for a rule with one place, which is not for several bodies.
    fn is_one_place(&self) -> bool {
        false
    }

    /// Returns true if distances from areas are measured from their centers.
    #[doc(hidden)]
    fn measures_centers(&self) -> bool {
        false
    }

    /// Returns the name of the posture of a rule for the whole robot, which has [`Start::around`], and the height by which it is
    /// raised \[m\]. The name is empty for the configuration of the file.
    #[doc(hidden)]
    fn posture(&self) -> Option<(&str, f64)> {
        None
    }

    /// Counts the points of which a trial takes one.
    #[doc(hidden)]
    fn points(&self) -> Option<usize> {
        None
    }
}

/// Facts about a placement of unknown type.
pub(crate) trait AnyStart {
    fn is_of_joints(&self) -> bool;
    fn is_one_place(&self) -> bool;
    fn measures_centers(&self) -> bool;
    fn posture(&self) -> Option<(&str, f64)>;
    fn points(&self) -> Option<usize>;
}

impl<T: StartPart> AnyStart for T {
    fn is_of_joints(&self) -> bool {
        StartPart::is_of_joints(self)
    }

    fn is_one_place(&self) -> bool {
        StartPart::is_one_place(self)
    }

    fn measures_centers(&self) -> bool {
        StartPart::measures_centers(self)
    }

    fn posture(&self) -> Option<(&str, f64)> {
        StartPart::posture(self)
    }

    fn points(&self) -> Option<usize> {
        StartPart::points(self)
    }
}
