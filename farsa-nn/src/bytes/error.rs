//! What can be wrong with the bytes of a controller before anything of them runs.

use core::fmt;

use crate::error::Error;

/// Why bytes are not the controller that was asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BytesError {
    /// There are fewer bytes, or more, than the format or its head says.
    Length {
        /// How many there should be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// They do not begin as a controller does.
    Magic {
        /// How they begin.
        found: [u8; 8],
    },
    /// They are of another version of the format.
    Version {
        /// The version that this program reads.
        expected: u32,
        /// Their version.
        found: u32,
    },
    /// They are not what was written.
    Checksum {
        /// CRC-32 of the bytes.
        expected: u32,
        /// CRC-32 that they end with.
        found: u32,
    },
    /// They are a controller of another kind.
    Kind {
        /// Number of the kind that was asked for.
        expected: u32,
        /// Number of their kind.
        found: u32,
    },
    /// A number of the shape has a value that no such controller has.
    Shape {
        /// Its place among the numbers of the shape.
        word: usize,
        /// Its value.
        found: u32,
    },
    /// A number of the description of groups and blocks has a value that no such controller has.
    Description {
        /// Its place among the numbers of the description.
        word: usize,
        /// Its value.
        found: u32,
    },
    /// The layout hash is not that of kind and shape.
    LayoutHash {
        /// Hash of kind and shape.
        expected: u64,
        /// Hash in the head.
        found: u64,
    },
    /// The layout is not the one that was asked for.
    OtherLayout {
        /// Hash of the layout that was asked for.
        expected: u64,
        /// Hash of theirs.
        found: u64,
    },
    /// The channels are not those that were asked for.
    OtherChannels {
        /// Hash of the channels that were asked for.
        expected: u64,
        /// Hash of theirs.
        found: u64,
    },
    /// The bytes do not begin where their numbers may lie, so that these cannot be used there.
    Misaligned {
        /// Remainder of their address.
        remainder: usize,
        /// What the address should be a multiple of.
        alignment: usize,
    },
    /// The processor is big-endian, so that their numbers cannot be used where they lie.
    BigEndian,
    /// The buffer for numbers or bytes has another length.
    Buffer {
        /// Length that is needed.
        expected: usize,
        /// Length of the buffer.
        found: usize,
    },
    /// The numbers are no parameters of such a network.
    Parameters(Error),
}

impl fmt::Display for BytesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Length { expected, found } => write!(f, "{found} bytes where the controller has {expected}"),
            Self::Magic { found } => {
                write!(f, "no controller: begins with \"{}\", not \"FARSA-NN\"", found.escape_ascii())
            }
            Self::Version { expected, found } => {
                write!(f, "version {found} of the format, this program reads {expected}")
            }
            Self::Checksum { expected, found } => {
                write!(f, "damaged: checksum {found:08x} where the bytes have {expected:08x}")
            }
            Self::Kind { expected, found } => write!(f, "a controller of kind {found} where {expected} is asked for"),
            Self::Shape { word, found } => {
                write!(f, "number {word} of the shape is {found}, which no such controller has")
            }
            Self::Description { word, found } => {
                write!(f, "number {word} of the description is {found}, which no such controller has")
            }
            Self::LayoutHash { expected, found } => {
                write!(f, "layout hash {found:016x} where the shape has {expected:016x}")
            }
            Self::OtherLayout { expected, found } => {
                write!(f, "a controller of layout {found:016x} where {expected:016x} is asked for")
            }
            Self::OtherChannels { expected, found } => {
                write!(f, "a controller for channels {found:016x} where {expected:016x} is asked for")
            }
            Self::Misaligned { remainder, alignment } => {
                write!(
                    f,
                    "the bytes lie {remainder} beyond a multiple of {alignment}: wrap them in Aligned, or copy the parameters"
                )
            }
            Self::BigEndian => f.write_str("the processor is big-endian: copy the parameters"),
            Self::Buffer { expected, found } => write!(f, "a buffer of length {found} where {expected} is needed"),
            Self::Parameters(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for BytesError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Parameters(error) => Some(error),
            _ => None,
        }
    }
}

impl From<Error> for BytesError {
    fn from(error: Error) -> Self {
        Self::Parameters(error)
    }
}
