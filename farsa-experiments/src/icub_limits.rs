//! Settings that contain joint angles of an iCub.

use farsa_body::robots::{Chain, Icub};
use farsa_lab::Error;

/// Checks that the angles of a chain \[deg\], the setting `key`, are within its joints' limits.
///
/// # Errors
/// [`Error::Setting`] with the first joint that is not.
pub(crate) fn within_limits(icub: &Icub, key: &str, chain: Chain, degrees: &[f64]) -> Result<(), Error> {
    let joints = icub.ranges(chain).into_iter().zip(chain.joint_names());
    degrees.iter().zip(joints).try_for_each(|(angle, (range, name))| within(key, &name, *angle, range))
}

/// Checks that an angle \[deg\] of the setting `key` is within a joint's limits \[rad\].
///
/// # Errors
/// As [`within_limits`].
pub(crate) fn within(key: &str, joint: &str, degrees: f64, range: [f64; 2]) -> Result<(), Error> {
    let [low, high] = range.map(f64::to_degrees);
    if (low - 1e-9..=high + 1e-9).contains(&degrees) {
        return Ok(());
    }
    Err(Error::setting(key, format!("{joint} at {degrees} deg, not from {low:.1} to {high:.1}")))
}
