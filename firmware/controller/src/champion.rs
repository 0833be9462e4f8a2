//! The trained network, in flash.

use farsa_nn::bytes::{Aligned, BytesError, LeakyNetworkBytes, QuantizedNetworkBytes};
use farsa_nn::quantized::QuantizedScale;
use farsa_nn::{Leak, LeakyLayout};

/// 29 sensors, 12 hidden neurons, 23 motors.
pub const LAYOUT: LeakyLayout = LeakyLayout::new(29, 12, 23);

/// The reading of the leak.
pub const LEAK: Leak = Leak::Filter;

/// Hash of the names of sensors and motors, as `farsa export controller --format rust` prints it.
pub const CHANNELS: u64 = 0xFD6D_D3B7_8495_FA71;

/// Fraction bits of the sensor values of the network in integers.
pub const INPUT_BITS: u32 = 9;

// A file of another length does not compile.
static CHAMPION: Aligned<[u8; LeakyNetworkBytes::byte_count(LAYOUT)]> = Aligned(*include_bytes!("../champion.farsa"));

// The build script quantizes it.
static FIXED: Aligned<[u8; QuantizedNetworkBytes::byte_count(LAYOUT)]> =
    Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/champion-fixed.farsa")));

/// Returns the champion's parameters in place, after all checks.
///
/// # Errors
/// An error of the bytes. Nothing has run then.
pub fn champion() -> Result<&'static [f32], BytesError> {
    let bytes = LeakyNetworkBytes::read(&CHAMPION.0)?;
    bytes.expect(LAYOUT, LEAK)?;
    bytes.expect_channels(CHANNELS)?;
    bytes.parameters()
}

/// The champion's bytes in integers.
pub fn fixed_champion() -> &'static [u8] {
    &FIXED.0
}

/// Returns the scale and the parameters of a network in integers in place, after all checks.
///
/// # Errors
/// An error of the bytes.
pub(crate) fn read_fixed(bytes: &'static [u8]) -> Result<(QuantizedScale, &'static [i16]), BytesError> {
    let bytes = QuantizedNetworkBytes::read(bytes)?;
    bytes.expect(LAYOUT, LEAK, INPUT_BITS)?;
    bytes.expect_channels(CHANNELS)?;
    Ok((bytes.scale(), bytes.parameters()?))
}
