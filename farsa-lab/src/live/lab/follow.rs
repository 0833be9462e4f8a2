//! Event stream of a run: new generations, and its state whenever it changes.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::task::{Context, Poll, ready};
use std::time::Duration;

use hyper::body::Bytes;
use tokio::time::{Interval, MissedTickBehavior, interval};

use crate::live::http::answer::{Events, event};
use crate::live::lab::calls::Bench;
use crate::live::log_tail::{LogTail, Part};

/// Interval at which the files of a run are checked.
const INTERVAL: Duration = Duration::from_millis(500);
/// Intervals without an event after which a comment is sent, which detects closed connections.
const KEEP_ALIVE: u32 = 20;

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
    ticks: Interval,
    /// State that was sent last.
    state: Bytes,
    silent: u32,
    ended: bool,
}

impl Follow {
    /// Starts the events of a run after the given number of generations.
    pub(super) fn new(listener: Listener, bench: Arc<Bench>, run: &str, tail: LogTail) -> Self {
        let mut ticks = interval(INTERVAL);
        ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let (run, state) = (run.to_owned(), Bytes::new());
        Self { _listener: listener, bench, run, tail, ticks, state, silent: 0, ended: false }
    }

    /// Returns an event that is due, and true if more of the log can be read at once.
    fn next(&mut self) -> (Option<Bytes>, bool) {
        // A log that is being written is read in the next interval.
        match self.tail.read() {
            Ok(Part::Other) => {
                self.ended = true;
                return (Some(Bytes::from_static(b"event: replaced\ndata: {}\n\n")), false);
            }
            Ok(Part::Rows(rows, more)) if !rows.is_empty() || more => {
                let next = rows.last().map(|row| row.0 + 1);
                let sent = if rows.is_empty() { None } else { event("fitness", next, &rows).ok() };
                return (sent, more);
            }
            _ => {}
        }
        let state = self.bench.state(&self.run).and_then(|facts| event("state", None, &facts).ok());
        let state = state.filter(|state| *state != self.state);
        if let Some(state) = &state {
            self.state = state.clone();
        }
        (state, false)
    }
}

impl Events for Follow {
    fn poll(&mut self, context: &mut Context<'_>) -> Poll<Option<Bytes>> {
        loop {
            if self.ended {
                return Poll::Ready(None);
            }
            let (event, more) = self.next();
            if event.is_some() {
                self.silent = 0;
                return Poll::Ready(event);
            }
            if more {
                context.waker().wake_by_ref();
                return Poll::Pending;
            }
            ready!(self.ticks.poll_tick(context));
            self.silent += 1;
            if self.silent == KEEP_ALIVE {
                self.silent = 0;
                return Poll::Ready(Some(Bytes::from_static(b":\n\n")));
            }
        }
    }
}
