//! Values of a curve, thinned while they are added.

/// Number of points above which only every k-th is drawn, with k a power of two.
pub(crate) const MAX_POINTS: usize = 1500;

/// A number per generation, from generation 0. Only the numbers that are drawn are stored: every k-th and the last.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Series {
    values: Vec<f64>,
    /// Generations from one stored value to the next, a power of two.
    stride: usize,
    len: usize,
    last: f64,
    /// Least and largest finite number.
    ends: [f64; 2],
}

impl Default for Series {
    fn default() -> Self {
        Self { values: Vec::new(), stride: 1, len: 0, last: f64::NAN, ends: [f64::INFINITY, f64::NEG_INFINITY] }
    }
}

impl Series {
    /// Adds the number of the next generation.
    pub(crate) fn push(&mut self, value: f64) {
        if self.len.is_multiple_of(self.stride) {
            self.values.push(value);
        }
        if self.values.len() > MAX_POINTS {
            let mut index = 0..;
            self.values.retain(|_| index.next().is_some_and(|index: usize| index.is_multiple_of(2)));
            self.stride *= 2;
        }
        self.len += 1;
        self.last = value;
        if value.is_finite() {
            self.ends = [self.ends[0].min(value), self.ends[1].max(value)];
        }
    }

    /// Gets the number of generations.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Iterates over the drawn generations with their values.
    pub(crate) fn points(&self) -> impl Iterator<Item = (usize, f64)> {
        let values = self.values.iter().enumerate().map(|(index, value)| (index * self.stride, *value));
        let last = self.len.checked_sub(1).filter(|last| !last.is_multiple_of(self.stride));
        values.chain(last.map(|last| (last, self.last)))
    }

    /// Computes the least and the largest finite number of all generations, infinite without any.
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

/// Thins values as a series of the same length.
pub(crate) fn thinned<T: Copy>(values: &[T]) -> impl Iterator<Item = (usize, T)> {
    let (stride, last) = (stride(values.len()), values.len().saturating_sub(1));
    values.iter().copied().enumerate().filter(move |(index, _)| index.is_multiple_of(stride) || *index == last)
}

/// Computes the number of generations from one drawn point to the next.
fn stride(points: usize) -> usize {
    points.div_ceil(MAX_POINTS).next_power_of_two()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_series_stores_only_drawn_points() {
        let value = |generation: usize| if generation == 700 { f64::NAN } else { 1.0 / (1.0 + generation as f64) };
        let mut series = Series::default();
        let mut values = Vec::new();
        for generation in 0..20_000 {
            let bits = |(place, value): (usize, f64)| (place, value.to_bits());
            if generation % 499 == 0 || [1500, 1501, 3000, 3001].contains(&generation) {
                assert!(series.points().map(bits).eq(thinned(&values).map(bits)), "{generation}");
                assert_eq!(series.len(), generation);
            }
            series.push(value(generation));
            values.push(value(generation));
            assert!(series.values.len() <= MAX_POINTS && series.values.capacity() <= 2 * (MAX_POINTS + 1));
        }
        assert_eq!(series.ends(), [1.0 / 20_000.0, 1.0]);
        assert!(series.points().count() > MAX_POINTS / 2);
    }

    proptest! {
        #[test]
        fn every_number_is_between_the_ends(values in prop::collection::vec(any::<f64>(), 0..40)) {
            let series: Series = values.iter().copied().collect();
            let finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
            let least = finite.iter().copied().fold(f64::INFINITY, f64::min);
            let greatest = finite.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            prop_assert_eq!(series.ends(), [least, greatest]);
            prop_assert!(series.points().map(|point| point.1.to_bits()).eq(values.iter().map(|value| value.to_bits())));
        }
    }
}
