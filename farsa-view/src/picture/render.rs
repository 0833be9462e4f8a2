//! A picture as a file.

use crate::error::Error;
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

    /// The picture as an SVG document of `size` [pixels].
    ///
    /// Every id in it begins with `prefix`, so that several can stand in one page.
    pub fn svg(&self, camera: Camera, size: [u32; 2], prefix: &str) -> String {
        svg(self, camera, size, prefix)
    }
}
