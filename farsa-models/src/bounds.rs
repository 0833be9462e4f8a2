//! Bounds of a model's numbers. Numbers within them survive writing and reading.

use farsa_body::robot::{Robot, RobotError, Shape};

/// A radius, half a length and half an edge are below this [m].
pub(crate) const MAX_SIZE: f64 = 1e9;

/// Bound from which a number counts as infinite [rad, m, N m, N]. It replaces infinity where a format requires a
/// number.
pub(crate) const ENDLESS: f64 = 1e9;

/// Checks whether a shape has sizes that files may have. Sizes of a file may also be NaN, or too small to have a half.
pub(crate) fn has_size(shape: &Shape) -> bool {
    let positive = |size: f64| size > 0.0 && size < MAX_SIZE;
    match *shape {
        Shape::Sphere { radius } => positive(radius),
        Shape::Capsule { radius, half_length } => positive(radius) && (0.0..MAX_SIZE).contains(&half_length),
        Shape::Cylinder { radius, half_length } => positive(radius) && positive(half_length),
        Shape::Box { half } => half.into_iter().all(positive),
        Shape::Plane => true,
    }
}

/// Refuses a valid robot with a shape that could not be read back.
pub(crate) fn check_sizes(robot: &Robot) -> Result<(), RobotError> {
    let colliders = robot.colliders.iter().map(|collider| (collider.name.as_str(), collider.shape));
    let visuals = robot.visuals.iter().map(|visual| ("visual", visual.shape));
    let Some((name, shape)) = colliders.chain(visuals).find(|(_, shape)| !has_size(shape)) else { return Ok(()) };
    let value = match shape {
        Shape::Sphere { radius } => radius,
        Shape::Capsule { radius, half_length } | Shape::Cylinder { radius, half_length } => radius.max(half_length),
        Shape::Box { half } => half.into_iter().fold(0.0, f64::max),
        Shape::Plane => 0.0,
    };
    Err(RobotError::Value { part: name.into(), field: "size (in files below 1e9)", value })
}

/// Computes the range that the ends in a file mean.
pub(crate) fn range_from_file([low, high]: [f64; 2]) -> [f64; 2] {
    [if low <= -ENDLESS { f64::NEG_INFINITY } else { low }, if high >= ENDLESS { f64::INFINITY } else { high }]
}

/// Computes the ends that a range has in a file. A range that begins or ends out there keeps the end that it has.
pub(crate) fn range_in_file([low, high]: [f64; 2]) -> [f64; 2] {
    [low.max(high.min(-ENDLESS)), high.min(low.max(ENDLESS))]
}

/// Computes the ends that a range has in an MJCF. Equal ends are moved apart, because MuJoCo reads them as no limit.
pub(crate) fn separated([low, high]: [f64; 2]) -> [f64; 2] {
    [low, if low < high { high } else { low + (low.abs() * f64::EPSILON).max(f64::MIN_POSITIVE) }]
}

/// Computes the range of which [`separated`] makes these ends.
pub(crate) fn joined([low, high]: [f64; 2]) -> [f64; 2] {
    if separated([low; 2]) == [low, high] { [low; 2] } else { [low, high] }
}

/// Number in an MJCF for an effort of 0 [N m, N].
const NO_EFFORT: f64 = 3.3e-308;

/// Computes the largest effort in an MJCF. MuJoCo reads 0 as no limit.
pub(crate) fn effort_in_file(largest: f64) -> f64 {
    if largest == 0.0 { NO_EFFORT } else { largest }
}

/// Computes the largest effort that [`effort_in_file`] writes.
pub(crate) fn effort_from_file(largest: f64) -> f64 {
    if largest == NO_EFFORT { 0.0 } else { largest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_ends_are_apart_in_files() {
        for end in [0.0, 1.0, -1.0, 0.1, -3e-300, 5e-324, 1e9, -7e8] {
            let ends = separated([end, end]);
            assert!(ends[0] < ends[1] && ends[1] - ends[0] <= 1e-6 && joined(ends) == [end, end], "{ends:?}");
        }
        for range in [[0.0, 1e-300], [-1.0, 1.0], [1.0, 1.000_000_1]] {
            assert_eq!(joined(separated(range)), range);
        }
        assert!(effort_in_file(0.0) > 0.0 && effort_from_file(effort_in_file(0.0)) == 0.0);
        assert_eq!(effort_from_file(effort_in_file(0.25)), 0.25);
    }

    #[test]
    fn ranges_are_read_as_they_were_written() {
        let (none, ends) = (f64::INFINITY, [-3e10, -2e9, -1e9, -1.0, 0.0, 2.0, 1e9, 5e9, 1e300]);
        let ranges = ends.into_iter().flat_map(|a| ends.map(|b| [a, b])).filter(|[low, high]| low <= high);
        let ranges = ranges.map(range_from_file).chain([[-none, none], [-none, 0.0], [0.0, none]]);
        for range in ranges {
            let [low, high] = range_in_file(range);
            assert!(low <= high && low.is_finite() && high.is_finite(), "{range:?}: {low} to {high}");
            assert_eq!(range_from_file([low, high]), range);
        }
    }

    #[test]
    fn sizes_are_below_the_largest() {
        let ball = |radius| Shape::Sphere { radius };
        let sizes = [(5e-324, true), (999_999_999.0, true), (1e9, false), (f64::NAN, false), (0.0, false)];
        assert!(sizes.iter().all(|(radius, expected)| has_size(&ball(*radius)) == *expected));
        assert!(has_size(&Shape::Capsule { radius: 1.0, half_length: 0.0 }));
        assert!(!has_size(&Shape::Capsule { radius: 1.0, half_length: 1e9 }));
        assert!(!has_size(&Shape::Box { half: [1.0, 1.0, 1e10] }));
    }
}
