//! Champions of a run as events, which a worker reads after checkpoints.

use std::sync::mpsc::SyncSender;
use std::time::{Duration, Instant};

use hyper::body::Bytes;
use tokio::sync::oneshot::{self, Receiver, error::TryRecvError};

use crate::live::lab::calls::{Bench, Call, Reply, Task};
use crate::live::run_mark::FileMark;

/// Shortest time between two readings for a page, and after a failure. Each is a process.
const PAUSE: Duration = Duration::from_secs(2);
const LONG_PAUSE: Duration = Duration::from_secs(6);

/// Champions that a page receives.
#[derive(Debug)]
pub(super) struct Champions {
    tasks: SyncSender<Task>,
    /// Event that a worker reads.
    pending: Option<Receiver<Reply>>,
    /// Mark of the last checkpoint that was read, and the time of the next reading.
    known: Option<FileMark>,
    next: Instant,
    /// Event that was sent last.
    sent: Bytes,
}

impl Champions {
    pub(super) fn new(tasks: SyncSender<Task>) -> Self {
        Self { tasks, pending: None, known: None, next: Instant::now(), sent: Bytes::new() }
    }

    /// Returns the event with new champions of a run, if there are any.
    pub(super) fn event(&mut self, bench: &Bench, run: &str) -> Option<Bytes> {
        match self.pending.as_mut().map(Receiver::try_recv) {
            None => {}
            Some(Err(TryRecvError::Empty)) => return None,
            Some(Ok(reply)) if reply.status == 200 => {
                self.pending = None;
                if reply.content != self.sent {
                    self.sent = reply.content;
                    return Some(self.sent.clone());
                }
            }
            // A file that is being written is read again, also if no worker was free.
            Some(_) => {
                (self.pending, self.known) = (None, None);
                self.next = Instant::now() + LONG_PAUSE;
            }
        }
        if Instant::now() < self.next {
            return None;
        }
        let mark = bench.checkpoint(run).filter(|mark| self.known.as_ref() != Some(mark))?;
        let (answer, pending) = oneshot::channel();
        if self.tasks.try_send(Task { call: Call::Champions { run: run.to_owned() }, answer }).is_ok() {
            (self.pending, self.known) = (Some(pending), Some(mark));
            self.next = Instant::now() + PAUSE;
        }
        None
    }
}
