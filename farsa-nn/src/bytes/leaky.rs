//! The binary format of leaky networks.

use crate::bytes::error::BytesError;
use crate::bytes::frame::{Kind, SHAPE, check_unused, finite, variant, word};
use crate::bytes::network::{NetworkBytes, Shape, byte_count};
use crate::error::Error;
use crate::leak::Leak;
use crate::leaky_layout::LeakyLayout;
use crate::leaky_network::LeakyModel;
use crate::network::Model as _;

/// A [`LeakyNetwork`](crate::LeakyNetwork) in its binary format. The bytes have been checked.
///
/// The format is specified in `docs/controller-format.md`. It consists of a header with the version, the layout and
/// hashes, the parameters in the order of the [`LeakyLayout`], and a CRC-32. All numbers are little-endian.
///
/// ```
/// use farsa_nn::bytes::{Aligned, LeakyNetworkBytes};
/// use farsa_nn::{Controller, Leak, LeakyLayout, LeakyNetwork};
///
/// const LAYOUT: LeakyLayout = LeakyLayout::new(2, 1, 1);
/// # fn main() -> Result<(), farsa_nn::bytes::BytesError> {
/// // A computer writes.
/// let mut flash = Aligned([0; LeakyNetworkBytes::byte_count(LAYOUT)]);
/// LeakyNetworkBytes::write(LAYOUT, Leak::Filter, 0, &[1.0, -1.0, 0.5, 3.0, 0.0, 0.5], &mut flash.0)?;
/// // A board reads and copies nothing.
/// let bytes = LeakyNetworkBytes::read(&flash.0)?;
/// bytes.expect(LAYOUT, Leak::Filter)?;
/// let mut network = LeakyNetwork::new(LAYOUT, Leak::Filter, bytes.parameters()?, [0.0; LAYOUT.state_len()])?;
/// let mut y = [0.0];
/// network.step(&[0.5, 0.2], &mut y);
/// // The parameters of another individual can replace them later.
/// network.set_parameters(LeakyNetworkBytes::read(&flash.0)?.parameters()?)?;
/// # Ok(())
/// # }
/// ```
pub type LeakyNetworkBytes<'a> = NetworkBytes<'a, LeakyModel>;

impl NetworkBytes<'_, LeakyModel> {
    /// Returns the number of bytes needed for a network with the given layout. The count saturates.
    pub const fn byte_count(layout: LeakyLayout) -> usize {
        byte_count::<f32>(layout.parameter_count())
    }

    /// Writes a network to `out`. The length of `out` must be [`byte_count`](Self::byte_count).
    ///
    /// The argument `channels` is the [`channel_hash`](crate::bytes::channel_hash) of the inputs and outputs, or 0.
    ///
    /// # Errors
    /// Returns [`BytesError::Parameters`] if [`LeakyNetwork::new`](crate::LeakyNetwork::new) would fail, or
    /// [`BytesError::Buffer`]. In these cases nothing is written.
    pub fn write(
        layout: LeakyLayout,
        leak: Leak,
        channels: u64,
        parameters: &[f32],
        out: &mut [u8],
    ) -> Result<(), BytesError> {
        Shape::write(&LeakyModel { layout, leak }, channels, parameters, out)
    }

    /// Computes the hash of a layout, including its slope, and of the interpretation of the leaks.
    pub fn layout_hash(layout: LeakyLayout, leak: Leak) -> u64 {
        LeakyModel { layout, leak }.hash()
    }

    /// Checks that the layout and the interpretation of the leaks are those of the caller.
    ///
    /// # Errors
    /// Returns [`BytesError::Mismatch`] if they differ.
    pub fn expect(&self, layout: LeakyLayout, leak: Leak) -> Result<(), BytesError> {
        self.expect_shape(&LeakyModel { layout, leak })
    }

    /// Gets the layout of the network.
    pub const fn layout(&self) -> LeakyLayout {
        self.shape.layout
    }

    /// Gets the interpretation of the leaks.
    pub const fn leak(&self) -> Leak {
        self.shape.leak
    }
}

impl<'a> Shape<'a> for LeakyModel {
    type Number = f32;

    const KIND: Kind = Kind::LeakyNetwork;

    fn read(words: &[u32; SHAPE], content: &'a [u8]) -> Result<(Self, &'a [u8]), BytesError> {
        let [sensors, hidden, outputs, slope, leak, ..] = *words;
        let leak = variant(&Leak::ALL, 4, leak)?;
        check_unused(words, 5)?;
        let slope = finite(3, slope)?;
        let layout = LeakyLayout::new(sensors as usize, hidden as usize, outputs as usize).with_slope(slope);
        Ok((Self { layout, leak }, content))
    }

    fn words(&self) -> [u32; SHAPE] {
        let layout = self.layout;
        let [sensors, hidden, outputs] = [layout.sensors(), layout.hidden(), layout.outputs()].map(word);
        [sensors, hidden, outputs, layout.slope().to_bits(), self.leak as u32, 0, 0, 0]
    }

    fn byte_count(&self) -> usize {
        NetworkBytes::<Self>::byte_count(self.layout)
    }

    fn check<T: Copy>(&self, parameters: &[T], value: impl Fn(T) -> f32 + Copy) -> Result<(), Error> {
        self.check_model(parameters, value)
    }
}
