//! Where new individuals come from.

use alloc::vec::Vec;

use crate::error::{EvoError, check_range, check_setting, check_share};

/// An emitter of a [`MapElites`](crate::archives::MapElites): how it makes its part of each generation.
///
/// The first two choose elites uniformly and reflect genes that leave the bounds. While the archive is empty, their
/// individuals are uniform within the bounds.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Emitter {
    /// An elite plus normal numbers, the random variation of \[Mouret2015\]. The source does not give its kind.
    Gaussian {
        /// Number of individuals in a generation, at least 1.
        batch: usize,
        /// Standard deviation as a share of each gene's range, 0 to 1.
        sigma: f64,
    },
    /// An elite plus normal numbers, plus a normal number times the difference to another elite. It is the directional
    /// variation of \[Mouret2018\], where the deviations are 0.01 and 0.2 and the range of genes is 1.
    IsoLine {
        /// Number of individuals in a generation, at least 1.
        batch: usize,
        /// The standard deviation as a share of each gene's range `sigma_1`, 0 to 1.
        iso_sigma: f64,
        /// The standard deviation along the line between the elites `sigma_2`, 0 to 10.
        line_sigma: f64,
    },
    /// The improvement emitter of \[Fontaine2020\], a CMA-ES whose parents are all additions to the archive. The first of
    /// their cells rank before those that are better than an elite, then by objective and by the difference of objectives.
    /// Without additions it starts again from an elite. Deviations: individuals out of bounds are drawn again up to a
    /// hundred times and then put at the bounds (the source has none). It also starts again where the distribution has
    /// collapsed, and no standard deviation of a gene passes the larger of sigma and the widest range.
    Improvement {
        /// Number of individuals in a generation, at least 2.
        batch: usize,
        /// Initial mean \[genes\], which must be within the bounds.
        mean: Vec<f64>,
        /// Step size that every start begins with, 1e-100 to 1e100, in the unit of the genes.
        sigma: f64,
    },
}

impl Emitter {
    /// Number of individuals that this emitter makes in a generation.
    pub fn batch(&self) -> usize {
        let (Self::Gaussian { batch, .. } | Self::IsoLine { batch, .. } | Self::Improvement { batch, .. }) = self;
        *batch
    }

    pub(super) fn check(&self, bounds: &[[f64; 2]]) -> Result<(), EvoError> {
        let batch = self.batch();
        check_setting(batch > 0, "the batch of an emitter", batch as f64, "1 or more, 2 or more for improvement")?;
        match *self {
            Self::Gaussian { sigma, .. } => check_share("sigma of the Gaussian emitter", sigma),
            Self::IsoLine { iso_sigma, line_sigma, .. } => {
                check_share("iso_sigma of the iso-line emitter", iso_sigma)?;
                check_range("line_sigma of the iso-line emitter", line_sigma, [0.0, 10.0], "0 to 10")
            }
            Self::Improvement { ref mean, sigma, .. } => {
                check_setting(batch > 1, "the batch of an emitter", batch as f64, "2 or more for improvement")?;
                let (found, wanted) = (mean.len(), bounds.len());
                check_setting(found == wanted, "the number of genes of a mean", found as f64, "one for each range")?;
                for (&x, &[low, high]) in mean.iter().zip(bounds) {
                    check_range("the mean of an emitter", x, [low, high], "within the bounds")?;
                }
                check_range("sigma of the improvement emitter", sigma, [1e-100, 1e100], "1e-100 to 1e100")
            }
        }
    }
}
