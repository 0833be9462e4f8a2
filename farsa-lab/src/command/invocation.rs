//! The command as it was called: under which name, over which experiments, and with which ranks.

use std::rc::Rc;

use crate::ranks::exchange::Exchange;
use crate::run::laboratory::Laboratory;

/// The command as it was called.
pub(crate) struct Invocation<'e, 'a> {
    /// What the user calls this program.
    pub(crate) program: &'a str,
    pub(crate) laboratory: &'a Laboratory<'e>,
    pub(crate) quiet: bool,
    /// The ranks that were given the same command.
    pub(crate) exchange: Rc<Exchange<'e>>,
    /// How many of them share this one's processors.
    pub(crate) sharing: usize,
}
