//! Order statistics over a few runs.

/// The middle of some values and how far their middle half reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Quartiles {
    pub(crate) lower: f64,
    pub(crate) median: f64,
    pub(crate) upper: f64,
}

impl Quartiles {
    /// Of values in any order, interpolated linearly between neighbours as R and `NumPy` do by default; none of no values.
    ///
    /// Minus infinity is a value like any other: that of a generation in which all failed.
    pub(crate) fn from_values(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| interpolated(&sorted, share);
        Some(Self { lower: at(0.25)?, median: at(0.5)?, upper: at(0.75)? })
    }

    /// A quantile of values in any order, which are sorted; NaN of none.
    pub(crate) fn quantile(values: &mut [f64], share: f64) -> f64 {
        values.sort_by(f64::total_cmp);
        interpolated(values, share).unwrap_or(f64::NAN)
    }
}

/// Between the neighbours of a place among sorted values.
fn interpolated(sorted: &[f64], share: f64) -> Option<f64> {
    let place = share * sorted.len().checked_sub(1)? as f64;
    let below = *sorted.get(place.floor() as usize)?;
    let above = *sorted.get(place.ceil() as usize)?;
    let weight = place - place.floor();
    // Equal neighbours stay what they are, also when they are infinite.
    Some(if below == above { below } else { (1.0 - weight) * below + weight * above })
}

/// The median of values in any order.
pub(crate) fn median(values: &[f64]) -> Option<f64> {
    Quartiles::from_values(values).map(|quartiles| quartiles.median)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_are_those_computed_by_hand() {
        let of = |values: &[f64]| Quartiles::from_values(values).map(|q| [q.lower, q.median, q.upper]);
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[7.0]), Some([7.0; 3]));
        assert_eq!(of(&[3.0, 1.0]), Some([1.5, 2.0, 2.5]));
        assert_eq!(of(&[5.0, 1.0, 3.0]), Some([2.0, 3.0, 4.0]));
        // Places 0.75, 1.5 and 2.25 of 0 to 3.
        assert_eq!(of(&[10.0, 40.0, 20.0, 30.0]), Some([17.5, 25.0, 32.5]));
        assert_eq!(of(&[1.0, 2.0, 3.0, 4.0, 5.0]), Some([2.0, 3.0, 4.0]));
        let failed = f64::NEG_INFINITY;
        assert_eq!(of(&[failed, failed, 1.0, 3.0, 2.0]), Some([failed, 1.0, 2.0]));
        assert_eq!(median(&[2.0, 1.0]), Some(1.5));
    }
}
