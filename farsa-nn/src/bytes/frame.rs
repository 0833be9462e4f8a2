//! What the bytes of all kinds of controllers have in common: a head, parameters, a checksum.

use bytemuck::AnyBitPattern;
use farsa_num::{Digest, crc32};

use crate::bytes::error::BytesError;

/// Bytes that lie where numbers may lie, for [`include_bytes!`].
///
/// ```
/// # const LAYOUT: farsa_nn::LeakyLayout = farsa_nn::LeakyLayout::new(1, 1, 1);
/// # macro_rules! include_bytes { ($name:literal) => { &[0; farsa_nn::bytes::LeakyNetworkBytes::byte_count(LAYOUT)] } }
/// use farsa_nn::bytes::{Aligned, LeakyNetworkBytes};
///
/// // Does not compile when the file has another length.
/// static CHAMPION: Aligned<[u8; LeakyNetworkBytes::byte_count(LAYOUT)]> = Aligned(*include_bytes!("champion.farsa"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(8))]
pub struct Aligned<B>(
    /// The bytes.
    pub B,
);

/// The first bytes.
const MAGIC: [u8; 8] = *b"FARSA-NN";
/// Grows when the meaning of a byte changes.
const VERSION: u32 = 1;
/// Numbers of a shape, the same for all kinds; what is not used is 0.
pub(crate) const SHAPE: usize = 8;
/// Magic, version, kind, length, length of the parameters, shape, layout hash, channel hash.
const HEAD: usize = 8 + 4 * 4 + 4 * SHAPE + 8 + 8;
const CHECKSUM: usize = 4;

/// The kinds of controllers by their numbers in the bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    LeakyNetwork = 1,
    QuantizedNetwork = 2,
    Ctrnn = 3,
    Perceptron = 4,
    BlockNetwork = 5,
}

/// A controller's bytes taken apart, whole and undamaged; what shape and parameters mean is the kind's business.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<'a> {
    pub(crate) shape: [u32; SHAPE],
    pub(crate) channels: u64,
    pub(crate) parameters: &'a [u8],
}

/// Number of bytes of a controller with so many bytes of parameters; saturates.
pub(crate) const fn frame_len(parameters: usize) -> usize {
    parameters.saturating_add(HEAD + CHECKSUM)
}

/// A count as a number of a shape. Those beyond 32 bits saturate: no slice of parameters is so long.
pub(crate) fn word(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// Nothing, if the layout hashes are the same.
pub(crate) fn same_layout(expected: u64, found: u64) -> Result<(), BytesError> {
    if expected == found { Ok(()) } else { Err(BytesError::OtherLayout { expected, found }) }
}

/// Nothing, if the channel hashes are the same.
pub(crate) fn same_channels(expected: u64, found: u64) -> Result<(), BytesError> {
    if expected == found { Ok(()) } else { Err(BytesError::OtherChannels { expected, found }) }
}

/// Parameters where they lie, as numbers.
pub(crate) fn placed<T: AnyBitPattern>(parameters: &[u8]) -> Result<&[T], BytesError> {
    if cfg!(target_endian = "big") {
        return Err(BytesError::BigEndian);
    }
    let alignment = align_of::<T>();
    // Their number was checked, so that alignment is all that can be wrong.
    bytemuck::try_cast_slice(parameters)
        .map_err(|_| BytesError::Misaligned { remainder: parameters.as_ptr().addr() % alignment, alignment })
}

/// Copies numbers into `out`, which must be as long.
pub(crate) fn copy<T>(values: impl ExactSizeIterator<Item = T>, out: &mut [T]) -> Result<(), BytesError> {
    let (expected, found) = (values.len(), out.len());
    if expected != found {
        return Err(BytesError::Buffer { expected, found });
    }
    out.iter_mut().zip(values).for_each(|(to, value)| *to = value);
    Ok(())
}

/// Parameters that are `f32` as numbers, wherever they lie.
pub(crate) fn values(parameters: &[u8]) -> impl ExactSizeIterator<Item = f32> + Clone + '_ {
    parameters.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes))
}

/// A fingerprint of what inputs and outputs are, by their names in their order.
///
/// A controller for another body, or for the same with its sensors in another order, has another.
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

/// The layout hash: of the kind and the shape.
pub(crate) fn layout_hash(kind: Kind, shape: &[u32; SHAPE]) -> u64 {
    let mut digest = Digest::new();
    digest.add_bytes(&(kind as u32).to_le_bytes());
    for word in shape {
        digest.add_bytes(&word.to_le_bytes());
    }
    digest.finish()
}

impl<'a> Frame<'a> {
    /// Takes bytes apart that are a controller of this kind.
    pub(crate) fn open(kind: Kind, bytes: &'a [u8]) -> Result<Self, BytesError> {
        let mut reader = Reader { bytes, len: bytes.len() };
        // Bytes that begin differently are none of ours, however few.
        let magic = reader.array()?;
        if magic != MAGIC {
            return Err(BytesError::Magic { found: magic });
        }
        let version = reader.word()?;
        if version != VERSION {
            return Err(BytesError::Version { expected: VERSION, found: version });
        }
        let (found_kind, len, parameters_len) = (reader.word()?, reader.word()? as usize, reader.word()? as usize);
        if len != bytes.len() {
            return Err(BytesError::Length { expected: len, found: bytes.len() });
        }
        let mut shape = [0; SHAPE];
        for word in &mut shape {
            *word = reader.word()?;
        }
        let (hash, channels) = (u64::from_le_bytes(reader.array()?), u64::from_le_bytes(reader.array()?));
        // `split_last_chunk` checks twice, and not every compiler sees that the second check holds: a panic would be left.
        let split = reader.bytes.len().checked_sub(CHECKSUM).and_then(|end| reader.bytes.split_at_checked(end));
        let Some((parameters, checksum)) = split.and_then(|(rest, last)| Some((rest, last.first_chunk::<CHECKSUM>()?)))
        else {
            return Err(BytesError::Length { expected: frame_len(0), found: bytes.len() });
        };
        // Nothing of what follows is believed before this.
        let (checked, _) = bytes.split_at(bytes.len().saturating_sub(CHECKSUM));
        let (expected, found) = (crc32(checked), u32::from_le_bytes(*checksum));
        if expected != found {
            return Err(BytesError::Checksum { expected, found });
        }
        if found_kind != kind as u32 {
            return Err(BytesError::Kind { expected: kind as u32, found: found_kind });
        }
        if parameters.len() != parameters_len {
            return Err(BytesError::Length { expected: frame_len(parameters_len), found: bytes.len() });
        }
        let expected = layout_hash(kind, &shape);
        if hash != expected {
            return Err(BytesError::LayoutHash { expected, found: hash });
        }
        Ok(Self { shape, channels, parameters })
    }

    /// Fills `out`, which must be as long as [`frame_len`] of the parameters says; `parameters` are numbers in their order.
    pub(crate) fn write<const N: usize>(
        kind: Kind,
        shape: &[u32; SHAPE],
        channels: u64,
        parameters: impl ExactSizeIterator<Item = [u8; N]>,
        out: &mut [u8],
    ) -> Result<(), BytesError> {
        Self::write_counted(kind, shape, channels, parameters.len(), parameters, out)
    }

    /// The same with so many parameters, for iterators that do not know their length.
    pub(crate) fn write_counted<const N: usize>(
        kind: Kind,
        shape: &[u32; SHAPE],
        channels: u64,
        count: usize,
        parameters: impl Iterator<Item = [u8; N]>,
        out: &mut [u8],
    ) -> Result<(), BytesError> {
        let parameters_len = count.saturating_mul(N);
        let (expected, found) = (frame_len(parameters_len), out.len());
        // More than the head can say is more than any buffer of it.
        let Some(len) = u32::try_from(expected).ok().filter(|_| expected == found) else {
            return Err(BytesError::Buffer { expected, found });
        };
        let (content, checksum) = out.split_at_mut(expected - CHECKSUM);
        let hash = layout_hash(kind, shape).to_le_bytes();
        let head = [VERSION, kind as u32, len, parameters_len as u32];
        let words = head.into_iter().chain(*shape).map(u32::to_le_bytes);
        let bytes = MAGIC.into_iter().chain(words.flatten()).chain(hash).chain(channels.to_le_bytes());
        for (to, byte) in content.iter_mut().zip(bytes.chain(parameters.flatten())) {
            *to = byte;
        }
        checksum.copy_from_slice(&crc32(content).to_le_bytes());
        Ok(())
    }
}

/// The bytes that are still to be read.
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
