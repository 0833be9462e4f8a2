//! What a page carries of a run: its configuration, and individuals with all that their trials depend on.

use serde::{Deserialize, Serialize};

use crate::live::standing::Standing;

/// A run's configuration and some of its individuals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Script {
    /// `config.toml`.
    pub(crate) config: String,
    /// At least one.
    pub(crate) individuals: Vec<Evolved>,
    /// Where evolution goes on from, if it can.
    #[serde(default)]
    pub(crate) standing: Option<Standing>,
}

/// An individual of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Evolved {
    pub(crate) generation: u32,
    pub(crate) individual: u32,
    pub(crate) parameters: Vec<f32>,
    /// Of each trial, whom it met: one of each other population.
    pub(crate) opponents: Vec<Vec<Vec<f32>>>,
    /// By what observations were normalised, where they were: saved [`ObservationStatistics`](farsa_evo::ObservationStatistics).
    pub(crate) normalisation: Option<Vec<u8>>,
}
