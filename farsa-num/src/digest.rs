//! Checksums of numbers and bytes. They detect accidental changes but do not protect against forgery.

/// A 64-bit hash of a sequence of values. It is used to check that two runs agree bit for bit.
///
/// Source: FNV-1a, \[Fowler2019\], 64 bits. Deviation: numbers are hashed as little-endian bytes. All NaNs are hashed
/// like the same NaN, because processors produce different bits for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(u64);

impl Digest {
    /// Creates the hash of an empty sequence.
    #[inline]
    pub const fn new() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }

    /// Adds a slice of bytes.
    #[inline]
    pub fn add_bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3);
        }
    }

    /// Adds the bits of a number. Note that -0.0 and 0.0 are different.
    #[inline]
    pub fn add_f32(&mut self, x: f32) {
        let bits = if x.is_nan() { 0x7FC0_0000 } else { x.to_bits() };
        self.add_bytes(&bits.to_le_bytes());
    }

    /// Adds the bits of all numbers in a slice.
    #[inline]
    pub fn add_f32s(&mut self, xs: &[f32]) {
        for &x in xs {
            self.add_f32(x);
        }
    }

    /// Adds the bits of a number. Note that -0.0 and 0.0 are different.
    #[inline]
    pub fn add_f64(&mut self, x: f64) {
        let bits = if x.is_nan() { 0x7FF8_0000_0000_0000 } else { x.to_bits() };
        self.add_bytes(&bits.to_le_bytes());
    }

    /// Adds the bits of all numbers in a slice.
    #[inline]
    pub fn add_f64s(&mut self, xs: &[f64]) {
        for &x in xs {
            self.add_f64(x);
        }
    }

    /// Adds an integer.
    #[inline]
    pub fn add_u64(&mut self, x: u64) {
        self.add_bytes(&x.to_le_bytes());
    }

    /// Gets the hash of all values that were added.
    #[inline]
    pub const fn finish(&self) -> u64 {
        self.0
    }
}

impl Default for Digest {
    fn default() -> Self {
        Self::new()
    }
}

/// Computes the CRC-32 of IEEE 802.3. This is the checksum of files and flash images.
///
/// Source: \[Koopman2002\] table 1, polynomial 0x04C11DB7 reflected, initial value and final inversion all ones. No
/// deviation.
#[inline]
pub const fn crc32(bytes: &[u8]) -> u32 {
    Crc32::new().with(bytes).finish()
}

/// An incremental version of [`crc32`], for bytes that are not available at once.
///
/// ```
/// use farsa_num::{Crc32, crc32};
///
/// assert_eq!(Crc32::new().with(b"1234").with(b"56789").finish(), crc32(b"123456789"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crc32(u32);

impl Crc32 {
    /// Creates the checksum of an empty sequence.
    #[inline]
    pub const fn new() -> Self {
        Self(u32::MAX)
    }

    /// Adds a slice of bytes.
    #[inline]
    #[must_use]
    pub const fn with(self, bytes: &[u8]) -> Self {
        let mut crc = self.0;
        let mut i = 0;
        while i < bytes.len() {
            crc = crc >> 8 ^ CRC_TABLE[((crc ^ bytes[i] as u32) & 0xFF) as usize];
            i += 1;
        }
        Self(crc)
    }

    /// Returns the checksum of all bytes that were added. You can continue to add bytes afterwards.
    #[inline]
    pub const fn finish(self) -> u32 {
        !self.0
    }
}

impl Default for Crc32 {
    fn default() -> Self {
        Self::new()
    }
}

const CRC_TABLE: [u32; 256] = {
    let mut table = [0; 256];
    let mut i = 0;
    while i < 256 {
        let mut crc = i as u32;
        let mut bit = 0;
        while bit < 8 {
            crc = crc >> 1 ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 };
            bit += 1;
        }
        table[i] = crc;
        i += 1;
    }
    table
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crc32_of_the_check_string() {
        assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
        assert_eq!(crc32(b""), 0);
        assert_eq!(crc32(b"The quick brown fox jumps over the lazy dog"), 0x414F_A339);
    }

    #[test]
    fn fnv_of_the_published_strings() {
        let of = |bytes: &[u8]| {
            let mut digest = Digest::new();
            digest.add_bytes(bytes);
            digest.finish()
        };
        assert_eq!(of(b""), 0xCBF2_9CE4_8422_2325);
        assert_eq!(of(b"a"), 0xAF63_DC4C_8601_EC8C);
        assert_eq!(of(b"foobar"), 0x8594_4171_F739_67E8);
    }

    #[test]
    fn numbers_enter_by_their_bits() {
        let of = |x: f32, y: f64| {
            let mut digest = Digest::new();
            digest.add_f32s(&[x]);
            digest.add_f64s(&[y]);
            digest.finish()
        };
        assert_ne!(of(0.0, 0.0), of(-0.0, 0.0));
        assert_ne!(of(0.0, 0.0), of(0.0, -0.0));
        assert_eq!(of(f32::NAN, f64::NAN), of(-f32::NAN, f64::from_bits(0x7FF0_0000_0000_0001)));
        let (mut integer, mut bytes) = (Digest::new(), Digest::new());
        integer.add_u64(0x0102_0304_0506_0708);
        bytes.add_bytes(&[8, 7, 6, 5, 4, 3, 2, 1]);
        assert_eq!(integer.finish(), bytes.finish());
    }
}
