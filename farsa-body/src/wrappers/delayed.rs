//! A wrapper that adds a delay.

#[cfg(feature = "alloc")]
use alloc::{vec, vec::Vec};

use crate::channel::ChannelError;
use crate::ports::{Channels, Motor, Sensor};
use crate::wrappers::wrap::room;

/// Delays the values of a sensor or motor by a number of ticks.
///
/// At the start of an episode, a sensor repeats its first value until the delay has passed. A motor is not driven
/// during this time, so the world keeps its commands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Delayed<T, M> {
    inner: T,
    ticks: usize,
    channels: usize,
    /// One row of `channels` values for each tick on the way.
    memory: M,
    /// Row that is read next and then overwritten.
    row: usize,
    /// Number of rows with values of this episode.
    filled: usize,
}

#[cfg(feature = "alloc")]
impl<T: Channels> Delayed<T, Vec<f32>> {
    /// Wraps a sensor or motor. If `ticks` is 0, there is no delay.
    ///
    /// # Panics
    /// Panics if there is not enough memory for `ticks` values of each channel.
    pub fn new(inner: T, ticks: usize) -> Self {
        let channels = inner.channels();
        Self { memory: vec![0.0; ticks.saturating_mul(channels)], inner, ticks, channels, row: 0, filled: 0 }
    }
}

impl<T: Channels, M: AsMut<[f32]>> Delayed<T, M> {
    /// Wraps a sensor or motor and uses the provided `memory`. It must have at least ticks x channels elements.
    ///
    /// # Errors
    /// Returns [`ChannelError::Memory`] if the memory is too short.
    pub fn new_in(inner: T, ticks: usize, mut memory: M) -> Result<Self, ChannelError> {
        let channels = inner.channels();
        room(&mut memory, ticks.saturating_mul(channels))?;
        Ok(Self { inner, ticks, channels, memory, row: 0, filled: 0 })
    }

    /// The row that comes out next, as far as `len` values go, or `None` without delay or channels.
    fn row(&mut self, len: usize) -> Option<&mut [f32]> {
        let start = self.row * self.channels;
        let row = self.memory.as_mut().get_mut(start..start + self.channels.min(len))?;
        if self.ticks == 0 || row.is_empty() { None } else { Some(row) }
    }

    /// One tick further.
    fn advance(&mut self) {
        self.row = if self.row + 1 < self.ticks { self.row + 1 } else { 0 };
        self.filled = self.ticks.min(self.filled + 1);
    }
}

impl<T, M> Delayed<T, M> {
    /// Gets the wrapped sensor or motor.
    pub fn inner(&self) -> &T {
        &self.inner
    }

    /// Returns a mutable reference to the wrapped sensor or motor.
    pub fn inner_mut(&mut self) -> &mut T {
        &mut self.inner
    }
}

impl<T: Channels, M> Channels for Delayed<T, M> {
    fn channels(&self) -> usize {
        self.inner.channels()
    }
    fn reset(&mut self) {
        self.inner.reset();
        self.row = 0;
        self.filled = 0;
    }
}

impl<W: ?Sized, T: Sensor<W>, M: AsMut<[f32]>> Sensor<W> for Delayed<T, M> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        self.inner.read(world, out);
        if self.filled == 0 {
            // The first reading replaces all earlier ones.
            for row in self.memory.as_mut().chunks_exact_mut(self.channels.max(1)) {
                for (value, &o) in row.iter_mut().zip(&*out) {
                    *value = o;
                }
            }
        }
        if let Some(row) = self.row(out.len()) {
            for (value, o) in row.iter_mut().zip(out) {
                core::mem::swap(value, o);
            }
        }
        self.advance();
    }
}

impl<W: ?Sized, T: Motor<W>, M: AsMut<[f32]>> Motor<W> for Delayed<T, M> {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        if self.ticks == 0 {
            self.inner.drive(y, world);
            return;
        }
        let start = self.row * self.channels;
        let row = self.memory.as_mut().get_mut(start..start + self.channels.min(y.len())).unwrap_or_default();
        if self.filled == self.ticks {
            self.inner.drive(row, world);
        }
        for (value, &y) in row.iter_mut().zip(y) {
            *value = y;
        }
        self.advance();
    }
}
