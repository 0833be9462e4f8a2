//! Streams of the noise of wrappers.

use farsa_lab::EpisodeId;
use farsa_num::{Domain, Stream};

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
