//! Cameras with an image, on any body.
//!
//! - `pinhole`: where a camera is, where its pixels look to, and where a point is in its image
//! - `image`: all pixels as channels
//! - `blobs`: where colours are in the image, and how large
//! - `offset`: how far apart two things are in the image

mod blobs;
mod image;
mod offset;
mod pinhole;

pub use blobs::ColorBlobs;
pub use image::CameraImage;
pub use offset::VisualOffset;
pub use pinhole::Camera;
