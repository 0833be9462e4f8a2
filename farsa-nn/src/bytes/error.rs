//! Errors of the binary formats.

use core::fmt;

use crate::error::Error;

/// A field of the header compared with an expected value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Field {
    /// Version of the format. The program must support it.
    Version,
    /// CRC-32 at the end. It must match the preceding bytes.
    Checksum,
    /// Number of the kind of controller.
    Kind,
    /// Stored hash of the layout. It must match the kind and the shape.
    LayoutHash,
    /// Hash of the layout. It must equal the hash that the caller expects.
    Layout,
    /// Hash of the channels. It must equal the hash that the caller expects.
    Channels,
}

/// A table of words in a binary format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// Eight words that describe the shape.
    Shape,
    /// Description of the groups and blocks.
    Description,
}

/// An error that occurs when a controller is read or written in its binary format.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BytesError {
    /// The number of bytes differs from that required by the format or the header.
    Length {
        /// Required number of bytes.
        expected: usize,
        /// Actual number of bytes.
        found: usize,
    },
    /// The first bytes are not those of a controller.
    Magic {
        /// The first eight bytes.
        found: [u8; 8],
    },
    /// The bytes are damaged, or they belong to a different version, kind, layout or robot.
    Mismatch {
        /// Field that differs.
        field: Field,
        /// Expected value of the field.
        expected: u64,
        /// Actual value of the field.
        found: u64,
    },
    /// A word has an invalid value.
    Word {
        /// Table that contains the word.
        table: Table,
        /// Index of the word in the table.
        word: usize,
        /// Invalid value.
        found: u32,
    },
    /// The numbers cannot be used in place, because the address of the bytes is not aligned.
    Misaligned {
        /// Remainder of the address when divided by the alignment.
        remainder: usize,
        /// Required alignment.
        alignment: usize,
    },
    /// The numbers cannot be used in place, because the processor is big-endian.
    BigEndian,
    /// A buffer has the wrong length.
    Buffer {
        /// Required length of the buffer.
        expected: usize,
        /// Length of the buffer.
        found: usize,
    },
    /// The layout or a parameter is invalid.
    Parameters(Error),
}

impl BytesError {
    /// An invalid word of the shape.
    pub(crate) const fn shape(word: usize, found: u32) -> Self {
        Self::Word { table: Table::Shape, word, found }
    }
}

impl Field {
    /// Compares the value of the field with the expected one.
    pub(crate) fn check(self, expected: u64, found: u64) -> Result<(), BytesError> {
        if expected == found { Ok(()) } else { Err(BytesError::Mismatch { field: self, expected, found }) }
    }

    fn fmt_mismatch(self, expected: u64, found: u64, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Version => write!(f, "version {found} of the format, this program reads {expected}"),
            Self::Checksum => write!(f, "damaged: checksum {found:08x} where the bytes have {expected:08x}"),
            Self::Kind => write!(f, "a controller of kind {found} where {expected} is asked for"),
            Self::LayoutHash => write!(f, "layout hash {found:016x} where the shape has {expected:016x}"),
            Self::Layout => write!(f, "a controller of layout {found:016x} where {expected:016x} is asked for"),
            Self::Channels => write!(f, "a controller for channels {found:016x} where {expected:016x} is asked for"),
        }
    }
}

impl fmt::Display for BytesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Length { expected, found } => write!(f, "{found} bytes where the controller has {expected}"),
            Self::Magic { found } => {
                write!(f, "no controller: begins with \"{}\", not \"FARSA-NN\"", found.escape_ascii())
            }
            Self::Mismatch { field, expected, found } => field.fmt_mismatch(expected, found, f),
            Self::Word { table, word, found } => {
                let table = match table {
                    Table::Shape => "shape",
                    Table::Description => "description",
                };
                write!(f, "number {word} of the {table} is {found}, which no such controller has")
            }
            Self::Misaligned { remainder, alignment } => write!(
                f,
                "the bytes lie {remainder} beyond a multiple of {alignment}: wrap them in Aligned, or copy the parameters"
            ),
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
