//! The common implementation of all wrappers. This passes values through a filter.

use core::ops::{Bound, Range, RangeBounds};

use crate::channel::ChannelError;
use crate::ports::{Channels, Motor, Sensor};

/// The effect of a wrapper on values.
pub trait Filter {
    /// Computes one tick's `passed` from its `values`, both of the same length. `passed` still holds the last tick's.
    fn pass(&mut self, values: &[f32], passed: &mut [f32]);
    /// Back to the beginning of an episode.
    fn rewind(&mut self) {}
}

/// A sensor or motor behind a filter, with memory for the values passed on.
///
/// A motor needs the memory because the values it is given are only borrowed. A sensor has it too, so that one
/// constructor serves both and the last values stay readable.
///
/// Use it by the names of its kinds, such as [`Scaled`](crate::wrappers::Scaled) and [`Noisy`](crate::wrappers::Noisy).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrapped<T, F, M> {
    pub(crate) inner: T,
    pub(crate) filter: F,
    pub(crate) memory: M,
}

impl<T, F, M> Wrapped<T, F, M> {
    /// Gets the wrapped sensor or motor.
    pub fn inner(&self) -> &T {
        &self.inner
    }

    /// Returns the wrapped sensor or motor, to be changed.
    pub fn inner_mut(&mut self) -> &mut T {
        &mut self.inner
    }
}

impl<T: Channels, F, M: AsMut<[f32]>> Wrapped<T, F, M> {
    /// Checks the memory and sets it to 0.
    pub(crate) fn over(inner: T, filter: F, mut memory: M) -> Result<Self, ChannelError> {
        room(&mut memory, inner.channels())?;
        memory.as_mut().fill(0.0);
        Ok(Self { inner, filter, memory })
    }
}

impl<T: Channels, F, M: AsRef<[f32]>> Wrapped<T, F, M> {
    /// Returns the values that were passed on in the last tick, one per channel. Before the first tick they are 0.
    pub fn values(&self) -> &[f32] {
        let memory = self.memory.as_ref();
        memory.get(..self.inner.channels()).unwrap_or(memory)
    }
}

impl<T: Channels, F: Filter, M: AsMut<[f32]>> Channels for Wrapped<T, F, M> {
    fn channels(&self) -> usize {
        self.inner.channels()
    }
    fn reset(&mut self) {
        self.inner.reset();
        self.filter.rewind();
        self.memory.as_mut().fill(0.0);
    }
}

impl<W: ?Sized, T: Sensor<W>, F: Filter, M: AsMut<[f32]>> Sensor<W> for Wrapped<T, F, M> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        self.inner.read(world, out);
        let memory = self.memory.as_mut();
        let n = self.inner.channels().min(out.len()).min(memory.len());
        let (values, passed) = (&mut out[..n], &mut memory[..n]);
        self.filter.pass(values, passed);
        values.copy_from_slice(passed);
    }
}

impl<W: ?Sized, T: Motor<W>, F: Filter, M: AsMut<[f32]>> Motor<W> for Wrapped<T, F, M> {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        let memory = self.memory.as_mut();
        let n = self.inner.channels().min(y.len()).min(memory.len());
        let passed = &mut memory[..n];
        self.filter.pass(&y[..n], passed);
        self.inner.drive(passed, world);
    }
}

/// Checks that the memory holds as many values as are needed.
pub(crate) fn room<M: AsMut<[f32]>>(memory: &mut M, needed: usize) -> Result<(), ChannelError> {
    let given = memory.as_mut().len();
    if given < needed { Err(ChannelError::Memory { given, needed }) } else { Ok(()) }
}

/// The selected ones of a number of channels.
pub(crate) fn select(which: &impl RangeBounds<usize>, channels: usize) -> Result<Range<usize>, ChannelError> {
    let start = match which.start_bound() {
        Bound::Included(&first) => first,
        Bound::Excluded(&before) => before.saturating_add(1),
        Bound::Unbounded => 0,
    };
    let end = match which.end_bound() {
        Bound::Included(&last) => last.saturating_add(1),
        Bound::Excluded(&end) => end,
        Bound::Unbounded => channels,
    };
    if start <= end && end <= channels { Ok(start..end) } else { Err(ChannelError::Selection { start, end, channels }) }
}
