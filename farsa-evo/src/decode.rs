//! From genes to the numbers they stand for.

use crate::error::EvoError;

/// What a run of neighbouring genes stands for: gene 0 is the low end, gene 65535 the high end, linear between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneRange {
    count: usize,
    low: f32,
    high: f32,
}

impl GeneRange {
    /// `count` genes that range from `low` to `high`, in the unit of the parameter.
    ///
    /// # Errors
    /// [`EvoError::Range`] when an end is not finite or `low > high`.
    pub const fn new(count: usize, low: f32, high: f32) -> Result<Self, EvoError> {
        if low.is_finite() && high.is_finite() && low <= high {
            Ok(Self { count, low, high })
        } else {
            Err(EvoError::Range { low, high })
        }
    }

    /// Number of genes described.
    pub const fn count(self) -> usize {
        self.count
    }

    /// The value of one gene, `low + (high - low) * gene / 65535`, computed in f64 and rounded to f32 at the end.
    ///
    /// Never outside the range, exact at both ends, and never falling with the gene.
    pub fn decode(self, gene: u16) -> f32 {
        let (low, high) = (f64::from(self.low), f64::from(self.high));
        let value = (low + (high - low) * f64::from(gene) / f64::from(u16::MAX)) as f32;
        // The sum may round one f32 beyond an end, or short of the high end when the low end is far larger.
        if gene == u16::MAX || value > self.high {
            self.high
        } else if value < self.low {
            self.low
        } else {
            value
        }
    }
}

/// Decodes `genes` \[parameters\] into `out` \[parameters\], range after range, without allocating.
///
/// 16 bits a parameter, linear as in \[Ferrauto2010\]. Deviation: the source does not say whether the high end is
/// reached; here it is (65535 steps, not 65536).
///
/// # Errors
/// [`EvoError::Lengths`] when the ranges do not describe exactly the genes or `out` has another length; `out` is then
/// unchanged.
pub fn decode(genes: &[u16], ranges: &[GeneRange], out: &mut [f32]) -> Result<(), EvoError> {
    let described = ranges.iter().fold(0_usize, |sum, range| sum.saturating_add(range.count));
    if described != genes.len() || out.len() != genes.len() {
        return Err(EvoError::Lengths { genes: genes.len(), ranges: described, out: out.len() });
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
    fn lengths_are_compared() {
        let ranges = [GeneRange::new(2, 0.0, 1.0).unwrap(), GeneRange::new(1, 0.0, 1.0).unwrap()];
        for (genes, out) in [(2, 3), (3, 2), (4, 4)] {
            let mut values = [7.0; 4];
            let result = decode(&[1; 4][..genes], &ranges, &mut values[..out]);
            assert_eq!(result, Err(EvoError::Lengths { genes, ranges: 3, out }));
            assert_eq!(values, [7.0; 4]);
        }
    }

    #[test]
    fn impossible_ranges_are_refused() {
        for (low, high) in
            [(1.0, 0.0), (0.0, f32::INFINITY), (f32::NEG_INFINITY, 0.0), (f32::NAN, 0.0), (0.0, f32::NAN)]
        {
            assert!(matches!(GeneRange::new(1, low, high), Err(EvoError::Range { .. })));
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
