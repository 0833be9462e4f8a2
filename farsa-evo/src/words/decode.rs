//! Linear decoding of genes to parameters.

use crate::error::EvoError;
use crate::words::mutation::check_gene_bits;

/// A range for a number of consecutive genes. Gene 0 decodes to the low end, the largest gene to the high end, and
/// values in between are linear.
///
/// The largest gene is 65535, of genes of fewer bits 2^bits - 1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "SavedRange", into = "SavedRange"))]
pub struct GeneRange {
    count: usize,
    low: f32,
    high: f32,
    /// The largest gene.
    largest: u16,
}

impl GeneRange {
    /// Creates a range for `count` genes that decode to values from `low` to `high`, in the unit of the parameter.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] when an end is not finite or `low > high`.
    pub fn new(count: usize, low: f32, high: f32) -> Result<Self, EvoError> {
        if low.is_finite() && high.is_finite() && low <= high {
            Ok(Self { count, low, high, largest: u16::MAX })
        } else {
            Err(EvoError::range(low, high))
        }
    }

    /// Sets the number of bits of the genes, 1 to 16. Use this if your genes have fewer than 16 bits.
    ///
    /// ```
    /// use farsa_evo::words::GeneRange;
    ///
    /// let range = GeneRange::new(3, -5.0, 5.0)?.with_gene_bits(8)?;
    /// assert_eq!([0, 51, 255].map(|gene| range.decode(gene)), [-5.0, -3.0, 5.0]);
    /// # Ok::<(), farsa_evo::EvoError>(())
    /// ```
    ///
    /// # Errors
    /// Returns [`EvoError::Config`].
    pub fn with_gene_bits(self, bits: u32) -> Result<Self, EvoError> {
        match check_gene_bits(bits) {
            Ok(()) => Ok(Self { largest: u16::MAX >> (u16::BITS - bits), ..self }),
            Err(error) => Err(error),
        }
    }

    /// Number of genes that this range describes.
    pub const fn count(self) -> usize {
        self.count
    }

    /// Decodes a single gene as `low + (high - low) * gene / largest`. This is computed in f64 and rounded to f32 at
    /// the end.
    ///
    /// This is exact at both ends, never outside the range, and never decreases as the gene increases. If the gene is
    /// larger than the largest one, the result is the high end.
    pub fn decode(self, gene: u16) -> f32 {
        // In f64 the difference of two f32 cannot overflow.
        let (low, high) = (f64::from(self.low), f64::from(self.high));
        let value = (low + (high - low) * f64::from(gene) / f64::from(self.largest)) as f32;
        // The sum may round one f32 beyond an end, or short of the high end when the low end is far larger.
        if gene >= self.largest || value > self.high {
            self.high
        } else if value < self.low {
            self.low
        } else {
            value
        }
    }
}

/// A range as it is saved.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "GeneRange")]
struct SavedRange {
    count: usize,
    low: f32,
    high: f32,
    gene_bits: u32,
}

#[cfg(feature = "serde")]
impl From<GeneRange> for SavedRange {
    fn from(range: GeneRange) -> Self {
        let GeneRange { count, low, high, largest } = range;
        Self { count, low, high, gene_bits: largest.count_ones() }
    }
}

#[cfg(feature = "serde")]
impl TryFrom<SavedRange> for GeneRange {
    type Error = EvoError;

    fn try_from(saved: SavedRange) -> Result<Self, EvoError> {
        Self::new(saved.count, saved.low, saved.high)?.with_gene_bits(saved.gene_bits)
    }
}

/// Decodes `genes` \[parameters\] into `out` \[parameters\], range after range. This does not allocate, so you can call
/// it for every evaluation.
///
/// Parameters have 16 bits unless a range has fewer, linear as in \[Ferrauto2010\]. Deviation: the source does not define
/// the value of the largest gene. It is the high end here, so a range has 65535 steps, not 65536.
///
/// ```
/// use farsa_evo::words::{GeneRange, decode};
///
/// // Two weights in [-6, 6], then a time constant in [0.1, 2] s.
/// let ranges = [GeneRange::new(2, -6.0, 6.0)?, GeneRange::new(1, 0.1, 2.0)?];
/// let mut parameters = [0.0; 3];
/// decode(&[0, 65535, 65535], &ranges, &mut parameters)?;
/// assert_eq!(parameters, [-6.0, 6.0, 2.0]);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
///
/// # Errors
/// Returns [`EvoError::Shape`] when the ranges do not describe exactly the genes or `out` has another length. `out` is
/// then unchanged.
pub fn decode(genes: &[u16], ranges: &[GeneRange], out: &mut [f32]) -> Result<(), EvoError> {
    let described = ranges.iter().fold(0_usize, |sum, range| sum.saturating_add(range.count));
    if described != genes.len() || out.len() != genes.len() {
        return Err(EvoError::lengths(genes.len(), described, out.len()));
    }
    let mut pairs = genes.iter().zip(out);
    for range in ranges {
        for (&gene, value) in pairs.by_ref().take(range.count) {
            *value = range.decode(gene);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn ranges_apply_in_order() {
        let ranges = [GeneRange::new(2, -6.0, 6.0), GeneRange::new(0, 0.0, 9.0), GeneRange::new(3, 0.0, 1.0)]
            .map(Result::unwrap);
        let mut out = [9.0; 5];
        decode(&[0, u16::MAX, 0, 32768, u16::MAX], &ranges, &mut out).unwrap();
        assert_eq!(out, [-6.0, 6.0, 0.0, (32768.0_f64 / 65535.0) as f32, 1.0]);
    }

    #[test]
    fn a_value_within_lies_where_its_gene_does() {
        // From ends of which low + high is not high - low.
        let range = GeneRange::new(1, -2.0, 6.0).unwrap();
        assert_eq!([0, 13107, 26214, 52428, 65535].map(|gene| range.decode(gene)), [-2.0, -0.4, 1.2, 4.4, 6.0]);
        let range = GeneRange::new(1, 10.0, 12.0).unwrap();
        assert_eq!([13107, 52428].map(|gene| range.decode(gene)), [10.4, 11.6]);
    }

    #[test]
    fn genes_of_fewer_bits_reach_both_ends() {
        let range = GeneRange::new(1, -2.0, 6.0).unwrap();
        let eight = range.with_gene_bits(8).unwrap();
        assert_eq!([0, 51, 204, 255, 256, 65535].map(|gene| eight.decode(gene)), [-2.0, -0.4, 4.4, 6.0, 6.0, 6.0]);
        let one = range.with_gene_bits(1).unwrap();
        assert_eq!([0, 1].map(|gene| one.decode(gene)), [-2.0, 6.0]);
        assert_eq!(range.with_gene_bits(16).unwrap(), range);
        for bits in [0, 17] {
            assert_eq!(range.with_gene_bits(bits), Err(EvoError::gene_bits(bits)));
        }
    }

    #[test]
    fn lengths_are_compared() {
        let ranges = [GeneRange::new(2, 0.0, 1.0).unwrap(), GeneRange::new(1, 0.0, 1.0).unwrap()];
        for (genes, out) in [(2, 3), (3, 2), (4, 4)] {
            let mut values = [7.0; 4];
            let result = decode(&[1; 4][..genes], &ranges, &mut values[..out]);
            assert_eq!(result, Err(EvoError::lengths(genes, 3, out)));
            assert_eq!(values, [7.0; 4]);
        }
    }

    #[test]
    fn impossible_ranges_are_refused() {
        for (low, high) in
            [(1.0, 0.0), (0.0, f32::INFINITY), (f32::NEG_INFINITY, 0.0), (f32::NAN, 0.0), (0.0, f32::NAN)]
        {
            assert!(matches!(GeneRange::new(1, low, high), Err(EvoError::Config { field: "range", .. })));
        }
    }

    proptest! {
        #[test]
        fn values_stay_inside_and_rise(a in -1e30_f32..1e30, b in -1e3_f32..1e3, gene in 0..u16::MAX) {
            let range = GeneRange::new(1, a.min(b), a.max(b)).unwrap();
            prop_assert_eq!(range.decode(0), a.min(b));
            prop_assert_eq!(range.decode(u16::MAX), a.max(b));
            let (here, next) = (range.decode(gene), range.decode(gene + 1));
            prop_assert!(a.min(b) <= here && here <= next && next <= a.max(b));
        }
    }
}
