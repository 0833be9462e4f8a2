//! Ranks that are threads of a test.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::thread;
use std::time::Duration;

use crate::error::Error;
use crate::ranks::port::Ranks;

/// Longer than any test waits.
const LOST: Duration = Duration::from_secs(60);

type Message = (usize, [u64; 2]);

#[derive(Default)]
struct State {
    /// Messages of the current collective call, by rank.
    said: BTreeMap<usize, Vec<u8>>,
    /// Results of the last collective call, and the number of calls.
    heard: Arc<Vec<Vec<u8>>>,
    calls: usize,
    messages: Vec<VecDeque<Message>>,
    groups: BTreeMap<(usize, usize), Arc<Hub>>,
    lost: bool,
}

/// State shared by the ranks of a test.
struct Hub {
    size: usize,
    state: Mutex<State>,
    changed: Condvar,
}

/// A thread of a test as a rank.
pub(crate) struct ThreadRank {
    hub: Arc<Hub>,
    rank: usize,
}

/// Runs `work` on the given number of ranks and returns all results.
pub(crate) fn on_ranks<T: Send>(size: usize, work: impl Fn(&dyn Ranks) -> T + Sync) -> Vec<T> {
    let hub = Hub::new(size);
    thread::scope(|scope| {
        let ranks = (0..size).map(|rank| {
            let (hub, work) = (hub.clone(), &work);
            scope.spawn(move || work(&ThreadRank { hub, rank }))
        });
        let ranks: Vec<_> = ranks.collect();
        ranks.into_iter().map(|rank| rank.join().expect("a rank")).collect()
    })
}

impl Hub {
    fn new(size: usize) -> Arc<Self> {
        let state = State { messages: vec![VecDeque::new(); size], ..State::default() };
        Arc::new(Self { size, state: Mutex::new(state), changed: Condvar::new() })
    }

    fn lock(&self) -> Result<MutexGuard<'_, State>, Error> {
        let state = self.state.lock().map_err(|_| lost())?;
        if state.lost { Err(lost()) } else { Ok(state) }
    }
}

fn lost() -> Error {
    Error::Other("a rank is lost".into())
}

impl Drop for ThreadRank {
    fn drop(&mut self) {
        if thread::panicking() {
            if let Ok(mut state) = self.hub.state.lock() {
                state.lost = true;
            }
            self.hub.changed.notify_all();
        }
    }
}

impl Ranks for ThreadRank {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.hub.size
    }

    fn all_gather(&self, bytes: &[u8]) -> Result<Vec<Vec<u8>>, Error> {
        let mut state = self.hub.lock()?;
        assert!(state.messages[self.rank].is_empty(), "a message to rank {} was not received", self.rank);
        let calls = state.calls;
        assert!(state.said.insert(self.rank, bytes.to_vec()).is_none(), "rank {} speaks twice", self.rank);
        if state.said.len() == self.hub.size {
            state.heard = Arc::new(std::mem::take(&mut state.said).into_values().collect());
            state.calls += 1;
            self.hub.changed.notify_all();
        }
        while state.calls == calls {
            let (next, timed_out) = self.hub.changed.wait_timeout(state, LOST).map_err(|_| lost())?;
            state = next;
            if state.lost || timed_out.timed_out() {
                state.lost = true;
                return Err(lost());
            }
        }
        Ok(state.heard.to_vec())
    }

    fn send(&self, to: usize, message: [u64; 2]) -> Result<(), Error> {
        self.hub.lock()?.messages[to].push_back((self.rank, message));
        Ok(())
    }

    fn receive(&self) -> Result<Option<Message>, Error> {
        Ok(self.hub.lock()?.messages[self.rank].pop_front())
    }

    fn split(&self, group: usize) -> Result<Box<dyn Ranks + '_>, Error> {
        let groups = self.all_gather(&[group as u8])?;
        let mut state = self.hub.lock()?;
        let own = |rank: &usize| usize::from(groups[*rank][0]) == group;
        let (size, rank) = ((0..groups.len()).filter(own).count(), (0..self.rank).filter(own).count());
        let calls = state.calls;
        let hub = state.groups.entry((calls, group)).or_insert_with(|| Hub::new(size)).clone();
        Ok(Box::new(Self { hub, rank }))
    }
}
