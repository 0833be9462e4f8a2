//! How a run searches: the strategies of farsa-evo behind one face.
//!
//! - `engine`: how a run searches: the strategies of farsa-evo behind one face
//! - `evolution`: the settings of evolution that all experiments share
//! - `learning`: learning as a search: one individual, which takes a lesson after each generation
//! - `opponents`: whom an individual of one of several populations meets, in a run and when a life is lived again

pub(crate) mod engine;
pub mod evolution;
pub(crate) mod learning;
pub(crate) mod opponents;
