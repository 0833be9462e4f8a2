//! The elements of genomes.

use alloc::vec::Vec;
use core::fmt::Debug;

/// A gene, either an integer of up to 16 bits, which encodes a value of a range, or a real number.
pub trait Gene: Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    /// Bytes of a gene that is saved.
    const BYTES: usize;

    /// Appends the gene, little-endian.
    fn push_bytes(self, bytes: &mut Vec<u8>);

    /// Returns the gene of these bytes, or `None` if they are not [`BYTES`](Self::BYTES) or not a gene.
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
