//! What novelty search needs to know.

use crate::error::EvoError;
use crate::real::bounds::{check_rate, check_setting};

/// What a [`NoveltySearch`](crate::archives::NoveltySearch) needs to know besides the strategy that it drives; a plain value that is
/// checked where it is used.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NoveltyConfig {
    /// Number of values d of a measures, 1 to 1000.
    #[cfg_attr(feature = "serde", serde(rename = "descriptors"))]
    pub measures: usize,
    /// Number k of nearest behaviours whose mean distance is the novelty, 1 or more; 15 in the source.
    pub neighbours: usize,
    /// Which behaviours enter the archive.
    pub archive: ArchiveRule,
}

/// Which behaviours enter the archive of a [`NoveltySearch`](crate::archives::NoveltySearch).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ArchiveRule {
    /// Each with this probability, 0 to 1, whatever its novelty.
    Random {
        /// The probability.
        rate: f64,
    },
    /// Those whose novelty is above a threshold, in the unit of the measures, that follows how many there are: it is
    /// multiplied by 1.2 after a generation that added more than `most`, and by 0.95 after `patience` generations that added
    /// none. It stays between 1e-100 and 1e100.
    Threshold {
        /// The first threshold, 1e-100 to 1e100.
        first: f64,
        /// The most additions of a generation that do not raise it; 4 in the program of the source.
        most: usize,
        /// Generations without additions that lower it, 1 or more; 10 in the program of the source.
        patience: u32,
    },
}

impl NoveltyConfig {
    /// 15 neighbours \[Lehman2011\], and each behaviour enters the archive with probability 0.02, which is ours.
    pub const fn new(measures: usize) -> Self {
        Self { measures, neighbours: 15, archive: ArchiveRule::Random { rate: 0.02 } }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::Setting`].
    pub fn validate(&self) -> Result<(), EvoError> {
        let (d, k) = (self.measures, self.neighbours);
        check_setting((1..=1000).contains(&d), "the number of descriptor values", d as f64, "1 to 1000")?;
        check_setting(k > 0, "the number of neighbours", k as f64, "1 or more")?;
        match self.archive {
            ArchiveRule::Random { rate } => check_rate("the rate of the archive", rate),
            ArchiveRule::Threshold { first, patience, .. } => {
                check_setting((1e-100..=1e100).contains(&first), "the first threshold", first, "1e-100 to 1e100")?;
                check_setting(patience > 0, "the patience of the archive", f64::from(patience), "1 or more")
            }
        }
    }
}
