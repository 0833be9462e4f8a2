//! The binary format that is common to all kinds of networks.

use bytemuck::AnyBitPattern;

use crate::bytes::error::{BytesError, Field};
use crate::bytes::frame::{Frame, Kind, SHAPE, frame_len, layout_hash};
use crate::error::Error;

/// A number that can be stored as a parameter.
pub trait Number: AnyBitPattern {
    /// The number as little-endian bytes.
    type Bytes: Copy + IntoIterator<Item = u8>;
    /// Splits a slice of bytes into numbers.
    fn chunks(bytes: &[u8]) -> &[Self::Bytes];
    /// Decodes a number from its bytes.
    fn decode(bytes: Self::Bytes) -> Self;
    /// Encodes a number as bytes.
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

/// The shape of a network, as it is stored in the binary format.
pub trait Shape<'a>: Sized {
    /// The kind of network.
    const KIND: Kind;
    /// The type of the parameters.
    type Number: Number;
    /// Reads the shape from its words and from the content after the header. Returns the shape and the bytes of the
    /// parameters.
    ///
    /// # Errors
    /// Returns the first error that is found.
    fn read(words: &[u32; SHAPE], content: &'a [u8]) -> Result<(Self, &'a [u8]), BytesError>;
    /// Returns the words that encode the shape.
    fn words(&self) -> [u32; SHAPE];
    /// Returns the number of bytes of a network with this shape.
    fn byte_count(&self) -> usize;
    /// Checks the shape and the parameters. The closure `value` decodes a parameter.
    ///
    /// # Errors
    /// Returns the first error that is found.
    fn check<T: Copy>(&self, parameters: &[T], value: impl Fn(T) -> Self::Number + Copy) -> Result<(), Error>;

    /// Computes the hash of the layout.
    fn hash(&self) -> u64 {
        layout_hash(Self::KIND, &self.words())
    }

    /// Checks a network and writes it to `out`.
    ///
    /// # Errors
    /// Returns [`BytesError::Parameters`] or [`BytesError::Buffer`].
    fn write(&self, channels: u64, parameters: &[Self::Number], out: &mut [u8]) -> Result<(), BytesError> {
        self.check(parameters, |p| p)?;
        let bytes = parameters.iter().flat_map(|p| p.encode());
        Frame::write(Self::KIND, &self.words(), channels, size_of_val(parameters), bytes, out)
    }
}

/// A trained network in its binary format. The bytes have been checked, and the parameters are used in place.
///
/// Usually you use its aliases
/// [`LeakyNetworkBytes`](crate::bytes::LeakyNetworkBytes),
/// [`QuantizedNetworkBytes`](crate::bytes::QuantizedNetworkBytes), [`CtrnnBytes`](crate::bytes::CtrnnBytes),
/// [`PerceptronBytes`](crate::bytes::PerceptronBytes) and [`BlockNetworkBytes`](crate::bytes::BlockNetworkBytes).
#[derive(Clone, Copy, Debug)]
pub struct NetworkBytes<'a, S> {
    pub(crate) shape: S,
    channels: u64,
    parameters: &'a [u8],
}

impl<'a, S: Shape<'a>> NetworkBytes<'a, S> {
    /// Reads a network. The format, the checksum, the layout and all parameters are checked.
    ///
    /// # Errors
    /// Returns the first error found. This can be [`BytesError::Magic`], [`BytesError::Length`], [`BytesError::Mismatch`],
    /// [`BytesError::Word`] or [`BytesError::Parameters`].
    pub fn read(bytes: &'a [u8]) -> Result<Self, BytesError> {
        let Frame { shape, channels, content } = Frame::open(S::KIND, bytes)?;
        let (shape, parameters) = S::read(&shape, content)?;
        let (expected, found) = (shape.byte_count(), bytes.len());
        if expected != found {
            return Err(BytesError::Length { expected, found });
        }
        shape.check(S::Number::chunks(parameters), S::Number::decode)?;
        Ok(Self { shape, channels, parameters })
    }

    /// Checks that the channels are those of the caller by comparing their
    /// [`channel_hash`](crate::bytes::channel_hash).
    ///
    /// # Errors
    /// Returns [`BytesError::Mismatch`] if they differ.
    pub fn expect_channels(&self, expected: u64) -> Result<(), BytesError> {
        Field::Channels.check(expected, self.channels)
    }

    /// Gets the [`channel_hash`](crate::bytes::channel_hash) of the inputs and outputs, or 0 if it was not
    /// specified.
    pub const fn channels(&self) -> u64 {
        self.channels
    }

    /// Returns the parameters without copying them.
    ///
    /// # Errors
    /// Returns [`BytesError::Misaligned`] or [`BytesError::BigEndian`] if this is not possible. In this case, use
    /// [`copy_parameters`](Self::copy_parameters).
    pub fn parameters(&self) -> Result<&'a [S::Number], BytesError> {
        if cfg!(target_endian = "big") {
            return Err(BytesError::BigEndian);
        }
        let alignment = align_of::<S::Number>();
        // Their number was checked, so only the alignment can be wrong.
        bytemuck::try_cast_slice(self.parameters)
            .map_err(|_| BytesError::Misaligned { remainder: self.parameters.as_ptr().addr() % alignment, alignment })
    }

    /// Copies the parameters to a buffer of the same length.
    ///
    /// # Errors
    /// Returns [`BytesError::Buffer`] if the length differs. In this case nothing is copied.
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
