//! Fitness of a generation as a page receives it.

use serde::Serialize;

use crate::store::log;

/// Best and mean fitness of a generation, `None` where every evaluation failed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Row(pub(crate) usize, Option<f64>, Option<f64>);

impl Row {
    /// Builds the row of a generation from its best, mean and worst fitness.
    pub(crate) fn new(generation: usize, [best, mean, _]: log::Row) -> Self {
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        Self(generation, finite(best), finite(mean))
    }

    /// Gets the best fitness.
    pub(crate) fn best(&self) -> Option<f64> {
        self.1
    }
}
