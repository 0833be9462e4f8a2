//! Registered terms of the format.

use farsa_lab::advanced::Part;

use crate::part::planar_term;

/// Exchanges of two areas.
mod exchanges;

/// Lists them under their names.
pub(crate) fn terms() -> Vec<Part> {
    vec![planar_term::<exchanges::Exchanges>("exchanges")]
}
