//! Wrappers that simulate broken sensors and motors.

#[cfg(feature = "alloc")]
use alloc::{vec, vec::Vec};
use core::ops::{Range, RangeBounds};

use crate::channel::{ChannelError, finite};
use crate::ports::Channels;
use crate::wrappers::wrap::{Filter, Wrapped, select};

/// Sets some channels to 0 and passes the others unchanged.
///
/// Note that the wrapped sensor is still read, and a wrapped motor is still driven with 0 on these channels.
pub type Lesioned<T, M> = Wrapped<T, Lesion, M>;

/// The silent channels of [`Lesioned`].
#[derive(Clone, Debug, PartialEq)]
pub struct Lesion {
    which: Range<usize>,
}

impl Filter for Lesion {
    #[inline]
    fn pass(&mut self, values: &[f32], passed: &mut [f32]) {
        for (channel, (p, &x)) in passed.iter_mut().zip(values).enumerate() {
            *p = if self.which.contains(&channel) { 0.0 } else { x };
        }
    }
}

#[cfg(feature = "alloc")]
impl<T: Channels> Lesioned<T, Vec<f32>> {
    /// Wraps a sensor or motor and silences a range of its channels. For example, `..` silences all channels and
    /// `3..=3` a single one.
    ///
    /// # Errors
    /// Returns [`ChannelError::Selection`] if the channels do not exist.
    pub fn new(inner: T, which: impl RangeBounds<usize>) -> Result<Self, ChannelError> {
        let memory = vec![0.0; inner.channels()];
        Self::new_in(inner, which, memory)
    }
}

impl<T: Channels, M: AsMut<[f32]>> Lesioned<T, M> {
    /// Wraps a sensor or motor like `new`, but uses the provided `memory` with one element per channel.
    ///
    /// # Errors
    /// Returns [`ChannelError::Selection`] if the channels do not exist, or [`ChannelError::Memory`] if the memory is
    /// too short.
    pub fn new_in(inner: T, which: impl RangeBounds<usize>, memory: M) -> Result<Self, ChannelError> {
        let which = select(&which, inner.channels())?;
        Wrapped::over(inner, Lesion { which }, memory)
    }
}

/// The value of a channel that is stuck.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum StuckAt {
    /// The last value before the channel got stuck. If it is stuck from the beginning, the first value of the episode
    /// is used.
    Last,
    /// A constant value.
    Value(f32),
}

/// Passes values unchanged until some of the channels get stuck.
pub type Stuck<T, M> = Wrapped<T, Sticking, M>;

/// The channels of [`Stuck`] and their state.
#[derive(Clone, Debug, PartialEq)]
pub struct Sticking {
    which: Range<usize>,
    at: StuckAt,
    after: u32,
    /// Ticks of this episode so far.
    ticks: u32,
    /// Broken during this episode by a call.
    broken: bool,
}

impl Filter for Sticking {
    #[inline]
    fn pass(&mut self, values: &[f32], passed: &mut [f32]) {
        let stuck = self.broken || self.ticks >= self.after;
        for (channel, (p, &x)) in passed.iter_mut().zip(values).enumerate() {
            *p = match self.at {
                StuckAt::Value(value) if stuck && self.which.contains(&channel) => value,
                StuckAt::Last if stuck && self.ticks > 0 && self.which.contains(&channel) => *p,
                _ => x,
            };
        }
        self.ticks = self.ticks.saturating_add(1);
    }
    fn rewind(&mut self) {
        self.ticks = 0;
        self.broken = false;
    }
}

#[cfg(feature = "alloc")]
impl<T: Channels> Stuck<T, Vec<f32>> {
    /// Wraps a sensor or motor. In each episode, a range of channels gets stuck after `after` ticks. Use 0 for channels
    /// that are stuck from the beginning and `u32::MAX` for channels that never get stuck.
    ///
    /// # Errors
    /// Returns [`ChannelError::Selection`] if the channels do not exist, or [`ChannelError::Value`] if the value is not
    /// finite.
    pub fn new(inner: T, which: impl RangeBounds<usize>, at: StuckAt, after: u32) -> Result<Self, ChannelError> {
        let memory = vec![0.0; inner.channels()];
        Self::new_in(inner, which, at, after, memory)
    }
}

impl<T: Channels, M: AsMut<[f32]>> Stuck<T, M> {
    /// Wraps a sensor or motor like `new`, but uses the provided `memory` with one element per channel.
    ///
    /// # Errors
    /// Returns [`ChannelError::Selection`] if the channels do not exist, [`ChannelError::Value`] if the value is not
    /// finite, or [`ChannelError::Memory`] if the memory is too short.
    pub fn new_in(
        inner: T,
        which: impl RangeBounds<usize>,
        at: StuckAt,
        after: u32,
        memory: M,
    ) -> Result<Self, ChannelError> {
        let which = select(&which, inner.channels())?;
        if let StuckAt::Value(value) = at {
            finite("value", value)?;
        }
        Wrapped::over(inner, Sticking { which, at, after, ticks: 0, broken: false }, memory)
    }
}

impl<T, M> Stuck<T, M> {
    /// Makes the channels stuck from the next tick until the end of the episode.
    pub fn stick(&mut self) {
        self.filter.broken = true;
    }
}
