//! A sensor or motor in a wrapper.

use farsa_body::ports::{Channels, Motor, Sensor};
use farsa_num::Stream;

use crate::part::wrapper::AnyFilter;
use crate::parts::noise_streams::NoiseStreams;

/// A part whose values pass a filter.
#[derive(Clone, Debug)]
pub(crate) struct Filtered<T> {
    inner: T,
    filter: Box<dyn AnyFilter>,
    /// Values on the way to a motor [channels].
    passed: Vec<f32>,
    start: Stream,
    stream: Stream,
}

impl<T: Channels> Filtered<T> {
    /// Wraps a part. Each episode replaces the stream.
    pub(crate) fn new(inner: T, filter: Box<dyn AnyFilter>) -> Self {
        let (passed, stream) = (vec![0.0; inner.channels()], Stream::from_seed(0));
        Self { inner, filter, passed, start: stream, stream }
    }

    /// Takes a stream for the noise, which every reset rewinds.
    pub(crate) fn reseed(&mut self, streams: &mut NoiseStreams) {
        if self.filter.is_random() {
            self.start = streams.take(self.inner.channels());
            self.stream = self.start;
        }
    }
}

impl<T> Filtered<T> {
    /// Gets the wrapped part.
    pub(crate) fn inner(&self) -> &T {
        &self.inner
    }

    /// Gets the wrapped part.
    pub(crate) fn inner_mut(&mut self) -> &mut T {
        &mut self.inner
    }
}

impl<T: Channels> Channels for Filtered<T> {
    fn channels(&self) -> usize {
        self.inner.channels()
    }

    fn reset(&mut self) {
        self.inner.reset();
        self.filter.reset();
        self.stream = self.start;
    }
}

impl<W: ?Sized, T: Sensor<W>> Sensor<W> for Filtered<T> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        self.inner.read(world, out);
        self.filter.pass(out, &mut self.stream);
    }
}

impl<W: ?Sized, T: Motor<W>> Motor<W> for Filtered<T> {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        let count = y.len().min(self.passed.len());
        let passed = &mut self.passed[..count];
        passed.copy_from_slice(&y[..count]);
        self.filter.pass(passed, &mut self.stream);
        if !self.filter.holds() {
            self.inner.drive(passed, world);
        }
    }
}
