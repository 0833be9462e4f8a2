//! Name, experiments and ranks of a call of the command.

use std::rc::Rc;

use crate::ranks::exchange::Exchange;
use crate::run::laboratory::Laboratory;

/// A call of the command.
pub(crate) struct Invocation<'e, 'a> {
    /// Name of the program.
    pub(crate) program: &'a str,
    pub(crate) laboratory: &'a Laboratory<'e>,
    pub(crate) quiet: bool,
    /// Ranks with the same command.
    pub(crate) exchange: Rc<Exchange<'e>>,
    /// Number of ranks that share the processors of this one.
    pub(crate) sharing: usize,
}
