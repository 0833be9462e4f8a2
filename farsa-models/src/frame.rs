//! Where the parts of the file are in the robot.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
/// Where a link or body of the file is in the robot.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Frame {
    /// Its name in the file, or `bodyN` for MJCF's N-th if it has none.
    pub name: String,
    /// The segment that it is fixed to, or `None` for the world.
    pub body: Option<BodyId>,
    /// Where its frame is in the segment's. The identity unless a joint is off the body's origin.
    pub placement: Pose<f64>,
}
