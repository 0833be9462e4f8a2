//! Positions of markers relative to a body.

use farsa_body::ports::{BodyId, Channels, Handles, Kinematics, Sensor};
use farsa_body::sensors::{Axes, Point};

/// A sensor of a marker's position relative to a point of a body, in three channels, as `TargetPosition` for bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MarkerPosition {
    marker: usize,
    from: Point,
    axes: Axes,
    scale: f32,
    /// Position of the marker [m].
    place: [f32; 3],
}

impl MarkerPosition {
    /// Creates a sensor of `scale` times the vector to the marker of this number.
    pub(super) fn new(marker: usize, from: Point, axes: Axes, scale: f32) -> Self {
        Self { marker, from, axes, scale, place: [0.0; 3] }
    }

    /// Updates the position from those of all markers [m].
    pub(super) fn look(&mut self, markers: &[[f32; 3]]) {
        self.place = markers[self.marker];
    }
}

impl Channels for MarkerPosition {
    fn channels(&self) -> usize {
        3
    }
}

impl<W: Kinematics + Handles<Body = BodyId>> Sensor<W> for MarkerPosition {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let pose = world.pose(self.from.body);
        let from = pose.transform(self.from.at);
        let way = [0, 1, 2].map(|k| self.place[k] - from[k]);
        // R^T (p - q) in the axes of the body, otherwise p - q in those of the world.
        let way = if self.axes == Axes::Body { pose.rotate_back(way) } else { way };
        out.iter_mut().zip(way).for_each(|(o, x)| *o = x * self.scale);
    }
}
