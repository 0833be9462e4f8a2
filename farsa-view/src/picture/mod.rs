//! Pictures of a moment, drawn without a browser.
//!
//! - `moment`: what a picture shows
//! - `from_recording`: a tick of a recording as a picture
//! - `camera`: from where it is seen
//! - `lit_scene`: shapes under a lamp: rays, light, shadows
//! - `marks`: arrows, rays, points and trails as strokes
//! - `outline`: polygons in the plane of the picture
//! - `draw_order`: which outline hides which
//! - `svg`, `svg_data`: the picture as SVG
//! - `png`: the picture as PNG, traced ray by ray
//! - `animation`: pictures one after the other as an animated PNG
//! - `render`: these as methods of a picture

mod animation;
pub(crate) mod camera;
mod draw_order;
mod from_recording;
mod lit_scene;
mod marks;
pub(crate) mod moment;
mod outline;
mod png;
mod render;
mod svg;
pub(crate) mod svg_data;

pub use camera::Camera;
pub use moment::{Beam, Picture, Push};
