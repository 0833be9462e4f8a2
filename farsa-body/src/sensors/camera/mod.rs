//! Cameras with two-dimensional images. You can attach them to any body.

/// The places and sizes of colors in the image.
mod blobs;
/// All pixels as channels.
mod image;
/// The distance of two things in the image.
mod offset;
/// The place of a camera, the rays of its pixels, and the image of a point.
mod pinhole;

pub use blobs::ColorBlobs;
pub use image::CameraImage;
pub use offset::VisualOffset;
pub use pinhole::Camera;
