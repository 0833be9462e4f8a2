//! State that the thread of connections and the thread of pages share.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use hyper::body::Bytes;
use tokio::sync::oneshot;

use crate::live::run_mark::RunMark;
use crate::store::directory::Directory;

/// The run in the directory, and its champions.
#[derive(Debug, Clone, Default)]
pub(super) struct Current {
    /// `None` while the directory holds no run.
    pub(super) run: Option<Arc<NamedRun>>,
    /// Number of the last champions of this run, from 1, and their event.
    pub(super) champions: Option<(u64, Bytes)>,
}

/// A run and its name in pages.
#[derive(Debug)]
pub(super) struct NamedRun {
    pub(super) name: String,
    pub(super) mark: RunMark,
}

/// Request of the thread of connections.
#[derive(Debug)]
pub(super) enum Question {
    /// Page of the run.
    Page(oneshot::Sender<Result<Bytes, Unavailable>>),
    /// Update of the state.
    Champions(oneshot::Sender<()>),
}

/// Reason for an answer without a page, and its HTTP status.
#[derive(Debug, Clone)]
pub(super) struct Unavailable {
    pub(super) status: u16,
    pub(super) why: String,
}

/// State of a directory.
#[derive(Debug)]
pub(super) struct Shared {
    pub(super) directory: Directory,
    current: Mutex<Current>,
    listeners: AtomicUsize,
}

impl Shared {
    pub(super) fn new(directory: Directory) -> Self {
        Self { directory, current: Mutex::default(), listeners: AtomicUsize::new(0) }
    }

    /// Returns the state at this moment.
    pub(super) fn current(&self) -> Current {
        self.current.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Changes the state.
    pub(super) fn update(&self, change: impl FnOnce(&mut Current)) {
        change(&mut self.current.lock().unwrap_or_else(PoisonError::into_inner));
    }

    /// Returns true if an event stream is open.
    pub(super) fn has_listeners(&self) -> bool {
        self.listeners.load(Ordering::Relaxed) > 0
    }
}

/// Place of an open event stream.
#[derive(Debug)]
pub(super) struct Listener(Arc<Shared>);

impl Listener {
    /// Takes a place among at most the given number.
    pub(super) fn new(shared: Arc<Shared>, most: usize) -> Option<Self> {
        // Only the thread of connections takes places.
        if shared.listeners.load(Ordering::Relaxed) >= most {
            return None;
        }
        shared.listeners.fetch_add(1, Ordering::Relaxed);
        Some(Self(shared))
    }

    pub(super) fn shared(&self) -> &Shared {
        &self.0
    }
}

impl Drop for Listener {
    fn drop(&mut self) {
        self.0.listeners.fetch_sub(1, Ordering::Relaxed);
    }
}
