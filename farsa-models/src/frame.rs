//! Frames of a file's links and bodies.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
/// Frame of a link or body of the file.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Frame {
    /// Name of the link or body in the file. If the N-th body of an MJCF has no name, this is `bodyN`.
    pub name: String,
    /// Segment to which it is fixed. This is `None` for the world.
    pub body: Option<BodyId>,
    /// Pose in the frame of this segment. It is the identity, except for bodies whose joint is not at their origin.
    pub placement: Pose<f64>,
}
