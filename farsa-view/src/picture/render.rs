//! A picture as a file.

use crate::error::Error;
use crate::picture::animation::animation;
use crate::picture::camera::Camera;
use crate::picture::moment::Picture;
use crate::picture::png::png;
use crate::picture::svg::svg;

impl Picture {
    /// The picture as the bytes of a PNG file of `size` [pixels], traced ray by ray with light and shadow.
    ///
    /// # Errors
    /// [`Error::Size`] for a size that no PNG has.
    pub fn png(&self, camera: Camera, size: [u32; 2]) -> Result<Vec<u8>, Error> {
        png(self, camera, size)
    }

    /// Pictures one after the other as the bytes of an animated PNG, each of `size` [pixels] and so many milliseconds long, all
    /// through one window.
    ///
    /// # Errors
    /// [`Error::Size`] for a size that no PNG has, and for no picture or more than a thousand.
    pub fn animated_png(
        pictures: &[Self],
        camera: Camera,
        size: [u32; 2],
        milliseconds: u16,
    ) -> Result<Vec<u8>, Error> {
        animation(pictures, camera, size, milliseconds)
    }

    /// The picture as an SVG document of `size` [pixels].
    ///
    /// Every id in it begins with `prefix`, so that several can stand in one page.
    pub fn svg(&self, camera: Camera, size: [u32; 2], prefix: &str) -> String {
        svg(self, camera, size, prefix)
    }
}
