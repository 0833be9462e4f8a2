//! Faults of a tick.

use core::fmt;

/// The reason for a safe command in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fault {
    /// A sensor did not answer.
    Read,
    /// A motor did not take its command.
    Write,
    /// The tick came later than its period allows.
    Late {
        /// The delay [us].
        by: u32,
    },
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read => f.write_str("a sensor did not answer"),
            Self::Write => f.write_str("a motor did not take its command"),
            Self::Late { by } => write!(f, "the tick came {by} us late"),
        }
    }
}

impl core::error::Error for Fault {}
