//! Number of values that an evaluation returns.

use core::fmt;

/// Number of objectives and measures that each individual has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ScoreShape {
    /// Number of objectives m, at least 1. The first of them is used as fitness in logs and for champions.
    pub objectives: usize,
    /// Number of measures d that describe the behavior.
    #[cfg_attr(feature = "serde", serde(rename = "descriptors"))]
    pub measures: usize,
}

impl ScoreShape {
    /// A single objective without measures. This is the shape that [`Strategy::tell`](crate::Strategy::tell) uses.
    pub const FITNESS: Self = Self { objectives: 1, measures: 0 };

    /// Creates a shape with the given numbers of objectives and measures.
    pub const fn new(objectives: usize, measures: usize) -> Self {
        Self { objectives, measures }
    }

    /// Number of values of one individual, which is m + d.
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
