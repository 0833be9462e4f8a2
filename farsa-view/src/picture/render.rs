//! Methods that write a picture.

use crate::error::Error;
use crate::picture::animation::animation;
use crate::picture::camera::Camera;
use crate::picture::moment::Picture;
use crate::picture::png::{png, rgb};
use crate::picture::svg::svg;

impl Picture {
    /// Renders a PNG file of `size` [pixels]. It is traced ray by ray, with light and shadow.
    ///
    /// # Errors
    /// Returns [`Error::Size`] if the size is invalid.
    pub fn png(&self, camera: Camera, size: [u32; 2]) -> Result<Vec<u8>, Error> {
        png(self, camera, size)
    }

    /// Renders the red, green and blue bytes of `size` [pixels], row by row from the upper left corner, as in
    /// [`png`](Self::png).
    pub fn rgb(&self, camera: Camera, size: [u32; 2]) -> Vec<u8> {
        rgb(self, camera, size)
    }

    /// Renders an animated PNG of `size` [pixels]. Each picture is shown for the given time [ms].
    ///
    /// All pictures share one view, so the camera does not move.
    ///
    /// # Errors
    /// Returns [`Error::Size`] if the size is invalid, or if there are no pictures or more than a thousand.
    pub fn animated_png(
        pictures: &[Self],
        camera: Camera,
        size: [u32; 2],
        milliseconds: u16,
    ) -> Result<Vec<u8>, Error> {
        animation(pictures, camera, size, milliseconds)
    }

    /// Draws an SVG document of `size` [pixels].
    ///
    /// All ids start with `prefix`, so that a page can contain several pictures.
    pub fn svg(&self, camera: Camera, size: [u32; 2], prefix: &str) -> String {
        svg(self, camera, size, prefix)
    }
}
