//! The number of values of an evaluation.

use core::fmt;

/// The number of objectives and measures of each individual.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ScoreShape {
    /// Number of objectives m, at least 1. The first is the fitness of logs and champions.
    pub objectives: usize,
    /// Number of measures d of the behavior.
    #[cfg_attr(feature = "serde", serde(rename = "descriptors"))]
    pub measures: usize,
}

impl ScoreShape {
    /// One objective and no measures, for [`Strategy::tell`](crate::Strategy::tell).
    pub const FITNESS: Self = Self { objectives: 1, measures: 0 };

    /// Returns the shape of the given numbers of objectives and measures.
    pub const fn new(objectives: usize, measures: usize) -> Self {
        Self { objectives, measures }
    }

    /// Numbers of one individual.
    pub const fn width(self) -> usize {
        self.objectives.saturating_add(self.measures)
    }
}

impl fmt::Display for ScoreShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plural = |count: usize| if count == 1 { "" } else { "s" };
        let (m, d) = (self.objectives, self.measures);
        write!(f, "{m} objective{} and {d} descriptor value{}", plural(m), plural(d))
    }
}
