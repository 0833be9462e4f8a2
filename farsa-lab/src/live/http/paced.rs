//! Events that a source is asked for at intervals.

use std::fmt::Debug;
use std::task::{Context, Poll, ready};
use std::time::Duration;

use hyper::body::Bytes;
use tokio::time::{Interval, MissedTickBehavior, interval};

/// Interval at which the files of a run are checked.
pub(in crate::live) const INTERVAL: Duration = Duration::from_millis(500);
/// Intervals without an event after which a comment is sent, which detects closed connections.
const KEEP_ALIVE: u32 = 20;
/// Last event of a stream whose run was replaced.
pub(in crate::live) const REPLACED: &[u8] = b"event: replaced\ndata: {}\n\n";

/// Answer of a source.
#[derive(Debug, PartialEq, Eq)]
pub(in crate::live) enum Next {
    /// An event, and true if another may follow at once. A log that grows all the time would otherwise leave no pause.
    Event(Bytes, bool),
    /// The event after which the stream ends.
    Last(Bytes),
    /// No event yet, but the source has more to read at once.
    More,
    /// No event before the next interval.
    Nothing,
}

/// Source of the events of an answer that stays open.
pub(in crate::live) trait Events: Debug + Send + 'static {
    /// Returns what is due.
    fn next(&mut self) -> Next;
}

/// A source with its interval.
#[derive(Debug)]
pub(in crate::live) struct Paced<E: ?Sized = dyn Events> {
    ticks: Interval,
    /// True until the next interval.
    waits: bool,
    /// Intervals since the last event.
    silent: u32,
    ended: bool,
    pub(in crate::live) events: E,
}

impl<E> Paced<E> {
    /// Starts the intervals of a source.
    pub(in crate::live) fn new(events: E) -> Self {
        let mut ticks = interval(INTERVAL);
        ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
        Self { ticks, waits: false, silent: 0, ended: false, events }
    }
}

impl<E: Events + ?Sized> Paced<E> {
    /// Returns the next event, or `None` at the end of the stream.
    pub(in crate::live) fn poll(&mut self, context: &mut Context<'_>) -> Poll<Option<Bytes>> {
        loop {
            if self.ended {
                return Poll::Ready(None);
            }
            if self.waits {
                ready!(self.ticks.poll_tick(context));
                self.waits = false;
                self.silent += 1;
                if self.silent == KEEP_ALIVE {
                    self.silent = 0;
                    return Poll::Ready(Some(Bytes::from_static(b":\n\n")));
                }
            }
            let next = self.events.next();
            self.waits = matches!(next, Next::Event(_, false) | Next::Nothing);
            self.ended = matches!(next, Next::Last(_));
            match next {
                Next::Event(event, _) | Next::Last(event) => {
                    self.silent = 0;
                    return Poll::Ready(Some(event));
                }
                Next::More => {
                    context.waker().wake_by_ref();
                    return Poll::Pending;
                }
                Next::Nothing => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::task::Waker;

    /// A source that always has an event.
    #[derive(Debug)]
    struct Busy(bool);

    impl Events for Busy {
        fn next(&mut self) -> Next {
            Next::Event(Bytes::from_static(b"x"), self.0)
        }
    }

    #[test]
    fn a_busy_source_is_asked_once_in_an_interval() {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build().unwrap();
        runtime.block_on(async {
            // The first interval may begin at once.
            for (more, expected) in [(false, 1..=2), (true, 100..=100)] {
                let (mut source, mut context) = (Paced::new(Busy(more)), Context::from_waker(Waker::noop()));
                let sent = (0..100).filter(|_| source.poll(&mut context).is_ready()).count();
                assert!(expected.contains(&sent), "{more}: {sent}");
            }
        });
    }
}
