//! Errors of reading and writing the bytes of a controller.

use core::fmt;

use crate::error::Error;

/// A field of the head that has to agree with something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Field {
    /// The version of the format, compared with that of this program.
    Version,
    /// The CRC-32 at the end, compared with that of the bytes.
    Checksum,
    /// The number of the kind of controller.
    Kind,
    /// The stored layout hash, compared with that of kind and shape.
    LayoutHash,
    /// The hash of the layout, compared with that of the caller.
    Layout,
    /// The hash of the channels, compared with that of the caller.
    Channels,
}

/// A table of words in the bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// The eight words of the shape.
    Shape,
    /// The description of groups and blocks.
    Description,
}

/// An error of reading or writing the bytes of a controller.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BytesError {
    /// Fewer or more bytes than the format or the head requires.
    Length {
        /// Required number of bytes.
        expected: usize,
        /// Number of bytes.
        found: usize,
    },
    /// A beginning that no controller has.
    Magic {
        /// The first bytes.
        found: [u8; 8],
    },
    /// Damaged bytes, or bytes of another version, kind, layout or robot.
    Mismatch {
        /// The field that differs.
        field: Field,
        /// Its expected value.
        expected: u64,
        /// Its value.
        found: u64,
    },
    /// A word with an invalid value.
    Word {
        /// The table of the word.
        table: Table,
        /// Its index in the table.
        word: usize,
        /// Its value.
        found: u32,
    },
    /// Bytes at an address where the processor cannot use their numbers in place.
    Misaligned {
        /// Remainder of the address.
        remainder: usize,
        /// Required divisor of the address.
        alignment: usize,
    },
    /// A big-endian processor, which cannot use the numbers in place.
    BigEndian,
    /// A buffer of the wrong length.
    Buffer {
        /// Required length.
        expected: usize,
        /// Length of the buffer.
        found: usize,
    },
    /// An invalid layout or parameter.
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
