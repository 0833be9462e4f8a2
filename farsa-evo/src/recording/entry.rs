//! A generation of a record.

/// What stands in a [`Record`](crate::Record) for one generation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordEntry<'r> {
    /// The champion of each population, then what was recorded.
    pub frame: &'r [u8],
    /// The state that the strategy was in afterwards, where it was saved.
    pub state: Option<&'r [u8]>,
}
