//! Wrappers for broken sensors and motors.

#[cfg(feature = "alloc")]
use alloc::{vec, vec::Vec};
use core::ops::{Range, RangeBounds};

use crate::channel::{ChannelError, finite};
use crate::ports::Channels;
use crate::wrappers::wrap::{Filter, Wrapped, select, wrapper};

/// Passes 0 on for some channels and the others as they are.
///
/// A lesioned sensor is still read and a lesioned motor still driven: its channels get 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Lesioned<T, M>(Wrapped<T, Lesion, M>);

#[derive(Clone, Debug, PartialEq)]
struct Lesion {
    which: Range<usize>,
}

impl Filter for Lesion {
    fn pass(&mut self, values: &[f32], passed: &mut [f32]) {
        for (channel, (p, &x)) in passed.iter_mut().zip(values).enumerate() {
            *p = if self.which.contains(&channel) { 0.0 } else { x };
        }
    }
}

wrapper!(Lesioned);

#[cfg(feature = "alloc")]
impl<T: Channels> Lesioned<T, Vec<f32>> {
    /// Wraps a sensor or motor and silences the channels `which`: `..` for all, `3..=3` for one.
    ///
    /// # Errors
    /// [`ChannelError::Selection`] if there are no such channels.
    pub fn new(inner: T, which: impl RangeBounds<usize>) -> Result<Self, ChannelError> {
        let memory = vec![0.0; inner.channels()];
        Self::new_in(inner, which, memory)
    }
}

impl<T: Channels, M: AsMut<[f32]>> Lesioned<T, M> {
    /// Wraps a sensor or motor and silences the channels `which`, over the caller's `memory` [channels].
    ///
    /// # Errors
    /// [`ChannelError::Selection`] if there are no such channels, [`ChannelError::Memory`] if the memory is too short.
    pub fn new_in(inner: T, which: impl RangeBounds<usize>, memory: M) -> Result<Self, ChannelError> {
        let which = select(&which, inner.channels())?;
        Wrapped::new(inner, Lesion { which }, memory).map(Self)
    }
}

/// Where a stuck channel stays.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum StuckAt {
    /// At its value in the last tick before it got stuck. At the episode's first if it is stuck from the beginning.
    Last,
    /// At a given value.
    Value(f32),
}

/// Passes values on as they are until some of the channels get stuck.
#[derive(Clone, Debug, PartialEq)]
pub struct Stuck<T, M>(Wrapped<T, Sticking, M>);

#[derive(Clone, Debug, PartialEq)]
struct Sticking {
    which: Range<usize>,
    at: StuckAt,
    after: u32,
    /// Ticks of this episode so far.
    ticks: u32,
    /// Broken during this episode by a call.
    broken: bool,
}

impl Filter for Sticking {
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

wrapper!(Stuck);

#[cfg(feature = "alloc")]
impl<T: Channels> Stuck<T, Vec<f32>> {
    /// Wraps a sensor or motor whose channels `which` get stuck after `after` ticks of every episode, `..` for all
    /// channels, 0 for from the beginning, `u32::MAX` for never.
    ///
    /// # Errors
    /// [`ChannelError::Selection`] if there are no such channels, [`ChannelError::Value`] if the value is not finite.
    pub fn new(inner: T, which: impl RangeBounds<usize>, at: StuckAt, after: u32) -> Result<Self, ChannelError> {
        let memory = vec![0.0; inner.channels()];
        Self::new_in(inner, which, at, after, memory)
    }
}

impl<T: Channels, M: AsMut<[f32]>> Stuck<T, M> {
    /// Like `new`, over the caller's `memory` [channels].
    ///
    /// # Errors
    /// [`ChannelError::Selection`] if there are no such channels, [`ChannelError::Value`] if the value is not finite,
    /// [`ChannelError::Memory`] if the memory is too short.
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
        Wrapped::new(inner, Sticking { which, at, after, ticks: 0, broken: false }, memory).map(Self)
    }
}

impl<T, M> Stuck<T, M> {
    /// Makes the channels stick from the next tick to the end of this episode.
    pub fn stick(&mut self) {
        self.0.filter.broken = true;
    }
}
