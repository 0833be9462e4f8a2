#![doc = include_str!("../README.md")]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod error;
mod page;
mod picture;
mod recording;
mod shape;

pub use error::Error;
pub use page::{LivePage, Page, readable};
pub use picture::{Beam, Camera, Picture, Push};
pub use recording::{CastRay, Channel, ImageChannel, Links, NodeParameters, Recording, Schema, Table, Touching, View};
pub use shape::{Color, Geometry, Instance, OKABE_ITO, Role, SceneObject, ShownWhile, screen_color};
