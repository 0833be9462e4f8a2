//! A point that a name means.

use farsa_body::sensors::Point;

use crate::jointed::SpatialWorld;

/// A point of a body, or a marker by its number.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Spot {
    Body(Point),
    Marker(usize),
}

impl Spot {
    /// Where it is [m]; `markers` are the places of the markers.
    pub(crate) fn position<W: SpatialWorld>(&self, world: &W, markers: &[[f32; 3]]) -> [f64; 3] {
        match self {
            Self::Body(point) => point.position(world).map(f64::from),
            Self::Marker(number) => markers[*number].map(f64::from),
        }
    }
}
