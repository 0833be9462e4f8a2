//! Event stream of a listener: server-sent events with new generations and champions.

use std::sync::Arc;
use std::task::{Context, Poll, ready};
use std::time::Duration;

use hyper::body::Bytes;
use tokio::time::{Interval, MissedTickBehavior, interval};

use crate::live::http::answer::{self, event};
use crate::live::log_tail::{LogTail, Part};
use crate::live::run_mark::RunMark;
use crate::live::serve::state::{Listener, NamedRun};

/// Interval at which the files of a run are checked.
pub(super) const INTERVAL: Duration = Duration::from_millis(500);
/// Intervals without an event after which a comment is sent, which detects closed connections.
const KEEP_ALIVE: u32 = 20;
/// Most parts of a log that are read without serving other connections.
const PARTS: usize = 8;

/// Events of one run. The stream ends when another run replaces it.
#[derive(Debug)]
pub(super) struct Events {
    listener: Listener,
    /// Name of the run whose events are sent.
    run: String,
    tail: LogTail,
    /// Number of the last champions that were sent.
    champions: u64,
    ticks: Interval,
    /// Intervals since the last event.
    silent: u32,
    ended: bool,
}

impl Events {
    /// Starts the events of a run after the given number of generations.
    pub(super) fn new(listener: Listener, run: String, generations: usize) -> Self {
        let tail = LogTail::new(listener.shared().directory.log(), generations);
        let mut ticks = interval(INTERVAL);
        ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
        Self { listener, run, tail, champions: 0, ticks, silent: 0, ended: false }
    }

    /// Returns an event that is due, and true if more of the log can be read at once.
    fn next(&mut self) -> (Option<Bytes>, bool) {
        let current = self.listener.shared().current();
        let Some(run) = current.run else { return (None, false) };
        if run.name != self.run {
            return (Some(self.replaced()), false);
        }
        if let Some((number, event)) = current.champions.filter(|(number, _)| *number != self.champions) {
            self.champions = number;
            return (Some(event), false);
        }
        // A file that is being written is read in the next interval.
        match self.rows(&run) {
            Some(Part::Other) => (Some(self.replaced()), false),
            Some(Part::Rows(rows, _)) if !rows.is_empty() => {
                let next = rows.last().map(|row| row.0 + 1);
                (event("fitness", next, &rows).ok(), false)
            }
            Some(Part::Rows(_, more)) => (None, more),
            None => (None, false),
        }
    }

    /// Reads rows of the given run: its marks are the same before and after.
    fn rows(&mut self, run: &Arc<NamedRun>) -> Option<Part> {
        let is_there = || RunMark::read(&self.listener.shared().directory).as_ref() == Some(&run.mark);
        let mut tail = self.tail.clone();
        if !is_there() {
            return None;
        }
        let mut part = tail.read().ok()?;
        for _ in 1..PARTS {
            match &part {
                Part::Rows(rows, true) if rows.is_empty() => part = tail.read().ok()?,
                _ => break,
            }
        }
        if !is_there() {
            return None;
        }
        self.tail = tail;
        Some(part)
    }

    /// Ends the stream with the event that another run replaced this one.
    fn replaced(&mut self) -> Bytes {
        self.ended = true;
        Bytes::from_static(b"event: replaced\ndata: {}\n\n")
    }
}

impl answer::Events for Events {
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::future::poll_fn;

    use crate::live::http::answer::Events as _;
    use crate::live::serve::state::Shared;
    use crate::store::directory::Directory;

    const HEAD: &str = "generation,best,mean,worst,evaluations,failed\n";

    /// A directory with a run of this name, and the log of its generations.
    fn place(shared: &Shared, name: &str, log: &str) {
        let directory = &shared.directory;
        fs::create_dir(directory.path()).unwrap();
        fs::write(directory.config(), name).unwrap();
        fs::write(directory.log(), format!("{HEAD}{log}")).unwrap();
    }

    /// As the other thread does when it finds a run.
    fn announce(shared: &Shared, name: &str) {
        let mark = RunMark::read(&shared.directory).unwrap();
        shared.update(|current| current.run = Some(Arc::new(NamedRun { name: name.into(), mark })));
    }

    #[test]
    fn rows_of_a_run_that_replaced_another_are_never_sent() {
        let folder = tempfile::tempdir().unwrap();
        let shared = Arc::new(Shared::new(Directory::at(folder.path().join("r"))));
        let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build().unwrap();
        runtime.block_on(async {
            place(&shared, "first", "0,1.5,1.0,0.0,4,0\n");
            announce(&shared, "first");
            let mut events = Events::new(Listener::new(shared.clone(), 1).unwrap(), "first".into(), 0);
            assert!(Listener::new(shared.clone(), 1).is_none());
            let sent = poll_fn(|context| events.poll(context)).await.unwrap();
            assert_eq!(sent, "event: fitness\nid: 1\ndata: [[0,1.5,1.0]]\n\n");
            // The other run has more generations, and the other thread has not found it yet.
            fs::rename(shared.directory.path(), folder.path().join("aside")).unwrap();
            assert_eq!(events.next(), (None, false));
            place(&shared, "other", "0,1.5,1.0,0.0,4,0\n1,7.5,7.0,7.0,4,0\n");
            assert_eq!(events.next(), (None, false));
            announce(&shared, "other");
            let sent = poll_fn(|context| events.poll(context)).await.unwrap();
            assert_eq!(sent, "event: replaced\ndata: {}\n\n");
            assert_eq!(poll_fn(|context| events.poll(context)).await, None);
            drop(events);
            assert!(!shared.has_listeners());
            // Another log in the same directory, with the same configuration.
            let mut events = Events::new(Listener::new(shared.clone(), 1).unwrap(), "other".into(), 1);
            assert!(poll_fn(|context| events.poll(context)).await.unwrap().ends_with(b"data: [[1,7.5,7.0]]\n\n"));
            let log = format!("{HEAD}0,2.5,1.0,0.0,4,0\n1,8.5,7.0,7.0,4,0\n2,9.5,7.0,7.0,4,0\n");
            fs::write(shared.directory.log(), log).unwrap();
            let sent = poll_fn(|context| events.poll(context)).await.unwrap();
            assert_eq!(sent, "event: replaced\ndata: {}\n\n");
        });
    }
}
