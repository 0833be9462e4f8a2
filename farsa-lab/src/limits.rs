//! Limits of files, memory and requests.

/// Most trials of a test.
pub(crate) const MAX_TRIALS: u32 = 100_000_000;

/// Limits of files, memory and requests. A plan carries them, so that tests can lower them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limits {
    /// `record.bin` \[bytes\]. A run ends with an error before its record cannot be read back.
    pub record_bytes: u64,
    /// State of a search in a checkpoint \[bytes\].
    pub state_bytes: u64,
    /// All recordings of a page or a picture \[bytes\]. No browser opens a page of 512 MB.
    pub recording_bytes: usize,
    /// Trials of a test, in all cases together.
    pub trials: usize,
    /// Cases of a protocol that are shown together.
    pub cases: usize,
    /// Input line of `farsa evaluate --stdin` \[bytes\].
    pub line_bytes: usize,
    /// Vectors in such a line.
    pub vectors: usize,
}

impl Limits {
    /// Default limits.
    pub const DEFAULT: Self = Self {
        record_bytes: 1 << 32,
        state_bytes: 256 << 20,
        recording_bytes: 256 << 20,
        trials: MAX_TRIALS as usize,
        cases: 60,
        line_bytes: 16 << 20,
        vectors: 65_536,
    };
}

impl Default for Limits {
    fn default() -> Self {
        Self::DEFAULT
    }
}
