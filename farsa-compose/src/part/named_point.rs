//! A point of a body, or a marker.

use farsa_body::ports::{BodyId, Handles, Kinematics};
use farsa_body::sensors::Point;

/// A point of a body, or the number of a marker.
#[derive(Clone, Copy, Debug)]
pub(crate) enum NamedPoint {
    Body(Point),
    Marker(usize),
}

impl NamedPoint {
    /// Computes the position [m], given those of the markers.
    pub(crate) fn position<W: Kinematics + Handles<Body = BodyId>>(&self, world: &W, markers: &[[f32; 3]]) -> [f64; 3] {
        match self {
            Self::Body(point) => point.position(world).map(f64::from),
            Self::Marker(number) => markers[*number].map(f64::from),
        }
    }
}
