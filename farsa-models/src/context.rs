//! Shared state of both readers.

use crate::files::ModelFiles;
use crate::options::ReadOptions;
use crate::warnings::Warnings;

/// Shared state of both readers.
pub(crate) struct Context<'o> {
    pub(crate) files: ModelFiles,
    pub(crate) options: &'o ReadOptions,
    pub(crate) warnings: Warnings,
    /// Elements met so far.
    pub(crate) elements: usize,
}
