//! Open connections and their limits.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use tokio::task::JoinHandle;

/// Time in which a client reads a part of an answer.
const STALLED: Duration = Duration::from_secs(60);

/// Phase of a connection, in the order in which connections are closed when there are too many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Phase {
    /// The head of the request is incomplete. The server of hyper limits its time.
    Receiving,
    /// An answer is sent.
    Sending,
    /// A page is built.
    Waiting,
    /// An event stream is open. It is never closed for another connection.
    Streaming,
}

/// Phase of a connection and its last progress.
#[derive(Debug)]
pub(in crate::live) struct Activity(Mutex<(Phase, Instant)>);

impl Activity {
    fn new() -> Self {
        Self(Mutex::new((Phase::Receiving, Instant::now())))
    }

    fn get(&self) -> (Phase, Instant) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn set(&self, phase: Phase) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = (phase, Instant::now());
    }

    /// Notes that the request was received.
    pub(in crate::live) fn waits(&self) {
        self.set(Phase::Waiting);
    }

    /// Notes that an answer is sent.
    pub(in crate::live) fn sends(&self) {
        self.set(Phase::Sending);
    }

    /// Notes that events are sent.
    pub(in crate::live) fn streams(&self) {
        self.set(Phase::Streaming);
    }

    /// Notes that the client has read a part of the answer.
    pub(in crate::live) fn touch(&self) {
        self.set(self.get().0);
    }

    fn is_stalled(&self, now: Instant) -> bool {
        let (phase, since) = self.get();
        matches!(phase, Phase::Sending | Phase::Streaming) && now.duration_since(since) > STALLED
    }
}

/// Tasks of all connections, by their age.
#[derive(Debug)]
pub(in crate::live) struct Connections {
    most: usize,
    next: u64,
    open: BTreeMap<u64, (Arc<Activity>, JoinHandle<()>)>,
}

impl Connections {
    pub(in crate::live) fn new(most: usize) -> Self {
        Self { most, next: 0, open: BTreeMap::new() }
    }

    /// Closes connections that make no progress, and returns true if another one can be opened.
    pub(in crate::live) fn sweep(&mut self, now: Instant) -> bool {
        self.open.retain(|_, (activity, task)| {
            if activity.is_stalled(now) {
                task.abort();
            }
            !task.is_finished()
        });
        self.open.len() < self.most
    }

    /// Closes the oldest connection of the first phase that any of them is in. Event streams stay open.
    ///
    /// Its resources are free when the task has been scheduled once.
    pub(in crate::live) fn close_oldest(&mut self) {
        let closable = self.open.iter().map(|(number, (activity, _))| (activity.get().0, *number));
        if let Some((_, number)) = closable.filter(|(phase, _)| *phase != Phase::Streaming).min() {
            self.open.remove(&number).inspect(|(_, task)| task.abort());
        }
    }

    /// Adds a connection, whose task is started by `spawn`.
    pub(in crate::live) fn open(&mut self, spawn: impl FnOnce(Arc<Activity>) -> JoinHandle<()>) {
        let activity = Arc::new(Activity::new());
        let task = spawn(activity.clone());
        self.open.insert(self.next, (activity, task));
        self.next += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::future::pending;

    #[test]
    fn idle_connections_make_room_and_streams_stay() {
        let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
        runtime.block_on(async {
            let mut connections = Connections::new(4);
            let now = Instant::now();
            for advance in [Activity::streams, Activity::waits, Activity::sends, |_: &Activity| {}] {
                assert!(connections.sweep(now));
                connections.open(|activity| {
                    advance(&activity);
                    tokio::spawn(pending())
                });
            }
            assert!(!connections.sweep(now));
            for expected in [&[0_u64, 1, 2][..], &[0, 1], &[0], &[0]] {
                connections.close_oldest();
                assert_eq!(connections.open.keys().copied().collect::<Vec<_>>(), expected);
            }
            assert!(connections.sweep(now + STALLED / 2));
            assert_eq!(connections.open.len(), 1);
            connections.sweep(now + 2 * STALLED);
            tokio::task::yield_now().await;
            assert!(connections.sweep(now) && connections.open.is_empty());
        });
    }
}
