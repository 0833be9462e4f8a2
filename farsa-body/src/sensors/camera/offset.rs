//! The offset between two objects in the image of a camera.

use crate::ports::{BodyId, Channels, Kinematics, Sensor};
use crate::sensors::camera::Camera;

/// A sensor that measures the offset between two points in the image of a camera. Its two channels are the offsets to
/// the left and upwards in units of the image's width, in [-1, 1]. Both are 0 if one of the points is behind the
/// camera.
///
/// The points are attached to bodies and are visible even if something is in front of them. Since only the pose and the
/// field of view of the camera are used, an image of one pixel is sufficient.
#[derive(Clone, Debug, PartialEq)]
pub struct VisualOffset<B = BodyId> {
    camera: Camera<B>,
    of: (B, [f32; 3]),
    from: (B, [f32; 3]),
}

impl<B: Copy> VisualOffset<B> {
    /// Creates a sensor for the offset of the point `of` from the point `from`. Each point is given in the frame of its
    /// body (in meters).
    pub fn new(camera: Camera<B>, of: (B, [f32; 3]), from: (B, [f32; 3])) -> Self {
        Self { camera, of, from }
    }

    /// Gets the camera of the sensor.
    pub fn camera(&self) -> &Camera<B> {
        &self.camera
    }
}

impl<B> Channels for VisualOffset<B> {
    fn channels(&self) -> usize {
        2
    }
}

impl<B: Copy, W: Kinematics<Body = B> + ?Sized> Sensor<W> for VisualOffset<B> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let eye = self.camera.pose(world);
        let place = |(body, point): (B, [f32; 3])| world.pose(body).transform(point);
        let places = [self.of, self.from].map(|thing| self.camera.project(&eye, place(thing)));
        let offset = match places {
            [Some(of), Some(from)] => [0, 1].map(|k| (0.5 * (of[k] - from[k])).clamp(-1.0, 1.0)),
            _ => [0.0; 2],
        };
        out.iter_mut().zip(offset).for_each(|(value, x)| *value = x);
    }
}
