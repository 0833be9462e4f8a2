//! The binary format of leaky networks with integer parameters.

use crate::bytes::error::{BytesError, Field};
use crate::bytes::frame::{Kind, SHAPE, layout_hash, variant, word};
use crate::bytes::network::{NetworkBytes, Shape, byte_count};
use crate::error::Error;
use crate::leak::Leak;
use crate::leaky_layout::LeakyLayout;
use crate::quantized::network::check;
use crate::quantized::scale::QuantizedScale;

/// A [`QuantizedNetwork`](crate::quantized::QuantizedNetwork) in its binary format. The bytes have been checked.
///
/// Since the scale differs between individuals, it is stored together with the parameters. A board only determines the
/// number of fraction bits of the sensor values. The weights include the slope of the logistic function.
///
/// ```
/// use farsa_nn::bytes::{Aligned, QuantizedNetworkBytes};
/// use farsa_nn::quantized::{QuantizedNetwork, QuantizedScale};
/// use farsa_nn::{Leak, LeakyLayout};
///
/// const LAYOUT: LeakyLayout = LeakyLayout::new(2, 1, 1);
/// # fn main() -> Result<(), farsa_nn::bytes::BytesError> {
/// // A computer writes.
/// let mut fixed = [0; LAYOUT.parameter_count()];
/// let scale = QuantizedScale::quantize(&LAYOUT, 9, &[1.0, -1.0, 0.5, 3.0, 0.0, 0.5], &mut fixed)?;
/// let mut flash = Aligned([0; QuantizedNetworkBytes::byte_count(LAYOUT)]);
/// QuantizedNetworkBytes::write(LAYOUT, Leak::Filter, scale, 0, &fixed, &mut flash.0)?;
/// // A board without floating-point arithmetic reads and copies nothing.
/// let bytes = QuantizedNetworkBytes::read(&flash.0)?;
/// bytes.expect(LAYOUT, Leak::Filter, 9)?;
/// let state = [0; LAYOUT.state_len()];
/// let mut network = QuantizedNetwork::new(LAYOUT, Leak::Filter, bytes.scale(), bytes.parameters()?, state)?;
/// let mut y = [0];
/// network.step_quantized(&[256, 102], &mut y);
/// // Another individual with another scale can replace it later.
/// let others = QuantizedNetworkBytes::read(&flash.0)?;
/// network.set_parameters(others.scale(), others.parameters()?)?;
/// # Ok(())
/// # }
/// ```
pub type QuantizedNetworkBytes<'a> = NetworkBytes<'a, QuantizedShape>;

/// The shape of a [`QuantizedNetwork`](crate::quantized::QuantizedNetwork) in its binary format.
#[derive(Clone, Copy, Debug)]
pub struct QuantizedShape {
    layout: LeakyLayout,
    leak: Leak,
    scale: QuantizedScale,
}

impl NetworkBytes<'_, QuantizedShape> {
    /// Returns the number of bytes needed for a network with the given layout. The count saturates.
    pub const fn byte_count(layout: LeakyLayout) -> usize {
        byte_count::<i16>(layout.parameter_count())
    }

    /// Writes a network to `out`. The length of `out` must be [`byte_count`](Self::byte_count).
    ///
    /// The argument `channels` is the [`channel_hash`](crate::bytes::channel_hash) of the inputs and outputs, or 0.
    ///
    /// # Errors
    /// Returns [`BytesError::Parameters`] if [`QuantizedNetwork::new`](crate::quantized::QuantizedNetwork::new) would
    /// fail, or [`BytesError::Buffer`]. In these cases nothing is written.
    pub fn write(
        layout: LeakyLayout,
        leak: Leak,
        scale: QuantizedScale,
        channels: u64,
        parameters: &[i16],
        out: &mut [u8],
    ) -> Result<(), BytesError> {
        Shape::write(&QuantizedShape { layout, leak, scale }, channels, parameters, out)
    }

    /// Computes the hash of the layout without its slope, of the interpretation of the leaks and of the scale.
    pub fn layout_hash(layout: LeakyLayout, leak: Leak, scale: QuantizedScale) -> u64 {
        QuantizedShape { layout, leak, scale }.hash()
    }

    /// Checks that the layout without its slope, the interpretation of the leaks and the number of fraction bits of the
    /// sensor values are those of the caller.
    ///
    /// # Errors
    /// Returns [`BytesError::Mismatch`] if they differ.
    pub fn expect(&self, layout: LeakyLayout, leak: Leak, input_bits: u32) -> Result<(), BytesError> {
        let mut words = QuantizedShape { layout, leak, scale: self.shape.scale }.words();
        words[5] = input_bits;
        Field::Layout.check(layout_hash(Kind::QuantizedNetwork, &words), self.shape.hash())
    }

    /// Gets the layout of the network. Its slope is not used.
    pub const fn layout(&self) -> LeakyLayout {
        self.shape.layout
    }

    /// Gets the interpretation of the leaks.
    pub const fn leak(&self) -> Leak {
        self.shape.leak
    }

    /// Gets the scale that defines the positions of the binary points.
    pub const fn scale(&self) -> QuantizedScale {
        self.shape.scale
    }
}

impl<'a> Shape<'a> for QuantizedShape {
    type Number = i16;

    const KIND: Kind = Kind::QuantizedNetwork;

    fn read(words: &[u32; SHAPE], content: &'a [u8]) -> Result<(Self, &'a [u8]), BytesError> {
        let [sensors, hidden, outputs, slope, leak, inputs, weights, sums] = *words;
        if slope != 0 {
            return Err(BytesError::shape(3, slope));
        }
        let leak = variant(&Leak::ALL, 4, leak)?;
        let scale = QuantizedScale::new(inputs, weights, sums)?;
        let layout = LeakyLayout::new(sensors as usize, hidden as usize, outputs as usize);
        Ok((Self { layout, leak, scale }, content))
    }

    fn words(&self) -> [u32; SHAPE] {
        let Self { layout, leak, scale } = self;
        let [sensors, hidden, outputs] = [layout.sensors(), layout.hidden(), layout.outputs()].map(word);
        [sensors, hidden, outputs, 0, *leak as u32, scale.input_bits(), scale.weight_bits(), scale.sum_bits()]
    }

    fn byte_count(&self) -> usize {
        NetworkBytes::<Self>::byte_count(self.layout)
    }

    fn check<T: Copy>(&self, parameters: &[T], value: impl Fn(T) -> i16 + Copy) -> Result<(), Error> {
        check(&self.layout, self.scale, parameters, value)
    }
}
