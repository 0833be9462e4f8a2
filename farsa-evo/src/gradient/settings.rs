//! Ranges of the numbers of configurations and states.

use alloc::vec::Vec;

use crate::error::{EvoError, check_range, check_setting};
use crate::search::Row;

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

/// A step size within its limits.
pub(super) fn bounded_size(sigma: f64, largest: f64) -> f64 {
    sigma.max(SMALLEST).min(largest)
}

/// Checks the first step size and the upper limit of all.
pub(super) fn step_sizes(sigma: f64, largest: f64) -> Result<(), EvoError> {
    positive("sigma", sigma)?;
    check_range("largest_step", largest, [sigma, LARGEST], "sigma to 1e100")
}

/// The coordinates of a search point in a saved state.
pub(super) fn point_row(point: &mut [f64]) -> Row<'_> {
    (point, "a coordinate of a search point", [-LARGEST, LARGEST])
}

/// Step sizes in a saved state.
pub(super) fn sizes_row(sizes: &mut [f64]) -> Row<'_> {
    (sizes, "a step size", [SMALLEST, LARGEST])
}

/// The smallest and the largest step size.
pub(super) fn ends(sizes: &[f64]) -> Vec<f64> {
    let sizes = || sizes.iter().copied();
    sizes().reduce(f64::min).into_iter().chain(sizes().reduce(f64::max)).collect()
}
