//! The rules of the format that end a trial.

use farsa_lab::advanced::Part;

use crate::part::{end, planar_end};

/// Collisions of robots.
mod collision;
/// Deaths of all robots.
mod death;
/// Success.
mod success;

/// Lists them under their names.
pub(crate) fn ends() -> Vec<Part> {
    vec![
        end::<collision::Collision>("collision"),
        end::<success::Success>("success"),
        planar_end::<death::Death>("death"),
    ]
}
