//! The common frame of all binary formats. It consists of a header, the content and a checksum.

use farsa_num::{Digest, crc32};

use crate::bytes::error::{BytesError, Field};

/// A wrapper for [`include_bytes!`] that aligns the bytes such that their numbers can be used in place.
///
/// ```
/// # const LAYOUT: farsa_nn::LeakyLayout = farsa_nn::LeakyLayout::new(1, 1, 1);
/// # macro_rules! include_bytes { ($name:literal) => { &[0; farsa_nn::bytes::LeakyNetworkBytes::byte_count(LAYOUT)] } }
/// use farsa_nn::bytes::{Aligned, LeakyNetworkBytes};
///
/// // A file of another length does not compile.
/// static CHAMPION: Aligned<[u8; LeakyNetworkBytes::byte_count(LAYOUT)]> = Aligned(*include_bytes!("champion.farsa"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(8))]
pub struct Aligned<B>(
    /// The aligned bytes.
    pub B,
);

/// The first bytes.
const MAGIC: [u8; 8] = *b"FARSA-NN";
/// Increases when the meaning of a byte changes.
const VERSION: u32 = 1;
/// Number of words of a shape, for all kinds. Unused words are 0.
pub(crate) const SHAPE: usize = 8;
/// Magic, version, kind, length, length of the parameters, shape, layout hash, channel hash.
const HEAD: usize = 8 + 4 * 4 + 4 * SHAPE + 8 + 8;
const CHECKSUM: usize = 4;

/// The kinds of controllers and their numbers in the binary format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A leaky network with floating-point parameters.
    LeakyNetwork = 1,
    /// A leaky network with integer parameters.
    QuantizedNetwork = 2,
    /// A continuous-time network.
    Ctrnn = 3,
    /// A layer of logistic units.
    Perceptron = 4,
    /// A block network.
    BlockNetwork = 5,
}

/// The parts of undamaged bytes. The kind defines the meaning of shape and content.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<'a> {
    pub(crate) shape: [u32; SHAPE],
    pub(crate) channels: u64,
    pub(crate) content: &'a [u8],
}

/// Number of bytes of a controller with this number of bytes of parameters. Saturates.
pub(crate) const fn frame_len(parameters: usize) -> usize {
    parameters.saturating_add(HEAD + CHECKSUM)
}

/// A count as a word. Counts beyond 32 bits saturate: no slice of parameters is so long.
pub(crate) fn word(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// Checks that the words from this index on, which the kind does not use, are 0.
pub(crate) fn check_unused(words: &[u32; SHAPE], first: usize) -> Result<(), BytesError> {
    match words.iter().enumerate().skip(first).find(|(_, found)| **found != 0) {
        Some((word, found)) => Err(BytesError::shape(word, *found)),
        None => Ok(()),
    }
}

/// A variant by its number in a word of the shape.
pub(crate) fn variant<T: Copy>(variants: &[T], word: usize, found: u32) -> Result<T, BytesError> {
    variants.get(found as usize).copied().ok_or(BytesError::shape(word, found))
}

/// A finite number in a word of the shape.
pub(crate) fn finite(word: usize, found: u32) -> Result<f32, BytesError> {
    let value = f32::from_bits(found);
    if value.is_finite() { Ok(value) } else { Err(BytesError::shape(word, found)) }
}

/// Computes a hash of the names of all inputs and outputs in their order.
///
/// The hash detects controllers for a different body or for sensors in a different order.
///
/// ```
/// use farsa_nn::bytes::channel_hash;
///
/// assert_ne!(channel_hash(["left", "right"], ["wheel"]), channel_hash(["right", "left"], ["wheel"]));
/// ```
pub fn channel_hash<N: AsRef<str>>(
    inputs: impl IntoIterator<Item = N>,
    outputs: impl IntoIterator<Item = impl AsRef<str>>,
) -> u64 {
    let mut digest = Digest::new();
    // No text holds such bytes: they end a name, and all names of a side.
    let mut add = |name: &str| {
        digest.add_bytes(name.as_bytes());
        digest.add_bytes(&[0xFF]);
    };
    inputs.into_iter().for_each(|name| add(name.as_ref()));
    add("");
    outputs.into_iter().for_each(|name| add(name.as_ref()));
    digest.finish()
}

/// The layout hash: a hash of the kind and the shape.
pub(crate) fn layout_hash(kind: Kind, shape: &[u32; SHAPE]) -> u64 {
    let mut digest = Digest::new();
    digest.add_bytes(&(kind as u32).to_le_bytes());
    for word in shape {
        digest.add_bytes(&word.to_le_bytes());
    }
    digest.finish()
}

impl<'a> Frame<'a> {
    /// Splits the bytes of a controller of this kind and checks them.
    pub(crate) fn open(kind: Kind, bytes: &'a [u8]) -> Result<Self, BytesError> {
        let mut reader = Reader { bytes, len: bytes.len() };
        // Bytes with another beginning are foreign, however few.
        let magic = reader.array()?;
        if magic != MAGIC {
            return Err(BytesError::Magic { found: magic });
        }
        Field::Version.check(VERSION.into(), reader.word()?.into())?;
        let (found_kind, len, content_len) = (reader.word()?, reader.word()? as usize, reader.word()? as usize);
        if len != bytes.len() {
            return Err(BytesError::Length { expected: len, found: bytes.len() });
        }
        let mut shape = [0; SHAPE];
        for word in &mut shape {
            *word = reader.word()?;
        }
        let (hash, channels) = (u64::from_le_bytes(reader.array()?), u64::from_le_bytes(reader.array()?));
        // `split_last_chunk` checks twice, and not every compiler proves the second check: a panic would remain.
        let split = reader.bytes.len().checked_sub(CHECKSUM).and_then(|end| reader.bytes.split_at_checked(end));
        let Some((content, checksum)) = split.and_then(|(rest, last)| Some((rest, last.first_chunk::<CHECKSUM>()?)))
        else {
            return Err(BytesError::Length { expected: frame_len(0), found: bytes.len() });
        };
        // The checksum covers the rest, so it comes first.
        let (checked, _) = bytes.split_at(bytes.len().saturating_sub(CHECKSUM));
        Field::Checksum.check(crc32(checked).into(), u32::from_le_bytes(*checksum).into())?;
        Field::Kind.check(kind as u64, found_kind.into())?;
        if content.len() != content_len {
            return Err(BytesError::Length { expected: frame_len(content_len), found: bytes.len() });
        }
        Field::LayoutHash.check(layout_hash(kind, &shape), hash)?;
        Ok(Self { shape, channels, content })
    }

    /// Fills `out`, whose length must be [`frame_len`] of this number of bytes of content.
    pub(crate) fn write(
        kind: Kind,
        shape: &[u32; SHAPE],
        channels: u64,
        content_len: usize,
        content: impl Iterator<Item = u8>,
        out: &mut [u8],
    ) -> Result<(), BytesError> {
        let (expected, found) = (frame_len(content_len), out.len());
        // A length beyond the head's 32 bits exceeds any buffer with such a head.
        let Some(len) = u32::try_from(expected).ok().filter(|_| expected == found) else {
            return Err(BytesError::Buffer { expected, found });
        };
        let (checked, checksum) = out.split_at_mut(expected - CHECKSUM);
        let hash = layout_hash(kind, shape).to_le_bytes();
        let head = [VERSION, kind as u32, len, content_len as u32];
        let words = head.into_iter().chain(*shape).map(u32::to_le_bytes);
        let bytes = MAGIC.into_iter().chain(words.flatten()).chain(hash).chain(channels.to_le_bytes());
        for (to, byte) in checked.iter_mut().zip(bytes.chain(content)) {
            *to = byte;
        }
        checksum.copy_from_slice(&crc32(checked).to_le_bytes());
        Ok(())
    }
}

/// The unread bytes.
struct Reader<'a> {
    bytes: &'a [u8],
    len: usize,
}

impl Reader<'_> {
    fn array<const N: usize>(&mut self) -> Result<[u8; N], BytesError> {
        let short = BytesError::Length { expected: frame_len(0), found: self.len };
        let (array, rest) = self.bytes.split_first_chunk::<N>().ok_or(short)?;
        self.bytes = rest;
        Ok(*array)
    }

    fn word(&mut self) -> Result<u32, BytesError> {
        self.array().map(u32::from_le_bytes)
    }
}
