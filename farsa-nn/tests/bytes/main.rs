//! Controllers as bytes: only written bytes are read.

mod block;
mod ctrnn;
mod leaky;
mod perceptron;
mod quantized;

use farsa_nn::bytes::{
    Aligned, BlockNetworkBytes, BytesError, CtrnnBytes, Field, LeakyNetworkBytes, PerceptronBytes,
    QuantizedNetworkBytes,
};
use farsa_num::{Digest, crc32};

/// Where the parameters begin.
const HEAD: usize = 72;

/// Rewrites the checksum, so that the fault is not damage.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let end = bytes.len() - 4;
    let checksum = crc32(&bytes[..end]);
    bytes[end..].copy_from_slice(&checksum.to_le_bytes());
    bytes
}

/// The bytes with other ones at a place, and the checksum of these.
fn with(bytes: &[u8], place: usize, new: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes[place..place + new.len()].copy_from_slice(new);
    sealed(bytes)
}

/// The same with a forged layout hash.
fn with_hash(bytes: &[u8], place: usize, word: u32) -> Vec<u8> {
    let mut bytes = with(bytes, place, &word.to_le_bytes());
    let mut digest = Digest::new();
    digest.add_bytes(&bytes[12..16]);
    digest.add_bytes(&bytes[24..56]);
    bytes[56..64].copy_from_slice(&digest.finish().to_le_bytes());
    sealed(bytes)
}

fn digest(bytes: &[u8]) -> u64 {
    let mut digest = Digest::new();
    digest.add_bytes(bytes);
    digest.finish()
}

/// Checks that this reader rejects every flipped bit, every truncation and an extra byte.
fn all_damage_is_refused(bytes: &[u8], refused: impl Fn(&[u8]) -> BytesError) {
    let mut damaged = bytes.to_vec();
    for at in 0..8 * bytes.len() {
        damaged[at / 8] ^= 1 << (at % 8);
        let error = refused(&damaged);
        let expected = match at / 8 {
            0..8 => matches!(error, BytesError::Magic { .. }),
            8..12 => matches!(error, BytesError::Mismatch { field: Field::Version, .. }),
            16..20 => matches!(error, BytesError::Length { .. }),
            _ => matches!(error, BytesError::Mismatch { field: Field::Checksum, .. }),
        };
        assert!(expected, "bit {at}: {error}");
        damaged[at / 8] ^= 1 << (at % 8);
    }
    for len in 0..bytes.len() {
        let error = refused(&bytes[..len]);
        assert!(matches!(error, BytesError::Length { found, .. } if found == len), "{len} bytes: {error}");
    }
    let longer = [bytes, &[0]].concat();
    assert_eq!(refused(&longer), BytesError::Length { expected: bytes.len(), found: bytes.len() + 1 });
}

/// A valid head before any bytes, with an optional checksum.
fn after_a_head(head: &[u8], rest: &[u8], seal: bool) -> Vec<u8> {
    let mut whole = [&head[..HEAD], rest].concat();
    if seal {
        let len = whole.len() as u32 + 4;
        whole[16..20].copy_from_slice(&len.to_le_bytes());
        whole.extend([0; 4]);
        whole = sealed(whole);
    }
    whole
}

/// Bytes of each kind, in the order of their numbers.
fn kinds() -> [Vec<u8>; 5] {
    let [leaky, quantized] = [leaky::champion().0.to_vec(), quantized::champion().0.to_vec()];
    [leaky, quantized, ctrnn::agent().0.to_vec(), perceptron::reflex().0.to_vec(), block::modulated().0.to_vec()]
}

#[test]
fn each_kind_is_read_as_itself_alone() {
    let kinds = kinds();
    for (at, bytes) in kinds.iter().enumerate() {
        let found = at as u64 + 1;
        let errors = [
            LeakyNetworkBytes::read(bytes).err(),
            QuantizedNetworkBytes::read(bytes).err(),
            CtrnnBytes::read(bytes).err(),
            PerceptronBytes::read(bytes).err(),
            BlockNetworkBytes::read(bytes).err(),
        ];
        for (expected, error) in (1..).zip(errors) {
            assert_eq!(
                error,
                (expected != found).then_some(BytesError::Mismatch { field: Field::Kind, expected, found })
            );
        }
    }
}

/// The bytes stay the same on every machine, because boards store them.
#[test]
fn the_bytes_of_each_kind_do_not_change() {
    let kinds = kinds();
    assert_eq!(
        kinds.map(|bytes| digest(&bytes)).map(|hash| format!("{hash:016x}")),
        ["7a917e2c3a070d00", "9f6fbfbd8ded40f7", "7211fd8b188cb3d5", "4f3aa8da9cbc62a3", "d674ffcabacd078a"]
    );
}

/// The result of using parameters in place on this processor, at an offset from a multiple of eight.
fn placement(offset: usize, alignment: usize) -> Result<(), BytesError> {
    match offset % alignment {
        _ if cfg!(target_endian = "big") => Err(BytesError::BigEndian),
        0 => Ok(()),
        remainder => Err(BytesError::Misaligned { remainder, alignment }),
    }
}

/// Parameters where they lie, or their copy on a processor that cannot use them there.
fn placed_or<'a, T>(placed: Result<&'a [T], BytesError>, bytes: &[u8], copy: &'a [T]) -> &'a [T] {
    match placed {
        Ok(placed) => {
            assert_eq!(placed.as_ptr().addr(), bytes.as_ptr().addr() + HEAD, "nothing is copied");
            placed
        }
        Err(error) => {
            assert_eq!(Err(error), placement(0, 1), "aligned");
            copy
        }
    }
}

/// Bytes at every remainder of eight, which reach up to eight bytes beyond the end.
fn at_every_place<const LEN: usize>(bytes: &[u8], mut look: impl FnMut(usize, &[u8])) {
    let mut shifted = Aligned([0; LEN]);
    for offset in 0..8 {
        shifted.0[offset..][..bytes.len()].copy_from_slice(bytes);
        look(offset, &shifted.0[offset..][..bytes.len()]);
    }
}
