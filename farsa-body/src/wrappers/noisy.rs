//! The wrapper that adds noise.

#[cfg(feature = "alloc")]
use alloc::{vec, vec::Vec};

use farsa_num::Stream;

use crate::channel::ChannelError;
use crate::ports::Channels;
use crate::wrappers::wrap::{Filter, Wrapped, wrapper};

/// The distribution of a noise.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Noise {
    /// Uniform between minus and plus this, in the channel's unit.
    Uniform(f32),
    /// Normal with mean 0 and this standard deviation, in the channel's unit.
    Normal(f32),
}

/// Adds to every value an independent random number.
///
/// The numbers come in the order of ticks and channels from one stream. A reset rewinds the stream: episodes that
/// should differ in their noise are each given their own with [`Noisy::reseed`]. Noise is never clamped. Wrap in
/// [`crate::wrappers::Saturated`] what has to stay in a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noisy<T, M>(Wrapped<T, Source, M>);

#[derive(Clone, Copy, Debug, PartialEq)]
struct Source {
    noise: Noise,
    start: Stream,
    stream: Stream,
}

impl Filter for Source {
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

wrapper!(Noisy);

#[cfg(feature = "alloc")]
impl<T: Channels> Noisy<T, Vec<f32>> {
    /// Wraps a sensor or motor.
    ///
    /// # Errors
    /// [`ChannelError::Value`] if the noise's number is negative or not finite.
    pub fn new(inner: T, noise: Noise, stream: Stream) -> Result<Self, ChannelError> {
        let memory = vec![0.0; inner.channels()];
        Self::new_in(inner, noise, stream, memory)
    }
}

impl<T: Channels, M: AsMut<[f32]>> Noisy<T, M> {
    /// Wraps a sensor or motor, over the caller's `memory` [channels].
    ///
    /// # Errors
    /// [`ChannelError::Value`] if the noise's number is negative or not finite, [`ChannelError::Memory`] if the memory
    /// is too short.
    pub fn new_in(inner: T, noise: Noise, stream: Stream, memory: M) -> Result<Self, ChannelError> {
        let (field, value) = match noise {
            Noise::Uniform(amplitude) => ("noise amplitude", amplitude),
            Noise::Normal(deviation) => ("noise deviation", deviation),
        };
        if !value.is_finite() || value < 0.0 {
            return Err(ChannelError::Value { field, value });
        }
        Wrapped::new(inner, Source { noise, start: stream, stream }, memory).map(Self)
    }
}

impl<T, M> Noisy<T, M> {
    /// Takes the noise from here on, and after every reset, from the beginning of this stream.
    pub fn reseed(&mut self, stream: Stream) {
        self.0.filter.start = stream;
        self.0.filter.stream = stream;
    }
}
