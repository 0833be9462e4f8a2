//! The placements of the format.

use farsa_lab::advanced::Part;

use crate::part::{planar_start, spatial_start, start};

/// Free places.
mod anywhere;
/// Places in a direction from a thing.
mod around;
/// Fixed points.
mod fixed;
/// Searches of a free place.
mod free;
/// Places in a box.
mod in_box;
/// Free places near a thing.
mod near;
/// Choices among points.
mod one_of;
/// Postures of the whole robot.
mod posture;
/// Positions of joints.
mod turned;

/// Lists them under their names.
pub(crate) fn starts() -> Vec<Part> {
    vec![
        planar_start::<anywhere::Anywhere>("anywhere"),
        planar_start::<near::Near>("near"),
        planar_start::<around::Around>("around"),
        spatial_start::<in_box::InBox>("in-box"),
        start::<one_of::OneOf>("one-of"),
        spatial_start::<posture::Posture>("posture"),
        spatial_start::<turned::Turned>("turned"),
        start::<fixed::Fixed>("fixed"),
    ]
}

/// Most attempts to find a place.
const TRIES: u32 = 1000;
