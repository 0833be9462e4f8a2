//! Planar worlds: collisions, conformance, sensors and motors, lanes.
#![allow(missing_docs, clippy::unwrap_used)]

mod channels;
mod collisions;
mod conformance;
mod convex;
mod hull;
mod lanes;
mod motion;
mod sensors;
mod surfaces;
