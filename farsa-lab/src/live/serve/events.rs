//! Event stream of a listener: server-sent events with new generations and champions.

use std::sync::Arc;

use hyper::body::Bytes;

use crate::live::http::answer::event;
use crate::live::http::paced::{self, Next, REPLACED};
use crate::live::log_tail::{LogTail, Part};
use crate::live::run_mark::RunMark;
use crate::live::serve::state::{Listener, NamedRun};

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
}

impl Events {
    /// Starts the events of a run after the given number of generations.
    pub(super) fn new(listener: Listener, run: String, generations: usize) -> Self {
        let tail = LogTail::new(listener.shared().directory.log(), generations);
        Self { listener, run, tail, champions: 0 }
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
}

impl paced::Events for Events {
    fn next(&mut self) -> Next {
        let current = self.listener.shared().current();
        let Some(run) = current.run else { return Next::Nothing };
        if run.name != self.run {
            return Next::Last(Bytes::from_static(REPLACED));
        }
        if let Some((number, event)) = current.champions.filter(|(number, _)| *number != self.champions) {
            self.champions = number;
            return Next::Event(event, true);
        }
        // A file that is being written is read in the next interval.
        match self.rows(&run) {
            Some(Part::Other) => Next::Last(Bytes::from_static(REPLACED)),
            Some(Part::Rows(rows, more)) if !rows.is_empty() => {
                let next = rows.last().map(|row| row.0 + 1);
                event("fitness", next, &rows).map_or(Next::Nothing, |event| Next::Event(event, more))
            }
            Some(Part::Rows(_, true)) => Next::More,
            _ => Next::Nothing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::future::poll_fn;

    use crate::live::http::paced::{Events as _, Paced};
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
            let events = Events::new(Listener::new(shared.clone(), 1).unwrap(), "first".into(), 0);
            let mut events = Paced::new(events);
            assert!(Listener::new(shared.clone(), 1).is_none());
            let sent = poll_fn(|context| events.poll(context)).await.unwrap();
            assert_eq!(sent, "event: fitness\nid: 1\ndata: [[0,1.5,1.0]]\n\n");
            // The other run has more generations, and the other thread has not found it yet.
            fs::rename(shared.directory.path(), folder.path().join("aside")).unwrap();
            assert_eq!(events.events.next(), Next::Nothing);
            place(&shared, "other", "0,1.5,1.0,0.0,4,0\n1,7.5,7.0,7.0,4,0\n");
            assert_eq!(events.events.next(), Next::Nothing);
            announce(&shared, "other");
            let sent = poll_fn(|context| events.poll(context)).await.unwrap();
            assert_eq!(sent, "event: replaced\ndata: {}\n\n");
            assert_eq!(poll_fn(|context| events.poll(context)).await, None);
            drop(events);
            assert!(!shared.has_listeners());
            // Another log in the same directory, with the same configuration.
            let events = Events::new(Listener::new(shared.clone(), 1).unwrap(), "other".into(), 1);
            let mut events = Paced::new(events);
            assert!(poll_fn(|context| events.poll(context)).await.unwrap().ends_with(b"data: [[1,7.5,7.0]]\n\n"));
            let log = format!("{HEAD}0,2.5,1.0,0.0,4,0\n1,8.5,7.0,7.0,4,0\n2,9.5,7.0,7.0,4,0\n");
            fs::write(shared.directory.log(), log).unwrap();
            let sent = poll_fn(|context| events.poll(context)).await.unwrap();
            assert_eq!(sent, "event: replaced\ndata: {}\n\n");
        });
    }
}
