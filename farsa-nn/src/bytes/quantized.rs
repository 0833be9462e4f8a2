//! A trained network of integers as bytes.

use crate::bytes::error::BytesError;
use crate::bytes::frame::{Frame, Kind, SHAPE, copy, frame_len, layout_hash, placed, same_channels, same_layout, word};
use crate::leak::Leak;
use crate::leaky_layout::LeakyLayout;
use crate::quantized::network::check;
use crate::quantized::scale::QuantizedScale;

/// A [`QuantizedNetwork`](crate::quantized::QuantizedNetwork) of given bytes, as
/// [`LeakyNetworkBytes`](crate::bytes::LeakyNetworkBytes) are a `LeakyNetwork`: checked, and used where it lies.
///
/// The scale lies beside the parameters: each individual has its own, and only the fraction bits of the sensor values are the
/// board's business. The slope of the logistic function is in the weights.
///
/// ```
/// use farsa_nn::bytes::{Aligned, QuantizedNetworkBytes};
/// use farsa_nn::quantized::{QuantizedNetwork, QuantizedScale};
/// use farsa_nn::{Leak, LeakyLayout};
///
/// const LAYOUT: LeakyLayout = LeakyLayout::new(2, 1, 1);
/// # fn main() -> Result<(), farsa_nn::bytes::BytesError> {
/// // A computer writes,
/// let mut fixed = [0; LAYOUT.parameter_count()];
/// let scale = QuantizedScale::quantize(&LAYOUT, 9, &[1.0, -1.0, 0.5, 3.0, 0.0, 0.5], &mut fixed)?;
/// let mut flash = Aligned([0; QuantizedNetworkBytes::byte_count(LAYOUT)]);
/// QuantizedNetworkBytes::write(LAYOUT, Leak::Filter, scale, 0, &fixed, &mut flash.0)?;
/// // a board without floating-point arithmetic reads: nothing is copied.
/// let bytes = QuantizedNetworkBytes::read(&flash.0)?;
/// bytes.expect(LAYOUT, Leak::Filter, 9)?;
/// let state = [0; LAYOUT.state_len()];
/// let mut network = QuantizedNetwork::new(LAYOUT, Leak::Filter, bytes.scale(), bytes.parameters()?, state)?;
/// let mut y = [0];
/// network.step_quantized(&[256, 102], &mut y);
/// // Others may come later, with a scale of their own.
/// let others = QuantizedNetworkBytes::read(&flash.0)?;
/// network.set_parameters(others.scale(), others.parameters()?)?;
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct QuantizedNetworkBytes<'a> {
    layout: LeakyLayout,
    leak: Leak,
    scale: QuantizedScale,
    channels: u64,
    parameters: &'a [u8],
}

impl QuantizedNetworkBytes<'_> {
    /// Number of bytes of a network of this layout; saturates.
    pub const fn byte_count(layout: LeakyLayout) -> usize {
        frame_len(layout.parameter_count().saturating_mul(2))
    }

    /// Fills `out` [[`byte_count`](Self::byte_count)] with a network.
    ///
    /// `channels` says what inputs and outputs are, by [`channel_hash`](crate::bytes::channel_hash); 0 says nothing.
    ///
    /// # Errors
    /// [`BytesError::Parameters`] as [`QuantizedNetwork::new`](crate::QuantizedNetwork::new), [`BytesError::Buffer`];
    /// then nothing is written.
    pub fn write(
        layout: LeakyLayout,
        leak: Leak,
        scale: QuantizedScale,
        channels: u64,
        parameters: &[i16],
        out: &mut [u8],
    ) -> Result<(), BytesError> {
        check(&layout, scale, parameters, |fixed| fixed)?;
        let numbers = parameters.iter().map(|p| p.to_le_bytes());
        Frame::write(Kind::QuantizedNetwork, &shape_of(layout, leak, bits(scale)), channels, numbers, out)
    }

    /// The layout hash: of the layout but for its slope, the reading of the leak and the scale.
    pub fn layout_hash(layout: LeakyLayout, leak: Leak, scale: QuantizedScale) -> u64 {
        hash_of(layout, leak, bits(scale))
    }
}

impl<'a> QuantizedNetworkBytes<'a> {
    /// Checks bytes that should be a network of integers, all of them: the format, the checksum, the layout, the scale, every
    /// parameter, and that no sum can overflow.
    ///
    /// # Errors
    /// As [`LeakyNetworkBytes::read`](crate::LeakyNetworkBytes::read).
    pub fn read(bytes: &'a [u8]) -> Result<Self, BytesError> {
        let Frame { shape, channels, parameters, .. } = Frame::open(Kind::QuantizedNetwork, bytes)?;
        let [sensors, hidden, outputs, slope, leak, inputs, weights, sums] = shape;
        if slope != 0 {
            return Err(BytesError::Shape { word: 3, found: slope });
        }
        let Some(&reading) = Leak::ALL.get(leak as usize) else {
            return Err(BytesError::Shape { word: 4, found: leak });
        };
        let scale = QuantizedScale::new(inputs, weights, sums)?;
        let layout = LeakyLayout::new(sensors as usize, hidden as usize, outputs as usize);
        let found = bytes.len();
        if found != Self::byte_count(layout) {
            return Err(BytesError::Length { expected: Self::byte_count(layout), found });
        }
        check(&layout, scale, parameters.as_chunks().0, i16::from_le_bytes)?;
        Ok(Self { layout, leak: reading, scale, channels, parameters })
    }

    /// Nothing, if the network is of this layout, whatever its slope, this reading of the leak and sensor values of so many
    /// fraction bits.
    ///
    /// # Errors
    /// [`BytesError::OtherLayout`].
    pub fn expect(&self, layout: LeakyLayout, leak: Leak, input_bits: u32) -> Result<(), BytesError> {
        let [_, weights, sums] = bits(self.scale);
        let own = hash_of(self.layout, self.leak, bits(self.scale));
        same_layout(hash_of(layout, leak, [input_bits, weights, sums]), own)
    }

    /// Nothing, if the network is for these channels, by their [`channel_hash`](crate::bytes::channel_hash).
    ///
    /// # Errors
    /// [`BytesError::OtherChannels`].
    pub fn expect_channels(&self, expected: u64) -> Result<(), BytesError> {
        same_channels(expected, self.channels)
    }

    /// The layout, with a slope that says nothing.
    pub const fn layout(&self) -> LeakyLayout {
        self.layout
    }

    /// The reading of the leak.
    pub const fn leak(&self) -> Leak {
        self.leak
    }

    /// Where the binary points lie.
    pub const fn scale(&self) -> QuantizedScale {
        self.scale
    }

    /// The [`channel_hash`](crate::bytes::channel_hash) of its inputs and outputs; 0 if nothing is said.
    pub const fn channels(&self) -> u64 {
        self.channels
    }

    /// The parameters [[`parameter_count`](LeakyLayout::parameter_count)] where they lie.
    ///
    /// # Errors
    /// [`BytesError::Misaligned`] and [`BytesError::BigEndian`]; [`copy_parameters`](Self::copy_parameters) then does.
    pub fn parameters(&self) -> Result<&'a [i16], BytesError> {
        placed(self.parameters)
    }

    /// Copies the parameters into `out` [[`parameter_count`](LeakyLayout::parameter_count)].
    ///
    /// # Errors
    /// [`BytesError::Buffer`]; then nothing is copied.
    pub fn copy_parameters(&self, out: &mut [i16]) -> Result<(), BytesError> {
        copy(self.parameters.as_chunks().0.iter().map(|bytes| i16::from_le_bytes(*bytes)), out)
    }
}

/// Fraction bits of inputs, weights and sums.
const fn bits(scale: QuantizedScale) -> [u32; 3] {
    [scale.input_bits(), scale.weight_bits(), scale.sum_bits()]
}

fn hash_of(layout: LeakyLayout, leak: Leak, bits: [u32; 3]) -> u64 {
    layout_hash(Kind::QuantizedNetwork, &shape_of(layout, leak, bits))
}

fn shape_of(layout: LeakyLayout, leak: Leak, [inputs, weights, sums]: [u32; 3]) -> [u32; SHAPE] {
    let [sensors, hidden, outputs] = [layout.sensors(), layout.hidden(), layout.outputs()].map(word);
    [sensors, hidden, outputs, 0, leak as u32, inputs, weights, sums]
}
