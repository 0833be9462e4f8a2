//! A wrapper that adds noise.

#[cfg(feature = "alloc")]
use alloc::{vec, vec::Vec};

use farsa_num::Stream;

use crate::channel::ChannelError;
use crate::ports::Channels;
use crate::wrappers::wrap::{Filter, Wrapped};

/// The distribution of the noise.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Noise {
    /// A uniform distribution between minus and plus this value, in the unit of the channel.
    Uniform(f32),
    /// A normal distribution with mean 0 and this standard deviation, in the unit of the channel.
    Normal(f32),
}

/// Adds an independent random number to every value.
///
/// All numbers are drawn from one stream in the order of ticks and channels. A reset rewinds the stream. Use
/// `reseed` if the noise should differ between episodes. The result is not clamped. Wrap it in
/// [`crate::wrappers::Saturated`] if it must stay within a range.
pub type Noisy<T, M> = Wrapped<T, Source, M>;

/// The noise of [`Noisy`] with its stream.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    noise: Noise,
    start: Stream,
    stream: Stream,
}

impl Filter for Source {
    #[inline]
    fn pass(&mut self, values: &[f32], passed: &mut [f32]) {
        for (p, &x) in passed.iter_mut().zip(values) {
            *p = x + match self.noise {
                Noise::Uniform(amplitude) => {
                    let u = self.stream.uniform();
                    amplitude * (u + u - 1.0)
                }
                Noise::Normal(deviation) => deviation * self.stream.normal(),
            };
        }
    }
    fn rewind(&mut self) {
        self.stream = self.start;
    }
}

#[cfg(feature = "alloc")]
impl<T: Channels> Noisy<T, Vec<f32>> {
    /// Wraps a sensor or motor.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if the amplitude of the noise is negative or not finite.
    pub fn new(inner: T, noise: Noise, stream: Stream) -> Result<Self, ChannelError> {
        let memory = vec![0.0; inner.channels()];
        Self::new_in(inner, noise, stream, memory)
    }
}

impl<T: Channels, M: AsMut<[f32]>> Noisy<T, M> {
    /// Wraps a sensor or motor and uses the provided `memory` with one element per channel.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if the amplitude of the noise is negative or not finite, or
    /// [`ChannelError::Memory`] if the memory is too short.
    pub fn new_in(inner: T, noise: Noise, stream: Stream, memory: M) -> Result<Self, ChannelError> {
        let (field, value) = match noise {
            Noise::Uniform(amplitude) => ("noise amplitude", amplitude),
            Noise::Normal(deviation) => ("noise deviation", deviation),
        };
        if !value.is_finite() || value < 0.0 {
            return Err(ChannelError::Value { field, value });
        }
        Wrapped::over(inner, Source { noise, start: stream, stream }, memory)
    }
}

impl<T, M> Noisy<T, M> {
    /// Replaces the stream of random numbers. It is used from its beginning now and after every reset.
    pub fn reseed(&mut self, stream: Stream) {
        self.filter.start = stream;
        self.filter.stream = stream;
    }
}
