//! The whole upper body of the iCub: random commands break nothing, and a lane is the world alone.
#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
mod groups;
#[cfg(feature = "lanes")]
mod lanes;
mod random;
mod random_steps;
