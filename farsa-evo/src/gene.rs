//! The elements of genomes.

use alloc::vec::Vec;
use core::fmt::Debug;

/// A gene, either an integer of up to 16 bits, which encodes a value of a range, or a real number.
pub trait Gene: Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    /// Number of bytes that a saved gene takes.
    const BYTES: usize;

    /// Appends the gene to `bytes` in little-endian order.
    fn push_bytes(self, bytes: &mut Vec<u8>);

    /// Decodes a gene from exactly [`BYTES`](Self::BYTES) bytes. If the length is wrong or the bytes are not a valid
    /// gene, this returns `None`.
    fn from_bytes(bytes: &[u8]) -> Option<Self>;
}

impl Gene for u16 {
    const BYTES: usize = 2;

    fn push_bytes(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        bytes.try_into().ok().map(Self::from_le_bytes)
    }
}

/// A gene is finite.
impl Gene for f64 {
    const BYTES: usize = 8;

    fn push_bytes(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        bytes.try_into().ok().map(Self::from_le_bytes).filter(|gene| gene.is_finite())
    }
}
