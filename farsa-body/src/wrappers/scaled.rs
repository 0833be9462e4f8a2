//! Wrappers that apply the same function to every value, such as a scale, a saturation or a threshold.

#[cfg(feature = "alloc")]
use alloc::{vec, vec::Vec};

use farsa_num::Scalar;

use crate::channel::{ChannelError, finite, finite_range};
use crate::ports::Channels;
use crate::wrappers::wrap::{Filter, Wrapped};

/// Replaces each value x of a sensor or motor by gain * x + offset.
pub type Scaled<T, M> = Wrapped<T, Scale, M>;

/// The gain and the offset of [`Scaled`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    gain: f32,
    offset: f32,
}

impl Filter for Scale {
    #[inline]
    fn pass(&mut self, values: &[f32], passed: &mut [f32]) {
        for (p, &x) in passed.iter_mut().zip(values) {
            *p = self.gain * x + self.offset;
        }
    }
}

#[cfg(feature = "alloc")]
impl<T: Channels> Scaled<T, Vec<f32>> {
    /// Wraps a sensor or motor.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if a number is not finite.
    pub fn new(inner: T, gain: f32, offset: f32) -> Result<Self, ChannelError> {
        let memory = vec![0.0; inner.channels()];
        Self::new_in(inner, gain, offset, memory)
    }
}

impl<T: Channels, M: AsMut<[f32]>> Scaled<T, M> {
    /// Wraps a sensor or motor and uses the provided `memory` with one element per channel.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if a number is not finite, or [`ChannelError::Memory`] if the memory is too
    /// short.
    pub fn new_in(inner: T, gain: f32, offset: f32, memory: M) -> Result<Self, ChannelError> {
        let scale = Scale { gain: finite("gain", gain)?, offset: finite("offset", offset)? };
        Wrapped::over(inner, scale, memory)
    }
}

/// Clamps each value of a sensor or motor to [low, high]. NaN is replaced by `low`.
pub type Saturated<T, M> = Wrapped<T, Saturation, M>;

/// The range of [`Saturated`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saturation {
    low: f32,
    high: f32,
}

impl Filter for Saturation {
    #[inline]
    fn pass(&mut self, values: &[f32], passed: &mut [f32]) {
        for (p, &x) in passed.iter_mut().zip(values) {
            *p = Scalar::clamp(x, self.low, self.high);
        }
    }
}

#[cfg(feature = "alloc")]
impl<T: Channels> Saturated<T, Vec<f32>> {
    /// Wraps a sensor or motor.
    ///
    /// # Errors
    /// Returns [`ChannelError::Range`] if `low > high` or a number is not finite.
    pub fn new(inner: T, low: f32, high: f32) -> Result<Self, ChannelError> {
        let memory = vec![0.0; inner.channels()];
        Self::new_in(inner, low, high, memory)
    }
}

impl<T: Channels, M: AsMut<[f32]>> Saturated<T, M> {
    /// Wraps a sensor or motor and uses the provided `memory` with one element per channel.
    ///
    /// # Errors
    /// Returns [`ChannelError::Range`] if `low > high` or a number is not finite, or [`ChannelError::Memory`] if the
    /// memory is too short.
    pub fn new_in(inner: T, low: f32, high: f32, memory: M) -> Result<Self, ChannelError> {
        finite_range(low, high)?;
        if low > high {
            return Err(ChannelError::Range { from: low, to: high });
        }
        Wrapped::over(inner, Saturation { low, high }, memory)
    }
}

/// Replaces each value of a sensor or motor by 1 if it is above a threshold, and by 0 otherwise. NaN is replaced by 0.
pub type Thresholded<T, M> = Wrapped<T, Threshold, M>;

/// The threshold of [`Thresholded`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold(f32);

impl Filter for Threshold {
    #[inline]
    fn pass(&mut self, values: &[f32], passed: &mut [f32]) {
        for (p, &x) in passed.iter_mut().zip(values) {
            *p = f32::from(u8::from(x > self.0));
        }
    }
}

#[cfg(feature = "alloc")]
impl<T: Channels> Thresholded<T, Vec<f32>> {
    /// Wraps a sensor or motor.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if the threshold is not finite.
    pub fn new(inner: T, threshold: f32) -> Result<Self, ChannelError> {
        let memory = vec![0.0; inner.channels()];
        Self::new_in(inner, threshold, memory)
    }
}

impl<T: Channels, M: AsMut<[f32]>> Thresholded<T, M> {
    /// Wraps a sensor or motor and uses the provided `memory` with one element per channel.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if the threshold is not finite, or [`ChannelError::Memory`] if the memory is too
    /// short.
    pub fn new_in(inner: T, threshold: f32, memory: M) -> Result<Self, ChannelError> {
        Wrapped::over(inner, Threshold(finite("threshold", threshold)?), memory)
    }
}

/// Passes all values unchanged and stores those of the last tick. They can be read with `values()` without disturbing
/// the sensor.
pub type Recorded<T, M> = Wrapped<T, Record, M>;

/// The filter of [`Recorded`]. This changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record;

impl Filter for Record {
    #[inline]
    fn pass(&mut self, values: &[f32], passed: &mut [f32]) {
        passed.copy_from_slice(values);
    }
}

#[cfg(feature = "alloc")]
impl<T: Channels> Recorded<T, Vec<f32>> {
    /// Wraps a sensor or motor.
    pub fn new(inner: T) -> Self {
        let memory = vec![0.0; inner.channels()];
        Self { inner, filter: Record, memory }
    }
}

impl<T: Channels, M: AsMut<[f32]>> Recorded<T, M> {
    /// Wraps a sensor or motor and uses the provided `memory` with one element per channel.
    ///
    /// # Errors
    /// Returns [`ChannelError::Memory`] if the memory is too short.
    pub fn new_in(inner: T, memory: M) -> Result<Self, ChannelError> {
        Wrapped::over(inner, Record, memory)
    }
}
