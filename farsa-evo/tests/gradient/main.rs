//! The strategies that follow an estimated gradient, and the statistics of observations.
#![allow(missing_docs, clippy::unwrap_used)]

mod conformance;
mod convergence;
#[path = "../strategies/errors.rs"]
mod errors;
mod golden;
mod observation_statistics;
mod oracle;
mod settings;
