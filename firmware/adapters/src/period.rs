//! Detection of late ticks.

use crate::Fault;

/// The period of the loop, compared with a clock that counts microseconds and may wrap.
#[derive(Clone, Copy, Debug)]
pub struct Period {
    length: u32,
    slack: u32,
    last: Option<u32>,
}

impl Period {
    /// Builds a period of `length` [us] with ticks up to `slack` [us] late.
    pub const fn new(length: u32, slack: u32) -> Self {
        Self { length, slack, last: None }
    }

    /// Registers the beginning of a tick at `now` [us].
    ///
    /// # Errors
    /// [`Fault::Late`]. The next tick is compared with this one.
    pub fn tick(&mut self, now: u32) -> Result<(), Fault> {
        let past = self.last.replace(now).map_or(0, |last| now.wrapping_sub(last));
        match past.saturating_sub(self.length) {
            by if by > self.slack => Err(Fault::Late { by }),
            _ => Ok(()),
        }
    }
}
