//! Where a run stands.

use farsa_evo::Snapshot as _;
use serde::{Deserialize, Serialize};

use crate::live::bytes::Bytes;
use crate::run::search_state::SearchState;

/// Where a run stands, with all that its next generations depend on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Standing {
    /// Finished generations.
    pub(crate) generation: u32,
    /// The state of the strategy.
    pub(super) state: Bytes,
    /// The parameters of the champions of all generations, one population's after the other's, where they are still met.
    pub(super) hall: Bytes,
    /// What was observed in all generations, where observations are normalised.
    pub(super) observed: Option<Bytes>,
}

impl Standing {
    /// Where a search stands; none of a strategy that cannot save its state.
    pub(crate) fn of(progression: &mut SearchState) -> Option<Self> {
        let state = Bytes(progression.search.snapshot()?.save());
        let hall = Bytes::from_floats(progression.hall().champions().iter().flatten().flatten());
        let observed = progression.observed.as_ref().map(|observed| Bytes(observed.save()));
        Some(Self { generation: progression.search.generation(), state, hall, observed })
    }

    /// Bytes of all parts.
    pub(crate) fn size(&self) -> usize {
        self.state.0.len() + self.hall.0.len() + self.observed.as_ref().map_or(0, |observed| observed.0.len())
    }
}
