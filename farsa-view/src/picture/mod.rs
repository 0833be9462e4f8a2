//! Pictures of a moment, drawn without a browser.

/// Animated PNG.
mod animation;
/// Cameras and the views of pictures.
pub(crate) mod camera;
/// Order of shapes from back to front.
mod draw_order;
/// Pictures of a tick of a recording.
mod from_recording;
/// Shapes under a lamp: rays, light and shadows.
mod lit_scene;
/// Arrows, rays, points and trails as strokes.
mod marks;
/// Content of a picture.
pub(crate) mod moment;
/// Polygons in the plane of the picture.
pub(crate) mod outline;
/// Pictures as PNG, traced ray by ray.
mod png;
/// Methods that write a picture.
mod render;
/// Pictures as SVG.
mod svg;
/// Numbers, colors, paths and text of SVG.
pub(crate) mod svg_data;

pub use camera::Camera;
pub use moment::{Beam, Picture, Push};
