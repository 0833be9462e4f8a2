//! The limits before the motors.

use core::fmt;

use crate::Fault;

/// Limits the commands of a network to `N` motors, in range and in change per tick.
///
/// In a tick with a [`Fault`] the motors get the safe command at once, without a limit on its change. Later ticks start from
/// there, so no command jumps back. A NaN counts as the safe command.
///
/// ```
/// use firmware_adapters::{Fault, Guard};
///
/// # fn main() -> Result<(), firmware_adapters::GuardError> {
/// let mut guard = Guard::new([[0.0, 1.0]], [0.1], [0.5])?;
/// assert_eq!(guard.pass([0.9], Ok(())), [0.6]);
/// assert_eq!(guard.pass([0.9], Err(Fault::Read)), [0.5]);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Guard<const N: usize> {
    ranges: [[f32; 2]; N],
    changes: [f32; N],
    safe: [f32; N],
    last: [f32; N],
}

/// An invalid setting of a guard.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum GuardError {
    /// A range is empty or not finite.
    Range {
        /// Number of the motor.
        motor: usize,
        /// The range.
        range: [f32; 2],
    },
    /// A largest change is not above zero.
    Change {
        /// Number of the motor.
        motor: usize,
        /// The change.
        change: f32,
    },
    /// A safe command is outside its range.
    Safe {
        /// Number of the motor.
        motor: usize,
        /// The command.
        safe: f32,
    },
}

impl fmt::Display for GuardError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Range { motor, range: [from, to] } => {
                write!(f, "motor {motor}: the range {from} to {to} is empty or not finite")
            }
            Self::Change { motor, change } => {
                write!(f, "motor {motor}: a change of {change} per tick is not above zero")
            }
            Self::Safe { motor, safe } => write!(f, "motor {motor}: the safe command {safe} is outside its range"),
        }
    }
}

impl core::error::Error for GuardError {}

impl<const N: usize> Guard<N> {
    /// Builds a guard with the range, the largest change per tick and the safe command of every motor. It starts with the safe command.
    ///
    /// An infinite change is no limit.
    ///
    /// # Errors
    /// [`GuardError`] of the first invalid motor.
    pub fn new(ranges: [[f32; 2]; N], changes: [f32; N], safe: [f32; N]) -> Result<Self, GuardError> {
        for (motor, ((&range, &change), &safe)) in ranges.iter().zip(&changes).zip(&safe).enumerate() {
            let [from, to] = range;
            if !(from.is_finite() && to.is_finite() && from <= to) {
                return Err(GuardError::Range { motor, range });
            }
            if change.is_nan() || change <= 0.0 {
                return Err(GuardError::Change { motor, change });
            }
            if !(from..=to).contains(&safe) {
                return Err(GuardError::Safe { motor, safe });
            }
        }
        Ok(Self { ranges, changes, safe, last: safe })
    }

    /// Returns the commands for the outputs `y` of the network in a tick with this result.
    pub fn pass(&mut self, y: [f32; N], tick: Result<(), Fault>) -> [f32; N] {
        let limits = self.ranges.iter().zip(&self.changes).zip(&self.safe);
        for ((last, y), (([from, to], change), safe)) in self.last.iter_mut().zip(y).zip(limits) {
            *last = match tick {
                Err(_) => *safe,
                Ok(()) if y.is_nan() => *safe,
                // Not `clamp`, whose check of the limits could panic.
                Ok(()) => y.max(*last - change).min(*last + change).max(*from).min(*to),
            };
        }
        self.last
    }
}
