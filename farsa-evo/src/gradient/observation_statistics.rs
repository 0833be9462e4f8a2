//! Running mean and variance of observations for each channel.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Scalar;

use super::settings::{LARGEST, point, point_row};
use crate::error::{EvoError, check_range};
use crate::population::Population;
use crate::snapshot::{Snapshot, StateReader, push_reals};

/// The largest sum of squares in a saved state.
const LARGEST_SQUARES: f64 = 1e250;

/// The standard deviation below which a channel is constant, as in the program of the authors of \[Mania2018\].
const LEAST_DEVIATION: f64 = 1e-7;

/// Running mean and variance of every channel of an observation. Use this to normalize observations.
///
/// It is independent of the strategies. Statistics of parts, such as an episode or an individual, are computed anywhere and
/// [`merge`](Self::merge)d in a fixed order. Merged parts and a whole agree to a relative 1e-12, but not in their bits.
/// Parts that are merged in the same order agree in their bits.
///
/// Source: \[Welford1962\] for one row, \[Chan1983\] for parts, and V2 of \[Mania2018\] algorithm 1 for the normalization,
/// where a channel with a standard deviation below 1e-7 is 0. Deviations: the variance is the mean square (divided by n,
/// not n - 1), and there is a limit.
///
/// ```
/// use farsa_evo::ObservationStatistics;
///
/// let mut statistics = ObservationStatistics::new(2)?;
/// for row in [[1.0, 5.0], [3.0, 5.0]] {
///     statistics.push(&row);
/// }
/// assert_eq!((statistics.count(), statistics.mean()), (2, &[2.0, 5.0][..]));
/// let mut row = [4.0, 9.0];
/// statistics.normalize(&mut row, 10.0);
/// assert_eq!(row, [2.0, 0.0]);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ObservationStatistics {
    count: u64,
    mean: Vec<f64>,
    /// Sums of the squared distances from the mean (m2).
    squares: Vec<f64>,
}

impl ObservationStatistics {
    /// Creates empty statistics for the given number of channels.
    ///
    /// # Errors
    /// Returns [`EvoError::OutOfRange`] for none, or more than [`Population::MAX_GENES`].
    pub fn new(channels: usize) -> Result<Self, EvoError> {
        if channels == 0 || channels > Population::MAX_GENES {
            return Err(EvoError::OutOfRange { field: "channels", value: channels as f64, allowed: "1 to 2^28" });
        }
        Ok(Self { count: 0, mean: vec![0.0; channels], squares: vec![0.0; channels] })
    }

    /// Restores statistics from a [saved](Snapshot::save) state. The number of channels is taken from the state.
    ///
    /// # Errors
    /// Returns [`EvoError::State`] for bytes that are no such state.
    pub fn from_saved(state: &[u8]) -> Result<Self, EvoError> {
        let channels = state.len().saturating_sub(8) / 16;
        let mut statistics = Self::new(channels).map_err(|_| EvoError::state_length(24, state.len()))?;
        statistics.restore(state)?;
        Ok(statistics)
    }

    /// Number of channels.
    pub fn channels(&self) -> usize {
        self.mean.len()
    }

    /// Number of observations so far.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Gets the mean of each channel. Before the first observation this is 0.
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// Gets the sum of the squared distances from the mean for each channel.
    pub fn squares(&self) -> &[f64] {
        &self.squares
    }

    /// Computes the variance of each channel. Before the first observation this is 0.
    pub fn variance(&self) -> impl Iterator<Item = f64> + '_ {
        let count = self.count.max(1) as f64;
        self.squares.iter().map(move |squares| squares / count)
    }

    /// Adds an observation \[channels\] and returns true. If the observation has a wrong length or contains a number
    /// that is not finite, it is skipped and this returns false.
    pub fn push(&mut self, row: &[f32]) -> bool {
        debug_assert_eq!(row.len(), self.channels(), "a row of other channels");
        if row.len() != self.channels() || self.count == u64::MAX || !row.iter().all(|x| x.is_finite()) {
            return false;
        }
        self.count += 1;
        let count = self.count as f64;
        for ((mean, squares), x) in self.mean.iter_mut().zip(&mut self.squares).zip(row) {
            let x = f64::from(*x);
            // d = x - mean, mean <- mean + d / n, S <- S + d (x - new mean). [Welford1962].
            let distance = x - *mean;
            *mean += distance / count;
            *squares += distance * (x - *mean);
        }
        true
    }

    /// Adds a batch of observations. You pass their number, their mean \[channels\] and their sum of squared distances
    /// from it \[channels\].
    ///
    /// # Errors
    /// Returns [`EvoError::OutOfRange`] for other channels, a mean not within 1e100 of zero, a sum of squares that is
    /// negative or above 1e250, or more than 2^64 - 1 observations. Nothing is added then.
    pub fn add(&mut self, count: u64, mean: &[f64], squares: &[f64]) -> Result<(), EvoError> {
        for channels in [mean.len(), squares.len()] {
            if channels != self.channels() {
                let (value, allowed) = (channels as f64, "the number that the statistics have");
                return Err(EvoError::OutOfRange { field: "channels", value, allowed });
            }
        }
        point("mean", mean)?;
        squares.iter().try_for_each(|x| check_range("squares", *x, [0.0, LARGEST_SQUARES], "0 to 1e250"))?;
        let (before, added) = (self.count as f64, count as f64);
        let too_many = EvoError::OutOfRange { field: "count", value: before + added, allowed: "up to 2^64 - 1" };
        let total = self.count.checked_add(count).ok_or(too_many)?;
        if count == 0 {
            return Ok(());
        }
        // All checks are above, so an error leaves the statistics unchanged.
        self.count = total;
        let share = added / total as f64;
        let own = self.mean.iter_mut().zip(&mut self.squares);
        for ((mean, squares), (other, other_squares)) in own.zip(mean.iter().zip(squares)) {
            // S <- S_a + S_b + d^2 n_a n_b / n, with d the distance of the means. [Chan1983].
            let distance = other - *mean;
            *mean += distance * share;
            *squares = (*squares + (other_squares + distance * distance * (before * share))).min(LARGEST_SQUARES);
        }
        Ok(())
    }

    /// Adds all observations of other statistics. Use this to combine statistics of several episodes or individuals.
    ///
    /// # Errors
    /// The conditions of [`add`](Self::add).
    pub fn merge(&mut self, other: &Self) -> Result<(), EvoError> {
        self.add(other.count, &other.mean, &other.squares)
    }

    /// Normalizes an observation \[channels\] in place. This subtracts the mean, divides by the standard deviation and
    /// limits the result to `limit` from zero.
    ///
    /// A channel with a standard deviation below 1e-7 becomes 0, so that all are 0 until there are two observations. A
    /// NaN stays one. A `limit` that is not above 0 limits nothing.
    pub fn normalize(&self, row: &mut [f32], limit: f32) {
        debug_assert_eq!(row.len(), self.channels(), "a row of other channels");
        let limit = if limit > 0.0 { limit } else { f32::INFINITY };
        for ((x, mean), variance) in row.iter_mut().zip(&self.mean).zip(self.variance()) {
            let deviation = Scalar::sqrt(variance);
            let distance = f64::from(*x) - mean;
            // A NaN passes through, also in a constant channel.
            let silent = deviation < LEAST_DEVIATION && !x.is_nan();
            *x = if silent { 0.0 } else { ((distance / deviation) as f32).clamp(-limit, limit) };
        }
    }
}

impl Snapshot for ObservationStatistics {
    fn save(&self) -> Vec<u8> {
        let mut state = Vec::with_capacity(8 + 16 * self.channels());
        state.extend(self.count.to_le_bytes());
        push_reals(&mut state, &self.mean);
        push_reals(&mut state, &self.squares);
        state
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let channels = self.channels();
        let mut reader = StateReader::new(state, 8 + 16 * channels)?;
        let count = reader.u64()?;
        let (mut mean, mut squares) = (vec![0.0; channels], vec![0.0; channels]);
        for (row, what, range) in [point_row(&mut mean), (&mut squares, "a sum of squares", [0.0, LARGEST_SQUARES])] {
            reader.row(row, what, range)?;
        }
        if count == 0 && mean.iter().chain(&squares).any(|x| *x != 0.0) {
            return Err(EvoError::state_content("a number of observations", count));
        }
        (self.count, self.mean, self.squares) = (count, mean, squares);
        Ok(())
    }
}

// The mean of anything that `add` and `push` take stays where `restore` takes it back.
const _: () = assert!(LARGEST > f32::MAX as f64);
