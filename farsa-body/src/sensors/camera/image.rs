//! A sensor that provides the pixels of a camera as channels.

use crate::ports::{BodyId, Channels, Kinematics, Sensor, Vision};
use crate::sensors::camera::Camera;

/// A sensor that reads all pixels of a camera. It has rows x columns x 3 channels in [0, 1].
///
/// The channels contain red, green and blue of each pixel, row by row from the upper left corner. A pixel is 0 if no
/// surface is in range or if the surface has no color. Note that every pixel requires a ray cast.
///
/// ```
/// use farsa_body::Pose;
/// use farsa_body::ports::{BodyId, Channels, Sensor};
/// use farsa_body::sensors::{Camera, CameraImage};
/// use farsa_body::testing::PointWorld;
///
/// // Two green balls side by side; the camera is on the first and sees the second.
/// let world = PointWorld::new(2);
/// let camera = Camera::new(BodyId(0), Pose::identity(), [4, 3], 1.0, 5.0)?;
/// let mut image = CameraImage::new(camera);
/// let mut x = vec![0.0; image.channels()];
/// image.read(&world, &mut x);
/// assert_eq!(x[3 * 5..3 * 7], [0.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
/// # Ok::<(), farsa_body::ChannelError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CameraImage<B = BodyId> {
    camera: Camera<B>,
}

impl<B: Copy> CameraImage<B> {
    /// Creates a sensor for the image of a camera.
    pub fn new(camera: Camera<B>) -> Self {
        Self { camera }
    }

    /// Gets the camera of the sensor.
    pub fn camera(&self) -> &Camera<B> {
        &self.camera
    }
}

impl<B: Copy> Channels for CameraImage<B> {
    fn channels(&self) -> usize {
        let [columns, rows] = self.camera.size();
        3 * columns * rows
    }
}

impl<B: Copy, W: Kinematics<Body = B> + Vision + ?Sized> Sensor<W> for CameraImage<B> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        for (values, seen) in out.chunks_mut(3).zip(self.camera.look(world)) {
            let color = seen.as_ref().and_then(|seen| seen.color).unwrap_or_default();
            values.iter_mut().zip(color).for_each(|(value, shade)| *value = shade);
        }
    }
}
