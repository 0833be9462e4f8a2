//! Robots and scenes of this crate in rapier.
#![cfg(feature = "rapier")]
#![allow(missing_docs, clippy::unwrap_used)]

mod arena;
mod arena_motion;
#[path = "../channels/mod.rs"]
mod channels;
#[path = "../common/mod.rs"]
mod common;
mod conformance;
mod motion;
mod robust;
mod scene;
#[path = "../wheeled/mod.rs"]
mod vehicles;
mod wheeled;
