//! The things of the format.

use farsa_lab::advanced::Part;

use crate::part::thing;

/// Balls.
mod ball;
/// Blocks.
mod block;
/// Cylinders.
mod cylinder;
/// Discs.
mod disc;
/// Markers.
mod marker;
/// Rectangles.
mod rectangle;
/// Walls.
mod wall;

/// Lists them under their names.
pub(crate) fn things() -> Vec<Part> {
    vec![
        thing::<cylinder::Cylinder>("cylinder"),
        thing::<wall::Wall>("wall"),
        thing::<block::Block>("block"),
        thing::<ball::Ball>("ball"),
        thing::<marker::Marker>("marker"),
        thing::<disc::Disc>("disc"),
        thing::<rectangle::Rectangle>("rectangle"),
    ]
}

/// Color of things.
fn grey() -> [f64; 3] {
    [0.5; 3]
}

/// Coefficient of friction.
fn half() -> f64 {
    0.5
}

/// Height of cylinders and walls [m].
fn height() -> f64 {
    0.1
}
