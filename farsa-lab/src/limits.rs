//! Limits on the sizes of a run.

/// Limits that a plan carries, so that tests can lower them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Limits {
    /// Bytes of the largest `record.bin`. A run ends with an error before its record cannot be read back.
    pub(crate) record_bytes: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { record_bytes: 1 << 32 }
    }
}
