//! The wrappers of the format.

use farsa_body::ChannelError;
use farsa_body::ports::{Channels, Sensor};
use farsa_lab::Error;
use farsa_lab::advanced::Part;
use farsa_num::Stream;

use crate::part::{Filter, wrapper};

/// Delays.
mod delay;
/// Numbers that each trial draws.
mod drawn;
/// Channels at 0.
mod lesion;
/// Noise.
mod noise;
/// Limits.
mod saturate;
/// Factors.
mod scale;
/// Channels that are held.
mod stuck;
/// Zeros and ones.
mod threshold;
/// Values that swing with time.
mod wave;

/// Lists them under their names.
pub(crate) fn wrappers() -> Vec<Part> {
    vec![
        wrapper::<noise::UniformNoise>("uniform-noise"),
        wrapper::<noise::NormalNoise>("normal-noise"),
        wrapper::<delay::Delay>("delay"),
        wrapper::<scale::Scale>("scale"),
        wrapper::<saturate::Saturate>("saturate"),
        wrapper::<threshold::Threshold>("threshold"),
        wrapper::<lesion::Lesion>("lesion"),
        wrapper::<stuck::Stuck>("stuck"),
        wrapper::<drawn::Drawn>("drawn"),
        wrapper::<wave::Wave>("wave"),
    ]
}

/// A sensor of this number of values.
#[derive(Clone, Debug)]
struct Values(usize);

impl Channels for Values {
    fn channels(&self) -> usize {
        self.0
    }
}

impl Sensor<[f32]> for Values {
    fn read(&mut self, world: &[f32], out: &mut [f32]) {
        out.iter_mut().zip(world).for_each(|(out, x)| *out = *x);
    }
}

/// A wrapper of `farsa-body` around values, as a filter.
#[derive(Clone, Debug)]
struct Around<T> {
    wrapper: T,
    values: Vec<f32>,
}

impl<T: Sensor<[f32]>> Around<T> {
    fn new(wrapper: T) -> Self {
        Self { values: vec![0.0; wrapper.channels()], wrapper }
    }
}

impl<T: Sensor<[f32]>> Filter for Around<T> {
    fn reset(&mut self) {
        self.wrapper.reset();
    }

    fn pass(&mut self, values: &mut [f32], _: &mut Stream) {
        let count = values.len().min(self.values.len());
        let before = &mut self.values[..count];
        before.copy_from_slice(&values[..count]);
        self.wrapper.read(before, &mut values[..count]);
    }

    fn is_random(&self) -> bool {
        false
    }
}

/// Describes an error without its place.
fn wrong(error: ChannelError) -> Error {
    Error::Other(error.to_string())
}

/// Returns the range of the first and the last channel, by default of all.
fn range(channels: Option<[u32; 2]>, all: usize) -> std::ops::Range<usize> {
    channels.map_or(0..all, |[first, last]| first as usize..(last as usize).saturating_add(1))
}

/// Formats the first and the last channel.
fn within(channels: Option<[u32; 2]>) -> String {
    match channels {
        None => String::new(),
        Some([first, last]) if first == last => format!(" in channel {first}"),
        Some([first, last]) => format!(" in channels {first} to {last}"),
    }
}
