//! The bytes of a network of any kind.

use bytemuck::AnyBitPattern;

use crate::bytes::error::{BytesError, Field};
use crate::bytes::frame::{Frame, Kind, SHAPE, frame_len, layout_hash};
use crate::error::Error;

/// A number that is stored as a parameter.
pub trait Number: AnyBitPattern {
    /// Its little-endian bytes.
    type Bytes: Copy + IntoIterator<Item = u8>;
    /// Splits bytes into numbers.
    fn chunks(bytes: &[u8]) -> &[Self::Bytes];
    /// Decodes a number.
    fn decode(bytes: Self::Bytes) -> Self;
    /// Encodes a number.
    fn encode(self) -> Self::Bytes;
}

impl Number for f32 {
    type Bytes = [u8; 4];

    fn chunks(bytes: &[u8]) -> &[[u8; 4]] {
        bytes.as_chunks().0
    }

    fn decode(bytes: [u8; 4]) -> Self {
        Self::from_le_bytes(bytes)
    }

    fn encode(self) -> [u8; 4] {
        self.to_le_bytes()
    }
}

impl Number for i16 {
    type Bytes = [u8; 2];

    fn chunks(bytes: &[u8]) -> &[[u8; 2]] {
        bytes.as_chunks().0
    }

    fn decode(bytes: [u8; 2]) -> Self {
        Self::from_le_bytes(bytes)
    }

    fn encode(self) -> [u8; 2] {
        self.to_le_bytes()
    }
}

/// The shape of a kind of network, as its bytes store it.
pub trait Shape<'a>: Sized {
    /// The number of the kind.
    const KIND: Kind;
    /// The type of a parameter.
    type Number: Number;
    /// Reads a shape from its words and the content after the head. Returns it with the bytes of the parameters.
    ///
    /// # Errors
    /// The first fault.
    fn read(words: [u32; SHAPE], content: &'a [u8]) -> Result<(Self, &'a [u8]), BytesError>;
    /// The words of the shape.
    fn words(&self) -> [u32; SHAPE];
    /// Number of bytes of a network of this shape.
    fn byte_count(&self) -> usize;
    /// Checks the shape and the parameters, which `value` decodes.
    ///
    /// # Errors
    /// The first fault.
    fn check<T: Copy>(&self, parameters: &[T], value: impl Fn(T) -> Self::Number + Copy) -> Result<(), Error>;

    /// The layout hash.
    fn hash(&self) -> u64 {
        layout_hash(Self::KIND, &self.words())
    }

    /// Checks and writes a network.
    ///
    /// # Errors
    /// [`BytesError::Parameters`] or [`BytesError::Buffer`].
    fn write(&self, channels: u64, parameters: &[Self::Number], out: &mut [u8]) -> Result<(), BytesError> {
        self.check(parameters, |p| p)?;
        let bytes = parameters.iter().flat_map(|p| p.encode());
        Frame::write(Self::KIND, &self.words(), channels, size_of_val(parameters), bytes, out)
    }
}

/// The checked bytes of a trained network. Its parameters are used in place.
///
/// Use it by the names of its kinds: [`LeakyNetworkBytes`](crate::bytes::LeakyNetworkBytes),
/// [`QuantizedNetworkBytes`](crate::bytes::QuantizedNetworkBytes), [`CtrnnBytes`](crate::bytes::CtrnnBytes),
/// [`PerceptronBytes`](crate::bytes::PerceptronBytes) and [`BlockNetworkBytes`](crate::bytes::BlockNetworkBytes).
#[derive(Clone, Copy, Debug)]
pub struct NetworkBytes<'a, S> {
    pub(crate) shape: S,
    channels: u64,
    parameters: &'a [u8],
}

impl<'a, S: Shape<'a>> NetworkBytes<'a, S> {
    /// Reads and checks the bytes of a network: the format, the checksum, the layout and every parameter.
    ///
    /// # Errors
    /// The first fault: [`BytesError::Magic`], [`BytesError::Length`], [`BytesError::Mismatch`], [`BytesError::Word`] or
    /// [`BytesError::Parameters`].
    pub fn read(bytes: &'a [u8]) -> Result<Self, BytesError> {
        let Frame { shape, channels, content } = Frame::open(S::KIND, bytes)?;
        let (shape, parameters) = S::read(shape, content)?;
        let (expected, found) = (shape.byte_count(), bytes.len());
        if expected != found {
            return Err(BytesError::Length { expected, found });
        }
        shape.check(S::Number::chunks(parameters), S::Number::decode)?;
        Ok(Self { shape, channels, parameters })
    }

    /// Compares the channels with those of the caller, by their [`channel_hash`](crate::bytes::channel_hash).
    ///
    /// # Errors
    /// [`BytesError::Mismatch`].
    pub fn expect_channels(&self, expected: u64) -> Result<(), BytesError> {
        Field::Channels.check(expected, self.channels)
    }

    /// The [`channel_hash`](crate::bytes::channel_hash) of inputs and outputs, 0 if unspecified.
    pub const fn channels(&self) -> u64 {
        self.channels
    }

    /// The parameters in place.
    ///
    /// # Errors
    /// [`BytesError::Misaligned`] and [`BytesError::BigEndian`]. Then use [`copy_parameters`](Self::copy_parameters).
    pub fn parameters(&self) -> Result<&'a [S::Number], BytesError> {
        if cfg!(target_endian = "big") {
            return Err(BytesError::BigEndian);
        }
        let alignment = align_of::<S::Number>();
        // Their number was checked, so only the alignment can be wrong.
        bytemuck::try_cast_slice(self.parameters)
            .map_err(|_| BytesError::Misaligned { remainder: self.parameters.as_ptr().addr() % alignment, alignment })
    }

    /// Copies the parameters into a buffer of the same length.
    ///
    /// # Errors
    /// [`BytesError::Buffer`]. Then nothing is copied.
    pub fn copy_parameters(&self, out: &mut [S::Number]) -> Result<(), BytesError> {
        let values = S::Number::chunks(self.parameters);
        let (expected, found) = (values.len(), out.len());
        if expected != found {
            return Err(BytesError::Buffer { expected, found });
        }
        out.iter_mut().zip(values).for_each(|(to, bytes)| *to = S::Number::decode(*bytes));
        Ok(())
    }

    /// Compares the layout with that of the caller.
    pub(crate) fn expect_shape(&self, expected: &impl Shape<'a>) -> Result<(), BytesError> {
        Field::Layout.check(expected.hash(), self.shape.hash())
    }
}

/// Number of bytes of a network with this number of parameters of one type. Saturates.
pub(crate) const fn byte_count<N>(parameters: usize) -> usize {
    frame_len(parameters.saturating_mul(size_of::<N>()))
}
