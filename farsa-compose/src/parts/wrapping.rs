//! Wrappers of sensors and motors.

use std::ops::Bound;

use farsa_body::ChannelError;
use farsa_body::ports::Channels;
use farsa_body::wrappers::{Delayed, Lesioned, Noise, Noisy, Saturated, Scaled, Stuck, StuckAt, Thresholded};
use farsa_lab::{EpisodeId, Error};
use farsa_num::{Domain, Stream};

use crate::check::source::Source;
use crate::document::Wrapper;
use crate::part::definition::Build;
use crate::parts::filtered::Filtered;
use crate::parts::sizes::MemoryBudget;

/// A sensor or motor in a wrapper.
#[derive(Clone, Debug)]
pub(crate) enum Wrapped<T> {
    Noisy(Noisy<Box<T>, Vec<f32>>),
    Delayed(Delayed<Box<T>, Vec<f32>>),
    Scaled(Scaled<Box<T>, Vec<f32>>),
    Saturated(Saturated<Box<T>, Vec<f32>>),
    Thresholded(Thresholded<Box<T>, Vec<f32>>),
    Lesioned(Lesioned<Box<T>, Vec<f32>>),
    Stuck(Stuck<Box<T>, Vec<f32>>),
    Registered(Filtered<Box<T>>),
}

/// Size of a wrapper itself, in values.
const ITSELF: usize = 32;

impl<T: Channels> Wrapped<T> {
    /// Wraps a part as the wrapper at a path requires, within the memory budget.
    pub(crate) fn new(
        inner: T,
        wrapper: &Wrapper,
        budget: &mut MemoryBudget,
        path: &str,
        source: &Source,
    ) -> Result<Self, Error> {
        let steps = if let Wrapper::Delay { steps } = wrapper { *steps as usize } else { 0 };
        // Each wrapper has one value per channel, and a delay one more per step.
        budget.take((1 + steps).saturating_mul(inner.channels()) + ITSELF, path, source)?;
        if let Wrapper::Registered { kind, keys } = wrapper {
            let build = source.registry.find(kind, |build| match build {
                Build::Wrapper(build) => Some(*build),
                _ => None,
            });
            let build = build.ok_or_else(|| source.wrong(path, format!("`{kind}` is no wrapper")))?;
            let filter = build(keys, inner.channels()).map_err(|error| source.at(path, error))?;
            return Ok(Self::Registered(Filtered::new(Box::new(inner), filter)));
        }
        Self::around(inner, wrapper).map_err(|error| source.wrong(path, error))
    }

    fn around(inner: T, wrapper: &Wrapper) -> Result<Self, ChannelError> {
        let inner = Box::new(inner);
        // Each episode replaces the stream.
        let stream = Stream::from_seed(0);
        let chosen = |channels: &Option<[u32; 2]>| {
            channels.map_or((Bound::Unbounded, Bound::Unbounded), |[first, last]| {
                (Bound::Included(first as usize), Bound::Included(last as usize))
            })
        };
        Ok(match wrapper {
            Wrapper::UniformNoise { amplitude } => {
                Self::Noisy(Noisy::new(inner, Noise::Uniform(*amplitude as f32), stream)?)
            }
            Wrapper::NormalNoise { deviation } => {
                Self::Noisy(Noisy::new(inner, Noise::Normal(*deviation as f32), stream)?)
            }
            Wrapper::Delay { steps } => Self::Delayed(Delayed::new(inner, *steps as usize)),
            Wrapper::Scale { gain, offset } => Self::Scaled(Scaled::new(inner, *gain as f32, *offset as f32)?),
            Wrapper::Saturate { low, high } => Self::Saturated(Saturated::new(inner, *low as f32, *high as f32)?),
            Wrapper::Threshold { above } => Self::Thresholded(Thresholded::new(inner, *above as f32)?),
            Wrapper::Lesion { channels } => Self::Lesioned(Lesioned::new(inner, chosen(channels))?),
            // Built by `new`.
            Wrapper::Registered { .. } => return Err(ChannelError::Groups { field: "filters", count: 0, size: 1 }),
            Wrapper::Stuck { channels, value, after } => {
                let at = value.map_or(StuckAt::Last, |value| StuckAt::Value(value as f32));
                Self::Stuck(Stuck::new(inner, chosen(channels), at, *after)?)
            }
        })
    }
}

/// Calls a method of the wrapper of any kind.
macro_rules! around {
    ($wrapped:expr, $part:ident => $call:expr) => {
        match $wrapped {
            $crate::parts::wrapping::Wrapped::Noisy($part) => $call,
            $crate::parts::wrapping::Wrapped::Delayed($part) => $call,
            $crate::parts::wrapping::Wrapped::Scaled($part) => $call,
            $crate::parts::wrapping::Wrapped::Saturated($part) => $call,
            $crate::parts::wrapping::Wrapped::Thresholded($part) => $call,
            $crate::parts::wrapping::Wrapped::Lesioned($part) => $call,
            $crate::parts::wrapping::Wrapped::Stuck($part) => $call,
            $crate::parts::wrapping::Wrapped::Registered($part) => $call,
        }
    };
}
pub(crate) use around;

/// Streams for the noise of an episode: consecutive sections of one stream, each long enough for all draws of a
/// wrapper.
pub(crate) struct NoiseStreams {
    stream: Stream,
    next: u64,
    /// Words per channel.
    words: u64,
}

impl NoiseStreams {
    /// Returns the streams of sensors and of motors for an episode of this number of steps.
    pub(crate) fn of_episode(id: EpisodeId, steps: u32) -> [Self; 2] {
        let stream = |domain| Stream::new(id.seed, domain, id.trial, id.individual, id.generation);
        [Domain::Sensor, Domain::Motor].map(|domain| Self::new(stream(domain), steps))
    }

    /// Starts at the beginning of a stream, for episodes of this number of steps.
    fn new(stream: Stream, steps: u32) -> Self {
        // A normal number takes two words on average, and sometimes more.
        Self { stream, next: 0, words: 8 * u64::from(steps) }
    }

    /// Returns the stream of the next noise, for the given number of channels.
    pub(crate) fn take(&mut self, channels: usize) -> Stream {
        // Sections are disjoint, so a draw of one wrapper never shifts those of another.
        let mut stream = self.stream;
        stream.seek(self.next);
        self.next += self.words * channels as u64;
        stream
    }
}
