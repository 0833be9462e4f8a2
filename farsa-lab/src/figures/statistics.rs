//! Order statistics of a few runs.

/// Median and quartiles of some values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Quartiles {
    pub(crate) lower: f64,
    pub(crate) median: f64,
    pub(crate) upper: f64,
}

impl Quartiles {
    /// Returns the quartiles of values in any order, by linear interpolation as in R and `NumPy`, or `None` without values.
    ///
    /// Minus infinity is an ordinary value, that of a generation of failed evaluations.
    pub(crate) fn from_values(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| interpolated(&sorted, share);
        Some(Self { lower: at(0.25)?, median: at(0.5)?, upper: at(0.75)? })
    }

    /// Sorts values and returns a quantile, or NaN without values.
    pub(crate) fn quantile(values: &mut [f64], share: f64) -> f64 {
        values.sort_by(f64::total_cmp);
        interpolated(values, share).unwrap_or(f64::NAN)
    }
}

/// Interpolates between the neighbors of a position among sorted values.
fn interpolated(sorted: &[f64], share: f64) -> Option<f64> {
    let place = share * sorted.len().checked_sub(1)? as f64;
    let below = *sorted.get(place.floor() as usize)?;
    let above = *sorted.get(place.ceil() as usize)?;
    let weight = place - place.floor();
    // Equal neighbors are returned unchanged, because they may be infinite.
    Some(if below == above { below } else { (1.0 - weight) * below + weight * above })
}

/// Computes the median of values in any order.
pub(crate) fn median(values: &[f64]) -> Option<f64> {
    Quartiles::from_values(values).map(|quartiles| quartiles.median)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::fixture::fixture;

    #[test]
    fn quartiles_are_those_of_numpy() {
        for case in fixture("quartiles") {
            let values: Vec<f64> = case["values"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
            let Quartiles { lower, median, upper } = Quartiles::from_values(&values).unwrap();
            for (name, found) in [("lower", lower), ("median", median), ("upper", upper)] {
                let expected = case[name].as_f64().unwrap();
                assert!((found - expected).abs() <= 1e-15, "{name} of {values:?}: {found} where NumPy has {expected}");
            }
        }
    }

    #[test]
    fn quartiles_are_those_computed_by_hand() {
        let of = |values: &[f64]| Quartiles::from_values(values).map(|q| [q.lower, q.median, q.upper]);
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[7.0]), Some([7.0; 3]));
        assert_eq!(of(&[3.0, 1.0]), Some([1.5, 2.0, 2.5]));
        assert_eq!(of(&[5.0, 1.0, 3.0]), Some([2.0, 3.0, 4.0]));
        // Positions 0.75, 1.5 and 2.25 from 0 to 3.
        assert_eq!(of(&[10.0, 40.0, 20.0, 30.0]), Some([17.5, 25.0, 32.5]));
        assert_eq!(of(&[1.0, 2.0, 3.0, 4.0, 5.0]), Some([2.0, 3.0, 4.0]));
        let failed = f64::NEG_INFINITY;
        assert_eq!(of(&[failed, failed, 1.0, 3.0, 2.0]), Some([failed, 1.0, 2.0]));
        assert_eq!(median(&[2.0, 1.0]), Some(1.5));
    }
}
