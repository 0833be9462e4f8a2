//! The reference experiments: what happens in them, and what their parts compute.
#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;

mod compositional_instructions;
mod discrimination;
mod double_pole;
mod exports;
mod icub_reach_grasp;
mod kinesthetic;
mod lesions;
mod minimal_cognition;
mod normalised;
mod protocols;
mod reach_postures;
mod reach_scene;
mod stepping;
mod walking;
