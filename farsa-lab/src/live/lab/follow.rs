//! Event stream of a run: new generations and champions, and its state whenever it changes.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use hyper::body::Bytes;

use crate::live::http::answer::event;
use crate::live::http::paced::{Events, Next, REPLACED};
use crate::live::lab::calls::Bench;
use crate::live::lab::champions::Champions;
use crate::live::log_tail::{LogTail, Part};

/// Place of an open event stream.
#[derive(Debug)]
pub(super) struct Listener(Arc<AtomicUsize>);

impl Listener {
    /// Takes a place among at most the given number.
    pub(super) fn new(count: &Arc<AtomicUsize>, most: usize) -> Option<Self> {
        // Only the thread of connections takes places.
        if count.load(Ordering::Relaxed) >= most {
            return None;
        }
        count.fetch_add(1, Ordering::Relaxed);
        Some(Self(count.clone()))
    }
}

impl Drop for Listener {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Events of one run.
#[derive(Debug)]
pub(super) struct Follow {
    _listener: Listener,
    bench: Arc<Bench>,
    run: String,
    tail: LogTail,
    champions: Champions,
    /// True if the log was read to its end in this interval. The state is next.
    is_read: bool,
    /// State that was sent last.
    state: Bytes,
}

impl Follow {
    /// Starts the events of a run after the given number of generations.
    pub(super) fn new(listener: Listener, bench: Arc<Bench>, run: &str, tail: LogTail, champions: Champions) -> Self {
        let (run, state) = (run.to_owned(), Bytes::new());
        Self { _listener: listener, bench, run, tail, champions, is_read: false, state }
    }
}

impl Events for Follow {
    fn next(&mut self) -> Next {
        if let Some(event) = self.champions.event(&self.bench, &self.run) {
            return Next::Event(event, true);
        }
        // A log that is being written is read in the next interval.
        let part = if self.is_read { Ok(Part::Rows(Vec::new(), false)) } else { self.tail.read() };
        self.is_read = !matches!(part, Ok(Part::Rows(_, true)));
        match part {
            Ok(Part::Other) => return Next::Last(Bytes::from_static(REPLACED)),
            Ok(Part::Rows(rows, true)) if rows.is_empty() => return Next::More,
            Ok(Part::Rows(rows, _)) if !rows.is_empty() => {
                let next = rows.last().map(|row| row.0 + 1);
                return event("fitness", next, &rows).map_or(Next::Nothing, |event| Next::Event(event, true));
            }
            _ => {}
        }
        self.is_read = false;
        let state = self.bench.state(&self.run).and_then(|facts| event("state", None, &facts).ok());
        match state.filter(|state| *state != self.state) {
            Some(state) => {
                self.state = state.clone();
                Next::Event(state, false)
            }
            None => Next::Nothing,
        }
    }
}
