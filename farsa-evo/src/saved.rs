//! Saved strategies.

use alloc::vec::Vec;

use crate::error::EvoError;
use crate::snapshot::Snapshot;
use crate::words::mutation::Mutation;

/// A strategy as it is saved: what it was made of, and its state.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct SavedStrategy<C> {
    pub(crate) config: C,
    pub(crate) seed: u64,
    pub(crate) state: Vec<u8>,
}

impl<C> SavedStrategy<C> {
    pub(crate) fn new(config: C, seed: u64, strategy: &dyn Snapshot) -> Self {
        Self { config, seed, state: strategy.save() }
    }

    /// Returns an error for a state that is too short for the genes of all `individuals`, before memory is allocated. A
    /// forged configuration may claim any number of them.
    ///
    /// # Errors
    /// Returns [`EvoError::State`].
    pub(crate) fn holds(&self, individuals: usize, genes: usize) -> Result<(), EvoError> {
        let (expected, found) = (individuals.saturating_mul(genes).saturating_mul(2), self.state.len());
        if expected <= found { Ok(()) } else { Err(EvoError::state_length(expected, found)) }
    }
}

/// A mutation and the bits of its genes, 16 unless given.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Mutation")]
pub(crate) enum SavedMutation {
    Resample,
    Flip,
    ResampleOf(u32),
    FlipOf(u32),
}

impl From<SavedMutation> for (Mutation, u32) {
    fn from(saved: SavedMutation) -> Self {
        match saved {
            SavedMutation::Resample => (Mutation::Resample, u16::BITS),
            SavedMutation::Flip => (Mutation::Flip, u16::BITS),
            SavedMutation::ResampleOf(bits) => (Mutation::Resample, bits),
            SavedMutation::FlipOf(bits) => (Mutation::Flip, bits),
        }
    }
}

impl From<(Mutation, u32)> for SavedMutation {
    fn from(from: (Mutation, u32)) -> Self {
        match from {
            (Mutation::Resample, u16::BITS) => Self::Resample,
            (Mutation::Flip, u16::BITS) => Self::Flip,
            (Mutation::Resample, bits) => Self::ResampleOf(bits),
            (Mutation::Flip, bits) => Self::FlipOf(bits),
        }
    }
}
