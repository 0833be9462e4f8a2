//! A trained layer of logistic units as bytes.

use crate::bytes::error::BytesError;
use crate::bytes::frame::{
    Frame, Kind, SHAPE, copy, frame_len, layout_hash, placed, same_channels, same_layout, values, word,
};
use crate::perceptron::{Perceptron, check};

/// A [`Perceptron`] of given bytes, as [`LeakyNetworkBytes`](crate::bytes::LeakyNetworkBytes) are a `LeakyNetwork`: checked, and
/// used where it lies.
///
/// ```
/// use farsa_nn::bytes::{Aligned, PerceptronBytes};
/// use farsa_nn::{Controller, Perceptron};
///
/// # fn main() -> Result<(), farsa_nn::bytes::BytesError> {
/// // A computer writes: weights source by source, then biases;
/// let mut flash = Aligned([0; PerceptronBytes::byte_count(2, 2)]);
/// PerceptronBytes::write(2, 2, 1.0, 0, &[0.0, 4.0, 4.0, 0.0, -2.0, -2.0], &mut flash.0)?;
/// // a board reads: nothing is copied.
/// let bytes = PerceptronBytes::read(&flash.0)?;
/// bytes.expect(2, 2, 1.0)?;
/// let mut vehicle = Perceptron::new(2, 2, bytes.slope(), bytes.parameters()?)?;
/// let mut wheels = [0.0; 2];
/// vehicle.step(&[1.0, 0.5], &mut wheels);
/// assert_eq!(wheels[0], 0.5);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PerceptronBytes<'a> {
    inputs: usize,
    outputs: usize,
    slope: f32,
    channels: u64,
    parameters: &'a [u8],
}

impl PerceptronBytes<'_> {
    /// Number of bytes of a layer of so many inputs and outputs; saturates.
    pub const fn byte_count(inputs: usize, outputs: usize) -> usize {
        frame_len(Perceptron::parameter_count(inputs, outputs).saturating_mul(4))
    }

    /// Fills `out` [[`byte_count`](Self::byte_count)] with a layer.
    ///
    /// `channels` says what inputs and outputs are, by [`channel_hash`](crate::bytes::channel_hash); 0 says nothing.
    ///
    /// # Errors
    /// [`BytesError::Parameters`] as [`Perceptron::new`](crate::Perceptron::new), [`BytesError::Buffer`]; then nothing is
    /// written.
    pub fn write(
        inputs: usize,
        outputs: usize,
        slope: f32,
        channels: u64,
        parameters: &[f32],
        out: &mut [u8],
    ) -> Result<(), BytesError> {
        check(inputs, outputs, slope, parameters.iter().copied())?;
        let numbers = parameters.iter().map(|p| p.to_le_bytes());
        Frame::write(Kind::Perceptron, &shape_of(inputs, outputs, slope), channels, numbers, out)
    }

    /// The layout hash: of the numbers of inputs and outputs, and the slope.
    pub fn layout_hash(inputs: usize, outputs: usize, slope: f32) -> u64 {
        layout_hash(Kind::Perceptron, &shape_of(inputs, outputs, slope))
    }
}

impl<'a> PerceptronBytes<'a> {
    /// Checks bytes that should be a layer, all of them: the format, the checksum, the shape and every parameter.
    ///
    /// # Errors
    /// As [`LeakyNetworkBytes::read`](crate::LeakyNetworkBytes::read).
    pub fn read(bytes: &'a [u8]) -> Result<Self, BytesError> {
        let Frame { shape, channels, parameters, .. } = Frame::open(Kind::Perceptron, bytes)?;
        let [inputs, outputs, bits, unused @ ..] = shape;
        if let Some(at) = unused.iter().position(|word| *word != 0) {
            return Err(BytesError::Shape { word: SHAPE - unused.len() + at, found: unused[at] });
        }
        let slope = f32::from_bits(bits);
        if !slope.is_finite() {
            return Err(BytesError::Shape { word: 2, found: bits });
        }
        let (inputs, outputs, found) = (inputs as usize, outputs as usize, bytes.len());
        let expected = Self::byte_count(inputs, outputs);
        if found != expected {
            return Err(BytesError::Length { expected, found });
        }
        check(inputs, outputs, slope, values(parameters))?;
        Ok(Self { inputs, outputs, slope, channels, parameters })
    }

    /// Nothing, if the layer has so many inputs and outputs, and this slope.
    ///
    /// # Errors
    /// [`BytesError::OtherLayout`].
    pub fn expect(&self, inputs: usize, outputs: usize, slope: f32) -> Result<(), BytesError> {
        let own = PerceptronBytes::layout_hash(self.inputs, self.outputs, self.slope);
        same_layout(PerceptronBytes::layout_hash(inputs, outputs, slope), own)
    }

    /// Nothing, if the layer is for these channels, by their [`channel_hash`](crate::bytes::channel_hash).
    ///
    /// # Errors
    /// [`BytesError::OtherChannels`].
    pub fn expect_channels(&self, expected: u64) -> Result<(), BytesError> {
        same_channels(expected, self.channels)
    }

    /// Number of inputs.
    pub const fn inputs(&self) -> usize {
        self.inputs
    }

    /// Number of outputs.
    pub const fn outputs(&self) -> usize {
        self.outputs
    }

    /// The slope of the logistic function.
    pub const fn slope(&self) -> f32 {
        self.slope
    }

    /// The [`channel_hash`](crate::bytes::channel_hash) of its inputs and outputs; 0 if nothing is said.
    pub const fn channels(&self) -> u64 {
        self.channels
    }

    /// The parameters [[`parameter_count`](Perceptron::parameter_count)] where they lie.
    ///
    /// # Errors
    /// [`BytesError::Misaligned`] and [`BytesError::BigEndian`]; [`copy_parameters`](Self::copy_parameters) then does.
    pub fn parameters(&self) -> Result<&'a [f32], BytesError> {
        placed(self.parameters)
    }

    /// Copies the parameters into `out` [[`parameter_count`](Perceptron::parameter_count)].
    ///
    /// # Errors
    /// [`BytesError::Buffer`]; then nothing is copied.
    pub fn copy_parameters(&self, out: &mut [f32]) -> Result<(), BytesError> {
        copy(values(self.parameters), out)
    }
}

fn shape_of(inputs: usize, outputs: usize, slope: f32) -> [u32; SHAPE] {
    [word(inputs), word(outputs), slope.to_bits(), 0, 0, 0, 0, 0]
}
