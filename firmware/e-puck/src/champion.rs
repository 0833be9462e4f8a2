//! The trained layer, in flash.

use farsa_nn::bytes::{Aligned, BytesError, PerceptronBytes};

/// Infrared sensors, in the order of the exported table: at 90, 54, 18, -18, -54, -90, -150 and 150 degrees to the left of ahead.
pub const SENSORS: usize = 8;

/// Wheels: left, right.
pub const WHEELS: usize = 2;

/// The slope of the logistic function.
pub const SLOPE: f32 = 1.0;

/// Hash of the names of sensors and motors, as `farsa export controller --format rust` prints it.
pub const CHANNELS: u64 = 0x98A9_7938_EFDF_6EC7;

// A file of another length does not compile.
static CHAMPION: Aligned<[u8; PerceptronBytes::byte_count(SENSORS, WHEELS)]> =
    Aligned(*include_bytes!("../champion.farsa"));

/// Returns the champion's parameters in place, after all checks.
///
/// # Errors
/// An error of the bytes. Nothing has run then.
pub fn champion() -> Result<&'static [f32], BytesError> {
    let bytes = PerceptronBytes::read(&CHAMPION.0)?;
    bytes.expect(SENSORS, WHEELS, SLOPE)?;
    bytes.expect_channels(CHANNELS)?;
    bytes.parameters()
}
