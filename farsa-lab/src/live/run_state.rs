//! State of a search, from which it continues.

use farsa_evo::Snapshot as _;
use farsa_num::crc32;
use serde::{Deserialize, Serialize};

use crate::live::bytes::Bytes;
use crate::run::search_state::SearchState;

/// Everything that the next generations of a run depend on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct RunState {
    /// Finished generations.
    pub(crate) generation: u32,
    /// Saved state of the strategy.
    pub(super) state: Bytes,
    /// Parameters of the champions of all generations, population after population, where they are still opponents.
    pub(super) hall: Bytes,
    /// Statistics of all observations, where observations are normalized.
    pub(super) observed: Option<Bytes>,
}

/// Number of finished generations and checksum of the strategy's state after them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub(crate) struct StateMark {
    pub(crate) generation: u32,
    pub(crate) state_crc32: u32,
}

impl StateMark {
    pub(crate) fn new(generation: u32, state: &[u8]) -> Self {
        Self { generation, state_crc32: crc32(state) }
    }
}

impl RunState {
    pub(crate) fn mark(&self) -> StateMark {
        StateMark::new(self.generation, &self.state.0)
    }

    /// Finds the state of a search, or `None` if the strategy cannot save its state.
    pub(crate) fn of(search: &mut SearchState) -> Option<Self> {
        let state = Bytes(search.search.snapshot()?.save());
        let hall = Bytes::from_floats(search.hall().champions().iter().flatten().flatten());
        let observed = search.observed.as_ref().map(|observed| Bytes(observed.save()));
        Some(Self { generation: search.search.generation(), state, hall, observed })
    }

    /// Gets the number of bytes of all parts.
    pub(crate) fn size(&self) -> usize {
        self.state.0.len() + self.hall.0.len() + self.observed.as_ref().map_or(0, |observed| observed.0.len())
    }
}
