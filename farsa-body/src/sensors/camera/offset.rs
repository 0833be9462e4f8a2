//! The distance of two things in a camera's image.

use crate::ports::{BodyId, Channels, Kinematics, Sensor};
use crate::sensors::camera::Camera;

/// Reads the distance between two things in a camera's image, 2 channels in [-1, 1]: to the left and upwards, in widths
/// of the image. Both are 0 where a thing is behind the camera.
///
/// Both are points of bodies and count as seen whether or not something hides them. Only the place and the field of
/// view of the camera matter, so one pixel is enough.
#[derive(Clone, Debug, PartialEq)]
pub struct VisualOffset<B = BodyId> {
    camera: Camera<B>,
    of: (B, [f32; 3]),
    from: (B, [f32; 3]),
}

impl<B: Copy> VisualOffset<B> {
    /// The offset of a point [m] of one body from a point of another, each in its body's frame.
    pub fn new(camera: Camera<B>, of: (B, [f32; 3]), from: (B, [f32; 3])) -> Self {
        Self { camera, of, from }
    }

    /// The camera.
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
