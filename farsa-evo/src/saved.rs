//! Saved strategies: their genomes are rebuilt, so only a digest of them is kept.

use crate::error::EvoError;
use crate::mutation::Mutation;
use crate::population::Population;

/// A state and the digest of the genomes that it stands for.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct Saved<T> {
    pub(crate) state: T,
    digest: u64,
}

impl<T> Saved<T> {
    pub(crate) fn new(state: T, population: &Population) -> Self {
        Self { state, digest: population.digest() }
    }

    /// Refuses a state whose genomes came out differently than when it was saved.
    pub(crate) fn check(&self, rebuilt: &Population) -> Result<(), EvoError> {
        let (saved, rebuilt) = (self.digest, rebuilt.digest());
        if saved == rebuilt { Ok(()) } else { Err(EvoError::Digest { saved, rebuilt }) }
    }
}

/// A mutation and the bits of a gene that it knows of: 16 where it says none.
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
