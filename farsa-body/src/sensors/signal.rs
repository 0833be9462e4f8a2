//! Channels set by the experiment, such as labels, instructions and biases.

use crate::channel::write;
use crate::ports::{Channels, Sensor};

/// A sensor whose `N` channels are set by the experiment, for example a label, an instruction or a constant bias. It
/// works in any world.
///
/// Note that the channels keep their values when a new episode starts. Code that changes them during an episode must
/// also set them at the start.
#[doc(alias = "label")]
#[doc(alias = "bias")]
#[doc(alias = "constant")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Signal<const N: usize> {
    values: [f32; N],
}

impl<const N: usize> Signal<N> {
    /// Creates a signal that reads `values` until it is changed.
    pub fn new(values: [f32; N]) -> Self {
        Self { values }
    }

    /// Creates a signal that reads `amplitude` on one channel and 0 on all others. If the channel does not exist, all
    /// channels are 0.
    pub fn one_hot(channel: usize, amplitude: f32) -> Self {
        let mut signal = Self { values: [0.0; N] };
        signal.set_one_hot(channel, amplitude);
        signal
    }

    /// Gets the values of the channels.
    pub fn values(&self) -> [f32; N] {
        self.values
    }

    /// Sets the values of all channels.
    pub fn set(&mut self, values: [f32; N]) {
        self.values = values;
    }

    /// Sets one channel to `amplitude` and all others to 0. If the channel does not exist, all channels are set to 0.
    pub fn set_one_hot(&mut self, channel: usize, amplitude: f32) {
        self.values = [0.0; N];
        if let Some(value) = self.values.get_mut(channel) {
            *value = amplitude;
        }
    }
}

impl<const N: usize> Channels for Signal<N> {
    fn channels(&self) -> usize {
        N
    }
}

impl<const N: usize, W: ?Sized> Sensor<W> for Signal<N> {
    fn read(&mut self, _: &W, out: &mut [f32]) {
        write(out, self.values);
    }
}
