//! The trained network, in flash.

use farsa_nn::{Aligned, BytesError, Layout, Leak, NetworkBytes};

/// 29 sensors, 12 hidden neurons, 23 motors.
pub const LAYOUT: Layout = Layout::new(29, 12, 23);

/// The reading of the leak.
pub const LEAK: Leak = Leak::Filter;

/// Hash of the names of sensors and motors, as `farsa export controller --format rust` prints it.
pub const CHANNELS: u64 = 0xFD6D_D3B7_8495_FA71;

// A file of another length does not compile.
static CHAMPION: Aligned<[u8; NetworkBytes::byte_count(LAYOUT)]> = Aligned(*include_bytes!("../champion.farsa"));

/// The champion's parameters where they lie, after all checks.
///
/// # Errors
/// What is wrong with the bytes; nothing has run then.
pub fn champion() -> Result<&'static [f32], BytesError> {
    let bytes = NetworkBytes::read(&CHAMPION.0)?;
    bytes.expect(LAYOUT, LEAK)?;
    bytes.expect_channels(CHANNELS)?;
    bytes.parameters()
}
