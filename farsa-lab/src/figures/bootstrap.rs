//! Intervals of a median and of a mean.

use farsa_num::Stream;

use crate::figures::proportion::Z;
use crate::figures::statistics::Quartiles;

/// Number of resamples, enough for ends with an error of about a hundredth of the interval.
pub(crate) const RESAMPLES: usize = 10_000;
/// A fixed seed, so that equal values have equal intervals on every page.
const SEED: u64 = 1979;

/// Computes the 95 % interval of the median by the percentile method of [Efron1979].
///
/// Returns `None` for fewer than two values and for NaN.
///
/// Deviation: the quantiles of the resampled medians are interpolated, as quartiles are.
pub(crate) fn median_interval(values: &[f64]) -> Option<[f64; 2]> {
    let n = values.len();
    if n < 2 || values.iter().any(|x| x.is_nan()) {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut dice = Stream::from_seed(SEED);
    let mut drawn = vec![0_usize; n];
    let mut medians: Vec<f64> = Vec::with_capacity(RESAMPLES);
    for _ in 0..RESAMPLES {
        drawn.fill(0);
        for _ in 0..n {
            drawn[dice.below(n as u32) as usize] += 1;
        }
        // The values are in order, so their counts find the two in the middle.
        let at = |place: usize| {
            let mut before = 0;
            let position = drawn.iter().position(|count| {
                before += count;
                before > place
            });
            sorted[position.unwrap_or(n - 1)]
        };
        let [low, high] = [at((n - 1) / 2), at(n / 2)];
        medians.push(if low == high { low } else { 0.5 * low + 0.5 * high });
    }
    Some([0.025, 0.975].map(|share| Quartiles::quantile(&mut medians, share)))
}

/// Most values that are resampled for the interval of a mean.
const RESAMPLED: usize = 1000;

/// Computes the 95 % interval of the mean by the percentile method of [Efron1979], and by the normal distribution for more
/// than a thousand values.
///
/// Returns `None` for fewer than two values and for NaN.
pub(crate) fn mean_interval(values: &[f64]) -> Option<[f64; 2]> {
    let n = values.len();
    if n < 2 || values.iter().any(|x| x.is_nan()) {
        return None;
    }
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / n as f64;
    if n > RESAMPLED {
        let center = mean(&mut values.iter().copied());
        let squares: f64 = values.iter().map(|x| (x - center) * (x - center)).sum();
        let reach = Z * (squares / (n - 1) as f64 / n as f64).sqrt();
        return Some([center - reach, center + reach]);
    }
    let mut dice = Stream::from_seed(SEED);
    let mut draw = || values[dice.below(n as u32) as usize];
    let mut means: Vec<f64> = (0..RESAMPLES).map(|_| mean(&mut (0..n).map(|_| draw()))).collect();
    Some([0.025, 0.975].map(|share| Quartiles::quantile(&mut means, share)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With four values of which one is 4, the mean of a resample is the number of draws of the 4. It is binomial with a probability of
    /// 1/4, so that P(0) = 0.32 and P(3 or 4) = 0.051 are above 0.025, and P(4) = 0.004 is below.
    #[test]
    fn a_mean_has_the_ends_of_the_binomial_distribution() {
        assert_eq!(mean_interval(&[0.0, 4.0, 0.0, 0.0]), Some([0.0, 3.0]));
        assert_eq!(mean_interval(&[0.0, 1.0]), Some([0.0, 1.0]));
        assert_eq!((mean_interval(&[1.0]), mean_interval(&[1.0, f64::NAN])), (None, None));
        // 1.959964 (2000 / 4 / 1999 / 2000)^(1/2) = 0.0219188.
        let many: Vec<f64> = (0..2000).map(|number| f64::from(number % 2)).collect();
        let [low, high] = mean_interval(&many).unwrap();
        assert!((low - 0.478_081_2).abs() < 1e-6 && (high - 0.521_918_8).abs() < 1e-6, "{low} {high}");
    }

    /// The probability that at least half of n draws, one more than half, are among the k smallest of n values: n is odd.
    fn median_within(n: usize, k: usize) -> f64 {
        let share = k as f64 / n as f64;
        let power = |x: f64, times: usize| std::iter::repeat_n(x, times).product::<f64>();
        let mut ways = 1.0;
        let mut sum = 0.0;
        for draws in 0..=n {
            if draws > n / 2 {
                sum += ways * power(share, draws) * power(1.0 - share, n - draws);
            }
            ways *= (n - draws) as f64 / (draws + 1) as f64;
        }
        sum
    }

    #[test]
    fn ends_are_those_of_the_exact_distribution() {
        for n in [5_usize, 11, 21, 31] {
            let values: Vec<f64> = (0..n).map(|x| x as f64).collect();
            let [low, high] = median_interval(&values).unwrap();
            // The value at which the exact distribution of the resampled median reaches the share, or the next one within the
            // error of the resamples.
            for (found, share) in [(low, 0.025), (high, 0.975)] {
                let near = |shift: f64| (0..n).find(|k| median_within(n, k + 1) >= share + shift).unwrap() as f64;
                let [least, most] = [near(-0.008), near(0.008)];
                assert!((least..=most).contains(&found), "{n}: {found} is not in {least} to {most}");
            }
            assert_eq!(low + high, (n - 1) as f64, "symmetric values have a symmetric interval");
        }
    }

    #[test]
    fn the_same_values_have_the_same_interval() {
        let values = [3.0, 1.0, 4.0, 1.5, 9.0, 2.0];
        let mut turned = values;
        turned.reverse();
        assert_eq!(median_interval(&values), median_interval(&turned));
        assert_eq!(median_interval(&[2.0; 5]), Some([2.0; 2]));
        assert_eq!((median_interval(&[1.0]), median_interval(&[1.0, f64::NAN])), (None, None));
        // A generation of failed evaluations is minus infinity, an ordinary value.
        let [low, high] = median_interval(&[f64::NEG_INFINITY, 1.0, 2.0]).unwrap();
        assert_eq!((low, high), (f64::NEG_INFINITY, 2.0));
    }
}
