//! A sensor or motor with its wrappers.

use farsa_body::ports::{Channels, Motor, Sensor};
use farsa_lab::Error;

use crate::check::source::Source;
use crate::document::Wrapper;
use crate::parts::filtered::Filtered;
use crate::parts::noise_streams::NoiseStreams;
use crate::parts::sizes::MemoryBudget;
use crate::parts::wrapping::wrap;

/// A sensor or motor of kind `K`, bare or in a wrapper around another part.
#[derive(Clone, Debug)]
pub(crate) enum Part<K> {
    Bare(K),
    Wrapped(Filtered<Box<Self>>),
}

impl<K> Part<K> {
    /// Returns the sensor or motor in the wrappers.
    pub(crate) fn kind(&self) -> &K {
        match self {
            Self::Bare(kind) => kind,
            Self::Wrapped(wrapped) => wrapped.inner().kind(),
        }
    }

    /// Returns the sensor or motor in the wrappers.
    pub(crate) fn kind_mut(&mut self) -> &mut K {
        match self {
            Self::Bare(kind) => kind,
            Self::Wrapped(wrapped) => wrapped.inner_mut().kind_mut(),
        }
    }
}

impl<K: Channels> Part<K> {
    /// Builds the enabled parts of a list of a document. `make` builds a kind at a path.
    pub(crate) fn list<'d, D: 'd>(
        list: &str,
        items: impl Iterator<Item = (&'d D, &'d [Wrapper], bool)>,
        mut make: impl FnMut(&'d D, &str) -> Result<K, Error>,
        budget: &mut MemoryBudget,
        source: &Source,
    ) -> Result<Vec<Self>, Error> {
        let mut parts = Vec::new();
        for (index, (kind, wrappers, _)) in items.enumerate().filter(|(_, (.., enabled))| *enabled) {
            let path = format!("/{list}/{index}");
            let mut part = Self::Bare(make(kind, &path)?);
            for (number, wrapper) in wrappers.iter().enumerate() {
                let path = format!("{path}/wrappers/{number}");
                part = Self::Wrapped(wrap(part, wrapper, budget, &path, source)?);
            }
            parts.push(part);
        }
        Ok(parts)
    }

    /// Assigns streams to the noise, from the outer wrapper to the inner one.
    pub(crate) fn reseed(&mut self, streams: &mut NoiseStreams) {
        let Self::Wrapped(wrapped) = self else { return };
        wrapped.reseed(streams);
        wrapped.inner_mut().reseed(streams);
    }
}

impl<K: Channels> Channels for Part<K> {
    fn channels(&self) -> usize {
        match self {
            Self::Bare(kind) => kind.channels(),
            Self::Wrapped(wrapped) => wrapped.channels(),
        }
    }

    fn reset(&mut self) {
        match self {
            Self::Bare(kind) => kind.reset(),
            Self::Wrapped(wrapped) => wrapped.reset(),
        }
    }
}

impl<W, K: Sensor<W>> Sensor<W> for Part<K> {
    /// Reads a bare sensor inline, because most have no wrapper.
    #[inline(always)]
    fn read(&mut self, world: &W, out: &mut [f32]) {
        match self {
            Self::Bare(kind) => kind.read(world, out),
            Self::Wrapped(wrapped) => read(wrapped, world, out),
        }
    }
}

impl<W, K: Motor<W>> Motor<W> for Part<K> {
    /// Drives a bare motor inline, because most have no wrapper.
    #[inline(always)]
    fn drive(&mut self, y: &[f32], world: &mut W) {
        match self {
            Self::Bare(kind) => kind.drive(y, world),
            Self::Wrapped(wrapped) => drive(wrapped, y, world),
        }
    }
}

#[inline(never)]
fn read<W, K: Sensor<W>>(wrapped: &mut Filtered<Box<Part<K>>>, world: &W, out: &mut [f32]) {
    wrapped.read(world, out);
}

#[inline(never)]
fn drive<W, K: Motor<W>>(wrapped: &mut Filtered<Box<Part<K>>>, y: &[f32], world: &mut W) {
    wrapped.drive(y, world);
}
