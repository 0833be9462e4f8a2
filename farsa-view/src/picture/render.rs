//! Methods that write a picture.

use crate::error::Error;
use crate::picture::animation::animation;
use crate::picture::camera::Camera;
use crate::picture::moment::Picture;
use crate::picture::png::png;
use crate::picture::svg::svg;

impl Picture {
    /// Returns a PNG file of `size` [pixels], traced ray by ray with light and shadow.
    ///
    /// # Errors
    /// [`Error::Size`] for an invalid size.
    pub fn png(&self, camera: Camera, size: [u32; 2]) -> Result<Vec<u8>, Error> {
        png(self, camera, size)
    }

    /// Returns an animated PNG of pictures of `size` [pixels], each shown for the given time [ms], in one view.
    ///
    /// # Errors
    /// [`Error::Size`] for an invalid size, and for no picture or more than a thousand.
    pub fn animated_png(
        pictures: &[Self],
        camera: Camera,
        size: [u32; 2],
        milliseconds: u16,
    ) -> Result<Vec<u8>, Error> {
        animation(pictures, camera, size, milliseconds)
    }

    /// Returns an SVG document of `size` [pixels].
    ///
    /// All ids start with `prefix`, so that one page can contain several pictures.
    pub fn svg(&self, camera: Camera, size: [u32; 2], prefix: &str) -> String {
        svg(self, camera, size, prefix)
    }
}
