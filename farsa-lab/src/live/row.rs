//! The fitness of a generation for the viewer.

use serde::Serialize;

use crate::store::log;

/// The fitness of a generation's best and its mean; none where nobody had any.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Row(pub(crate) usize, Option<f64>, Option<f64>);

impl Row {
    /// Of a generation's best, mean and worst.
    pub(crate) fn new(generation: usize, [best, mean, _]: log::Row) -> Self {
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        Self(generation, finite(best), finite(mean))
    }
}
