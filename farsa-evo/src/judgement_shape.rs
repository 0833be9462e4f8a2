//! How many numbers an evaluation gives.

use core::fmt;

/// How many numbers an evaluation gives of each individual.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct JudgementShape {
    /// Number of objectives m, at least 1; the first is the fitness that logs and champions go by.
    pub objectives: usize,
    /// Number of values d that describe the behaviour.
    pub descriptors: usize,
}

impl JudgementShape {
    /// One objective and no descriptor: what [`Strategy::tell`](crate::Strategy::tell) takes.
    pub const FITNESS: Self = Self { objectives: 1, descriptors: 0 };

    /// So many objectives and descriptor values.
    pub const fn new(objectives: usize, descriptors: usize) -> Self {
        Self { objectives, descriptors }
    }

    /// Numbers of one individual.
    pub const fn width(self) -> usize {
        self.objectives.saturating_add(self.descriptors)
    }
}

impl fmt::Display for JudgementShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plural = |count: usize| if count == 1 { "" } else { "s" };
        let (m, d) = (self.objectives, self.descriptors);
        write!(f, "{m} objective{} and {d} descriptor value{}", plural(m), plural(d))
    }
}
