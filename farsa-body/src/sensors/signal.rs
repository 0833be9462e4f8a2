//! Channels that the experiment sets: labels, instructions, a bias.

use crate::channel::write;
use crate::ports::{Channels, Sensor};

/// Reads what the experiment last set, `N` channels in any world: a label, an instruction, a constant bias.
///
/// A new episode does not change it: code that sets it during an episode must set it at the start, too.
#[doc(alias = "label")]
#[doc(alias = "bias")]
#[doc(alias = "constant")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Signal<const N: usize> {
    values: [f32; N],
}

impl<const N: usize> Signal<N> {
    /// A signal that reads `values` until others are set.
    pub fn new(values: [f32; N]) -> Self {
        Self { values }
    }

    /// A label: `amplitude` on one channel and 0 on the others. 0 everywhere if there is no such channel.
    pub fn one_hot(channel: usize, amplitude: f32) -> Self {
        let mut signal = Self { values: [0.0; N] };
        signal.set_one_hot(channel, amplitude);
        signal
    }

    /// Returns the channels of the signal.
    pub fn values(&self) -> [f32; N] {
        self.values
    }

    /// Sets every channel.
    pub fn set(&mut self, values: [f32; N]) {
        self.values = values;
    }

    /// Sets one channel to `amplitude` and the others to 0. All to 0 if there is no such channel.
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
