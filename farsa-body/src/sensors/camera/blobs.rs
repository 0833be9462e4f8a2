//! Detection of the positions and sizes of colors in the image of a camera.

use alloc::vec;
use alloc::vec::Vec;

use crate::channel::{ChannelError, groups};
use crate::ports::{BodyId, Channels, Kinematics, Sensor, Vision};
use crate::sensors::camera::Camera;
use crate::sensors::linear_camera::ColorBand;

/// A sensor that detects colors in the image of a camera, with 3 channels per color.
///
/// The first two channels are the mean position of all pixels that show the color, to the left and upwards, in units of
/// half the image's width. The third channel is the share of these pixels in the image, in [0, 1]. All three channels
/// are zero if no pixel shows the color. If an object is partly hidden, the mean position refers to its visible part,
/// as in the image of a real camera.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorBlobs<B = BodyId> {
    camera: Camera<B>,
    bands: Vec<ColorBand>,
    /// Sums over the pixels that show a band: to the left, upwards, their number.
    sums: Vec<[f32; 3]>,
}

impl<B: Copy> ColorBlobs<B> {
    /// Creates a sensor for the given colors.
    ///
    /// # Errors
    /// Returns [`ChannelError::Groups`] if there are no colors, or [`ChannelError::Range`] if a band is not finite or
    /// its ends are in the wrong order.
    pub fn new(camera: Camera<B>, bands: Vec<ColorBand>) -> Result<Self, ChannelError> {
        groups("colours", bands.len(), 1)?;
        bands.iter().try_for_each(ColorBand::check)?;
        let sums = vec![[0.0; 3]; bands.len()];
        Ok(Self { camera, bands, sums })
    }

    /// Gets the camera of the sensor.
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
