//! A thread that steps a chunk of environments.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use crate::chunk::Chunk;

/// A chunk that ran, or the message of its panic.
pub(crate) type Ran = Result<Box<Chunk>, String>;

/// A thread that receives a chunk, runs it and sends it back.
pub(crate) struct Worker {
    jobs: Sender<Box<Chunk>>,
    results: Receiver<Ran>,
}

/// Runs a chunk and catches its panic.
pub(crate) fn run(mut chunk: Box<Chunk>) -> Ran {
    let ran = catch_unwind(AssertUnwindSafe(|| chunk.run()));
    ran.map(|()| chunk).map_err(|payload| {
        let text = payload.downcast_ref::<String>().map(String::as_str);
        text.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("no message").to_owned()
    })
}

impl Worker {
    /// Starts a thread. It ends when the worker is dropped.
    pub(crate) fn start(number: usize) -> std::io::Result<Self> {
        let (jobs, received) = channel::<Box<Chunk>>();
        let (sender, results) = channel();
        thread::Builder::new().name(format!("farsa-gym {number}")).spawn(move || {
            for chunk in received {
                if sender.send(run(chunk)).is_err() {
                    break;
                }
            }
        })?;
        Ok(Self { jobs, results })
    }

    /// Sends a chunk to the thread.
    pub(crate) fn send(&self, chunk: Box<Chunk>) -> Result<(), String> {
        self.jobs.send(chunk).map_err(|_| "its thread has ended".into())
    }

    /// Waits for the chunk.
    pub(crate) fn receive(&self) -> Ran {
        self.results.recv().map_err(|_| "its thread has ended".to_owned())?
    }
}
