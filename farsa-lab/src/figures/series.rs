//! The values of a curve, thinned out as they come.

/// More points than these are not seen; every k-th is drawn then, k a power of two.
pub(crate) const MOST_POINTS: usize = 1500;

/// A number per generation, from generation 0, of which no more are kept than can be seen: every so many-th, and the last.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Series {
    kept: Vec<f64>,
    /// Generations from one that is kept to the next, a power of two.
    stride: usize,
    len: usize,
    last: f64,
    /// The least and the greatest finite number.
    ends: [f64; 2],
}

impl Default for Series {
    fn default() -> Self {
        Self { kept: Vec::new(), stride: 1, len: 0, last: f64::NAN, ends: [f64::INFINITY, f64::NEG_INFINITY] }
    }
}

impl Series {
    /// Adds the number of the next generation.
    pub(crate) fn push(&mut self, value: f64) {
        if self.len.is_multiple_of(self.stride) {
            self.kept.push(value);
        }
        if self.kept.len() > MOST_POINTS {
            let mut place = 0..;
            self.kept.retain(|_| place.next().is_some_and(|place: usize| place.is_multiple_of(2)));
            self.stride *= 2;
        }
        self.len += 1;
        self.last = value;
        if value.is_finite() {
            self.ends = [self.ends[0].min(value), self.ends[1].max(value)];
        }
    }

    /// Number of generations.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// The generations that are drawn, with their numbers.
    pub(crate) fn points(&self) -> impl Iterator<Item = (usize, f64)> {
        let kept = self.kept.iter().enumerate().map(|(place, value)| (place * self.stride, *value));
        let last = self.len.checked_sub(1).filter(|last| !last.is_multiple_of(self.stride));
        kept.chain(last.map(|last| (last, self.last)))
    }

    /// The least and the greatest finite number of all generations; infinite where there is none.
    pub(crate) fn ends(&self) -> [f64; 2] {
        self.ends
    }
}

impl FromIterator<f64> for Series {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut series = Self::default();
        for value in values {
            series.push(value);
        }
        series
    }
}

/// Of so many values those that are drawn, thinned out as a series of as many is.
pub(crate) fn thinned<T: Copy>(values: &[T]) -> impl Iterator<Item = (usize, T)> {
    let (stride, last) = (stride(values.len()), values.len().saturating_sub(1));
    values.iter().copied().enumerate().filter(move |(place, _)| place.is_multiple_of(stride) || *place == last)
}

/// Every how many generations a point is drawn.
fn stride(points: usize) -> usize {
    points.div_ceil(MOST_POINTS).next_power_of_two()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_series_keeps_what_is_drawn_however_long_it_is() {
        let value = |generation: usize| if generation == 700 { f64::NAN } else { 1.0 / (1.0 + generation as f64) };
        let mut series = Series::default();
        let mut all = Vec::new();
        for generation in 0..20_000 {
            let bits = |(place, value): (usize, f64)| (place, value.to_bits());
            if generation % 499 == 0 || [1500, 1501, 3000, 3001].contains(&generation) {
                assert!(series.points().map(bits).eq(thinned(&all).map(bits)), "{generation}");
                assert_eq!(series.len(), generation);
            }
            series.push(value(generation));
            all.push(value(generation));
            assert!(series.kept.len() <= MOST_POINTS && series.kept.capacity() <= 2 * (MOST_POINTS + 1));
        }
        assert_eq!(series.ends(), [1.0 / 20_000.0, 1.0]);
        assert!(series.points().count() > MOST_POINTS / 2);
    }

    proptest! {
        #[test]
        fn no_number_is_beyond_the_ends(values in prop::collection::vec(any::<f64>(), 0..40)) {
            let series: Series = values.iter().copied().collect();
            let finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
            let least = finite.iter().copied().fold(f64::INFINITY, f64::min);
            let greatest = finite.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            prop_assert_eq!(series.ends(), [least, greatest]);
            prop_assert!(series.points().map(|point| point.1.to_bits()).eq(values.iter().map(|value| value.to_bits())));
        }
    }
}
