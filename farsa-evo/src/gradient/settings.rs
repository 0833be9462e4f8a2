//! Ranges of the numbers of configurations and states.

use alloc::vec;
use alloc::vec::Vec;

use crate::error::{EvoError, check_range, check_setting};
use crate::snapshot::StateReader;

/// The largest magnitude of a gene's mean and of a step size: products of two of them with noise stay finite.
pub(super) const LARGEST: f64 = 1e100;

/// The smallest step size.
pub(super) const SMALLEST: f64 = 1e-100;

/// Checks a step size or speed.
pub(super) fn positive(name: &'static str, value: f64) -> Result<(), EvoError> {
    check_range(name, value, [SMALLEST, LARGEST], "1e-100 to 1e100")
}

/// Checks the learning rate of a distribution.
pub(super) fn learning_rate(name: &'static str, value: f64) -> Result<(), EvoError> {
    check_range(name, value, [0.0, 10.0], "0 to 10")
}

/// Checks the share of the past in a decaying mean.
pub(super) fn decay(name: &'static str, value: f64) -> Result<(), EvoError> {
    check_setting((0.0..1.0).contains(&value), name, value, "0 to less than 1")
}

/// Checks the lower limit of a count.
pub(super) fn at_least(name: &'static str, value: usize, least: usize, allowed: &'static str) -> Result<(), EvoError> {
    check_setting(value >= least, name, value as f64, allowed)
}

/// Checks the coordinates of a search point.
pub(super) fn point(name: &'static str, point: &[f64]) -> Result<(), EvoError> {
    point.iter().try_for_each(|x| check_range(name, *x, [-LARGEST, LARGEST], "-1e100 to 1e100"))
}

/// A coordinate that stays where it is representable.
pub(super) fn bounded(x: f64) -> f64 {
    x.clamp(-LARGEST, LARGEST)
}

/// A step size that stays where it is representable.
pub(super) fn bounded_size(sigma: f64) -> f64 {
    sigma.clamp(SMALLEST, LARGEST)
}

/// Reads numbers that are in a range, both ends included.
pub(super) fn read(
    reader: &mut StateReader<'_>,
    count: usize,
    what: &'static str,
    range: [f64; 2],
) -> Result<Vec<f64>, EvoError> {
    let mut row = vec![0.0; count];
    reader.reals(&mut row)?;
    let [low, high] = range;
    let wrong = row.iter().find(|x| !(low..=high).contains(*x));
    wrong.map_or(Ok(()), |x| Err(EvoError::state_content(what, x.to_bits())))?;
    Ok(row)
}

/// Reads the coordinates of a search point.
pub(super) fn read_point(reader: &mut StateReader<'_>, genes: usize) -> Result<Vec<f64>, EvoError> {
    read(reader, genes, "a coordinate of a search point", [-LARGEST, LARGEST])
}

/// Reads step sizes.
pub(super) fn read_sizes(reader: &mut StateReader<'_>, count: usize) -> Result<Vec<f64>, EvoError> {
    read(reader, count, "a step size", [SMALLEST, LARGEST])
}

/// Reads one number that is not negative.
pub(super) fn read_length(reader: &mut StateReader<'_>) -> Result<f64, EvoError> {
    let row = read(reader, 1, "a length", [0.0, f64::MAX])?;
    Ok(row.first().copied().unwrap_or_default())
}
