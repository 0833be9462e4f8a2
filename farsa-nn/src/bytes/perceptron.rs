//! The binary format of layers of logistic units.

use crate::bytes::error::BytesError;
use crate::bytes::frame::{Kind, SHAPE, check_unused, finite, word};
use crate::bytes::network::{NetworkBytes, Shape, byte_count};
use crate::error::Error;
use crate::network::Model as _;
use crate::perceptron::{Perceptron, PerceptronModel};

/// A [`Perceptron`] in its binary format. The bytes have been checked.
///
/// For an example, see [`LeakyNetworkBytes`](crate::bytes::LeakyNetworkBytes).
pub type PerceptronBytes<'a> = NetworkBytes<'a, PerceptronModel>;

impl NetworkBytes<'_, PerceptronModel> {
    /// Returns the number of bytes needed for a layer with the given shape. The count saturates.
    pub const fn byte_count(inputs: usize, outputs: usize) -> usize {
        byte_count::<f32>(Perceptron::parameter_count(inputs, outputs))
    }

    /// Writes a layer to `out`. The length of `out` must be [`byte_count`](Self::byte_count).
    ///
    /// The argument `channels` is the [`channel_hash`](crate::bytes::channel_hash) of the inputs and outputs, or 0.
    ///
    /// # Errors
    /// Returns [`BytesError::Parameters`] if [`Perceptron::new`](crate::Perceptron::new) would fail, or
    /// [`BytesError::Buffer`]. In these cases nothing is written.
    pub fn write(
        inputs: usize,
        outputs: usize,
        slope: f32,
        channels: u64,
        parameters: &[f32],
        out: &mut [u8],
    ) -> Result<(), BytesError> {
        Shape::write(&PerceptronModel { inputs, outputs, slope }, channels, parameters, out)
    }

    /// Computes the hash of the numbers of inputs and outputs and of the slope.
    pub fn layout_hash(inputs: usize, outputs: usize, slope: f32) -> u64 {
        PerceptronModel { inputs, outputs, slope }.hash()
    }

    /// Checks that the shape and the slope are those of the caller.
    ///
    /// # Errors
    /// Returns [`BytesError::Mismatch`] if they differ.
    pub fn expect(&self, inputs: usize, outputs: usize, slope: f32) -> Result<(), BytesError> {
        self.expect_shape(&PerceptronModel { inputs, outputs, slope })
    }

    /// Gets the number of inputs.
    pub const fn inputs(&self) -> usize {
        self.shape.inputs
    }

    /// Gets the number of outputs.
    pub const fn outputs(&self) -> usize {
        self.shape.outputs
    }

    /// Gets the slope of the logistic function.
    pub const fn slope(&self) -> f32 {
        self.shape.slope
    }
}

impl<'a> Shape<'a> for PerceptronModel {
    type Number = f32;

    const KIND: Kind = Kind::Perceptron;

    fn read(words: &[u32; SHAPE], content: &'a [u8]) -> Result<(Self, &'a [u8]), BytesError> {
        let [inputs, outputs, slope, ..] = *words;
        check_unused(words, 3)?;
        let (inputs, outputs, slope) = (inputs as usize, outputs as usize, finite(2, slope)?);
        Ok((Self { inputs, outputs, slope }, content))
    }

    fn words(&self) -> [u32; SHAPE] {
        [word(self.inputs), word(self.outputs), self.slope.to_bits(), 0, 0, 0, 0, 0]
    }

    fn byte_count(&self) -> usize {
        NetworkBytes::<Self>::byte_count(self.inputs, self.outputs)
    }

    fn check<T: Copy>(&self, parameters: &[T], value: impl Fn(T) -> f32 + Copy) -> Result<(), Error> {
        self.check_model(parameters, value)
    }
}
