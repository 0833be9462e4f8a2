//! Exact interval of a median.

/// Largest probability of a median outside its interval.
const OUTSIDE: f64 = 0.05;

/// Computes the 95 % interval of the median between two of the values, which assumes no distribution.
///
/// The median is below the k-th of n values with the probability that fewer than k of n tosses of a coin are heads. The interval
/// reaches from the k-th to the (n + 1 - k)-th value. It has the largest k for which both sides together have at most 5 %.
/// Returns `None` for fewer than six values, which have no such interval, and for NaN.
pub(crate) fn order_interval(values: &[f64]) -> Option<[f64; 2]> {
    if values.iter().any(|x| x.is_nan()) {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    // Each weight results from the previous one. They are divided before they overflow, after which the first ones may be 0.
    let mut weights = vec![1.0_f64];
    let mut total = 1.0;
    for heads in 0..n {
        let next = weights[heads] * (n - heads) as f64 / (heads + 1) as f64;
        weights.push(next);
        total += next;
        if total > 1e300 {
            for weight in &mut weights {
                *weight /= 1e300;
            }
            total /= 1e300;
        }
    }
    let (mut below, mut k) = (0.0, 0_usize);
    for weight in weights {
        below += weight / total;
        if 2.0 * below > OUTSIDE {
            break;
        }
        k += 1;
    }
    let low = *sorted.get(k.checked_sub(1)?)?;
    let high = *sorted.get(n - k)?;
    Some([low, high])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts all sequences of n tosses by their heads.
    fn tosses(n: u32) -> Vec<u64> {
        let mut counts = vec![0; n as usize + 1];
        for sequence in 0_u64..1 << n {
            counts[sequence.count_ones() as usize] += 1;
        }
        counts
    }

    #[test]
    fn ends_are_those_of_counted_tosses() {
        for n in 1..=18_u32 {
            let counts = tosses(n);
            let outside = |k: usize| 2.0 * counts[..k].iter().sum::<u64>() as f64 / (1_u64 << n) as f64;
            let k = (1..=n as usize / 2).rev().find(|k| outside(*k) <= 0.05);
            let values: Vec<f64> = (1..=n).rev().map(f64::from).collect();
            let expected = k.map(|k| [k as f64, f64::from(n) + 1.0 - k as f64]);
            assert_eq!(order_interval(&values), expected, "{n}");
        }
    }

    /// The table of many books: for 20 values the 6th and the 15th, for 100 the 40th and the 61st.
    #[test]
    fn ends_are_those_of_tables() {
        for (n, ends) in [(5_u32, None), (6, Some([1.0, 6.0])), (20, Some([6.0, 15.0])), (100, Some([40.0, 61.0]))] {
            let values: Vec<f64> = (1..=n).map(f64::from).collect();
            assert_eq!(order_interval(&values), ends, "{n}");
        }
        let many: Vec<f64> = (1..=5000).map(f64::from).collect();
        let [low, high] = order_interval(&many).unwrap();
        // 2500.5 -+ 1.96 * 5000^(1/2) / 2 = 69.3.
        assert!((low - 2431.0).abs() <= 1.0 && low + high == 5001.0, "{low} {high}");
    }

    #[test]
    fn infinities_are_values_and_nan_is_none() {
        let mut values = [f64::INFINITY; 8];
        values[..3].copy_from_slice(&[1.0, 2.0, 3.0]);
        assert_eq!(order_interval(&values), Some([1.0, f64::INFINITY]));
        values[0] = f64::NAN;
        assert_eq!(order_interval(&values), None);
        assert_eq!(order_interval(&[]), None);
    }
}
