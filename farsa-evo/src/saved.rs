//! Saved strategies: their genomes are rebuilt, so only a digest of them is kept.

use crate::{EvoError, Population};

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
