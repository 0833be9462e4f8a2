//! Part of a run that a page carries.

use serde::{Deserialize, Serialize};

use crate::live::run_state::RunState;

/// A run's configuration and some of its individuals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct PageRun {
    /// Content of `config.toml`.
    pub(crate) config: String,
    /// At least one individual, or none for a newcomer.
    pub(crate) individuals: Vec<PageIndividual>,
    /// True to add a random individual, the first of the run with this configuration.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) newcomer: bool,
    /// State from which evolution continues, where it can.
    #[serde(default, rename = "standing")]
    pub(crate) state: Option<RunState>,
}

/// An individual of a run, with everything that its episodes depend on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct PageIndividual {
    pub(crate) generation: u32,
    pub(crate) individual: u32,
    /// Its genes, where they are integers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) genes: Option<Vec<u16>>,
    pub(crate) parameters: Vec<f32>,
    /// Opponents of each trial, one of each other population.
    pub(crate) opponents: Vec<Vec<Vec<f32>>>,
    /// Saved [`ObservationStatistics`](farsa_evo::ObservationStatistics), where observations were normalized.
    pub(crate) normalisation: Option<Vec<u8>>,
}
