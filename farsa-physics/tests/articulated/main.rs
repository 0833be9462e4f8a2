//! Worlds of trees with contacts, against closed forms, other programs and naive oracles.
#![allow(missing_docs, clippy::unwrap_used)]

mod agreement;
#[path = "../channels/mod.rs"]
mod channels;
#[path = "../common/mod.rs"]
mod common;
mod conformance;
mod contacts;
mod energy;
mod floating;
mod forces;
mod ground;
mod halves;
mod honest;
mod icub;
mod joint_laws;
mod oracle;
mod sight;
#[path = "../sliding/mod.rs"]
mod sliding;
mod snapshot;
mod sphere;
#[path = "../wheeled/mod.rs"]
mod vehicles;
mod vision;
mod wheeled;
