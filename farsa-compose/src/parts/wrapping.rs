//! What is wrapped around sensors and motors alike.

use std::ops::Bound;

use farsa_body::ChannelError;
use farsa_body::ports::Channels;
use farsa_body::wrappers::{Delayed, Lesioned, Noise, Noisy, Saturated, Scaled, Stuck, StuckAt, Thresholded};
use farsa_lab::Error;
use farsa_num::{Domain, Stream};

use crate::check::places::Places;
use crate::document::Wrapper;
use crate::parts::bounded::Room;

/// A sensor or motor within a wrapper.
#[derive(Clone, Debug)]
pub(crate) enum Wrapped<T> {
    Noisy(Noisy<Box<T>, Vec<f32>>),
    Delayed(Delayed<Box<T>, Vec<f32>>),
    Scaled(Scaled<Box<T>, Vec<f32>>),
    Saturated(Saturated<Box<T>, Vec<f32>>),
    Thresholded(Thresholded<Box<T>, Vec<f32>>),
    Lesioned(Lesioned<Box<T>, Vec<f32>>),
    Stuck(Stuck<Box<T>, Vec<f32>>),
}

/// The values in whose place a wrapper itself lies.
const ITSELF: usize = 32;

impl<T: Channels> Wrapped<T> {
    /// A part within the wrapper that stands at a path, which takes of the room.
    ///
    /// # Errors
    /// [`Error::Setting`] for channels that there are not, for ends in the wrong order, and where there is no room.
    pub(crate) fn new(
        inner: T,
        wrapper: &Wrapper,
        room: &mut Room,
        path: &str,
        places: &Places,
    ) -> Result<Self, Error> {
        let steps = if let Wrapper::Delay { steps } = wrapper { *steps as usize } else { 0 };
        room.take((1 + steps).saturating_mul(inner.channels()) + ITSELF, path, places)?;
        Self::around(inner, wrapper).map_err(|error| places.wrong(path, error))
    }

    fn around(inner: T, wrapper: &Wrapper) -> Result<Self, ChannelError> {
        let inner = Box::new(inner);
        // Another stream is given to it before every episode.
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
            Wrapper::Stuck { channels, value, after } => {
                let at = value.map_or(StuckAt::Last, |value| StuckAt::Value(value as f32));
                Self::Stuck(Stuck::new(inner, chosen(channels), at, *after)?)
            }
        })
    }
}

/// Calls a method of whatever is wrapped around.
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
        }
    };
}
pub(crate) use around;

/// The domains of the noise of sensors and of motors.
pub(crate) const NOISE: [Domain; 2] = [Domain::Sensor, Domain::Motor];

/// Streams for the noise of an episode: one after the other on one stream, each with room for all that it may draw.
pub(crate) struct NoiseStreams {
    stream: Stream,
    next: u64,
    /// Words that a channel may draw.
    words: u64,
}

impl NoiseStreams {
    /// From the beginning of a stream, for episodes of so many steps.
    pub(crate) fn new(stream: Stream, steps: u32) -> Self {
        // A normal number takes two words on average, and sometimes more.
        Self { stream, next: 0, words: 8 * u64::from(steps) }
    }

    /// The stream of the next noise, of so many channels.
    pub(crate) fn take(&mut self, channels: usize) -> Stream {
        let mut stream = self.stream;
        stream.seek(self.next);
        self.next += self.words * channels as u64;
        stream
    }
}

/// Something whose noise is drawn from streams that it is given.
pub(crate) trait Reseed {
    fn reseed(&mut self, streams: &mut NoiseStreams);
}

impl<T: Channels + Reseed> Reseed for Wrapped<T> {
    fn reseed(&mut self, streams: &mut NoiseStreams) {
        if let Self::Noisy(noisy) = self {
            let stream = streams.take(noisy.channels());
            noisy.reseed(stream);
        }
        around!(self, part => part.inner_mut().reseed(streams));
    }
}
