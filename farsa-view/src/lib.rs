#![doc = include_str!("../README.md")]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod error;
mod page;
mod picture;
mod recording;
pub mod shape;

pub use error::Error;
pub use page::{LabPage, LivePage, Page, readable};
pub use picture::{Beam, Camera, Picture, Push};
pub use recording::{CastRay, Channel, ImageChannel, Links, NodeParameters, Recording, Schema, Table, Touching, View};
