//! What the readers of both formats carry along.

use crate::files::ModelFiles;
use crate::options::ReadOptions;
use crate::warnings::Warnings;

/// What both readers carry along.
pub(crate) struct Context<'o> {
    pub(crate) files: ModelFiles,
    pub(crate) options: &'o ReadOptions,
    pub(crate) warnings: Warnings,
    /// Elements met so far.
    pub(crate) elements: usize,
}
