//! Implementations of the traits of the `rand` ecosystem for streams.

use core::convert::Infallible;

use rand_core::{SeedableRng, TryRng};

use crate::philox::Stream;

/// Words are those of [`Stream::next_u32`] and [`Stream::next_u64`]. Bytes are words in little endian, the last one
/// truncated.
///
/// Not for cryptography.
impl TryRng for Stream {
    type Error = Infallible;

    #[inline]
    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok(self.next_u32())
    }

    #[inline]
    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(self.next_u64())
    }

    fn try_fill_bytes(&mut self, out: &mut [u8]) -> Result<(), Infallible> {
        for bytes in out.chunks_mut(4) {
            for (to, byte) in bytes.iter_mut().zip(self.next_u32().to_le_bytes()) {
                *to = byte;
            }
        }
        Ok(())
    }
}

/// The seed is that of the inherent [`Stream::from_seed`] as bytes in little endian, and `seed_from_u64` is that
/// function.
impl SeedableRng for Stream {
    type Seed = [u8; 8];

    #[inline]
    fn from_seed(seed: [u8; 8]) -> Self {
        Self::from_seed(u64::from_le_bytes(seed))
    }

    #[inline]
    fn seed_from_u64(seed: u64) -> Self {
        Self::from_seed(seed)
    }
}
