//! The bytes of a layer of logistic units.

use crate::bytes::error::BytesError;
use crate::bytes::frame::{Kind, SHAPE, check_unused, finite, word};
use crate::bytes::network::{NetworkBytes, Shape, byte_count};
use crate::error::Error;
use crate::network::Model as _;
use crate::perceptron::{Perceptron, PerceptronModel};

/// The checked bytes of a [`Perceptron`].
///
/// [`LeakyNetworkBytes`](crate::bytes::LeakyNetworkBytes) has an example.
pub type PerceptronBytes<'a> = NetworkBytes<'a, PerceptronModel>;

impl NetworkBytes<'_, PerceptronModel> {
    /// Number of bytes of a layer of this shape. Saturates.
    pub const fn byte_count(inputs: usize, outputs: usize) -> usize {
        byte_count::<f32>(Perceptron::parameter_count(inputs, outputs))
    }

    /// Writes a layer into `out` [[`byte_count`](Self::byte_count)].
    ///
    /// `channels` is the [`channel_hash`](crate::bytes::channel_hash) of inputs and outputs, or 0.
    ///
    /// # Errors
    /// [`BytesError::Parameters`] as for [`Perceptron::new`](crate::Perceptron::new), [`BytesError::Buffer`].
    /// Then nothing is written.
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

    /// The layout hash of the numbers of inputs and outputs, and of the slope.
    pub fn layout_hash(inputs: usize, outputs: usize, slope: f32) -> u64 {
        PerceptronModel { inputs, outputs, slope }.hash()
    }

    /// Compares shape and slope with those of the caller.
    ///
    /// # Errors
    /// [`BytesError::Mismatch`].
    pub fn expect(&self, inputs: usize, outputs: usize, slope: f32) -> Result<(), BytesError> {
        self.expect_shape(&PerceptronModel { inputs, outputs, slope })
    }

    /// Number of inputs.
    pub const fn inputs(&self) -> usize {
        self.shape.inputs
    }

    /// Number of outputs.
    pub const fn outputs(&self) -> usize {
        self.shape.outputs
    }

    /// The slope of the logistic function.
    pub const fn slope(&self) -> f32 {
        self.shape.slope
    }
}

impl<'a> Shape<'a> for PerceptronModel {
    type Number = f32;

    const KIND: Kind = Kind::Perceptron;

    fn read(words: [u32; SHAPE], content: &'a [u8]) -> Result<(Self, &'a [u8]), BytesError> {
        let [inputs, outputs, slope, ..] = words;
        check_unused(&words, 3)?;
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
