//! Where colors are in a camera's image, and how large.

use alloc::vec;
use alloc::vec::Vec;

use crate::channel::{ChannelError, groups};
use crate::ports::{BodyId, Channels, Kinematics, Sensor, Vision};
use crate::sensors::camera::Camera;
use crate::sensors::linear_camera::ColorBand;

/// Reads the places of some colors in a camera's image, 3 channels a color. They are the middle of the color's pixels,
/// to the left and upwards, in halves of the image's width, and the share of all pixels in [0, 1]. All three are zero
/// where no pixel has the color.
///
/// A hidden part of a thing moves the middle of the rest, as in a real image.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorBlobs<B = BodyId> {
    camera: Camera<B>,
    bands: Vec<ColorBand>,
    /// Sums over the pixels that show a band: to the left, upwards, their number.
    sums: Vec<[f32; 3]>,
}

impl<B: Copy> ColorBlobs<B> {
    /// The blobs of these colors.
    ///
    /// # Errors
    /// [`ChannelError::Groups`] for no colors, [`ChannelError::Range`] for a band that is not finite or runs backwards.
    pub fn new(camera: Camera<B>, bands: Vec<ColorBand>) -> Result<Self, ChannelError> {
        groups("colours", bands.len(), 1)?;
        bands.iter().try_for_each(ColorBand::check)?;
        let sums = vec![[0.0; 3]; bands.len()];
        Ok(Self { camera, bands, sums })
    }

    /// The camera.
    pub fn camera(&self) -> &Camera<B> {
        &self.camera
    }
}

impl<B> Channels for ColorBlobs<B> {
    fn channels(&self) -> usize {
        3 * self.bands.len()
    }
}

impl<B: Copy, W: Kinematics<Body = B> + Vision + ?Sized> Sensor<W> for ColorBlobs<B> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        self.sums.fill([0.0; 3]);
        self.camera.look(world);
        for (index, color) in self.camera.colors().enumerate() {
            let Some(color) = color else { continue };
            let [left, up] = self.camera.pixel(index);
            for (sum, band) in self.sums.iter_mut().zip(&self.bands) {
                if band.shows(color) {
                    *sum = [sum[0] + left, sum[1] + up, sum[2] + 1.0];
                }
            }
        }
        let [columns, rows] = self.camera.size().map(|count| count as f32);
        for (values, [left, up, count]) in out.chunks_mut(3).zip(&self.sums) {
            let blob = if *count > 0.0 { [left / count, up / count, count / (columns * rows)] } else { [0.0; 3] };
            values.iter_mut().zip(blob).for_each(|(value, x)| *value = x);
        }
    }
}
