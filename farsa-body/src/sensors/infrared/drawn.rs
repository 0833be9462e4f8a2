//! Rays that represent infrared sensors in recordings.

use alloc::vec::Vec;

use crate::pose::Pose;
use crate::recorder::Recorder;
use crate::robots::mobile::MobileRobot;
use crate::sensors::beam::Beam;

/// Converts the infrared channels of a robot to rays that can be drawn in recordings.
///
/// ```
/// use farsa_body::robots::MobileRobot;
/// use farsa_body::sensors::infrared::InfraredDrawing;
/// use farsa_body::{Pose, Recorder};
///
/// #[derive(Default)]
/// struct Rays(Vec<([f32; 3], [f32; 3], bool)>);
/// impl Recorder for Rays {
///     fn ray(&mut self, from: [f32; 3], to: [f32; 3], hit: bool) {
///         self.0.push((from, to, hit));
///     }
///     fn tick(&mut self, _: f64) {}
/// }
///
/// // Something is near the first sensor of eight.
/// let drawing = InfraredDrawing::for_robot(&MobileRobot::e_puck(), 8);
/// let mut rays = Rays::default();
/// drawing.record(Pose::planar([0.0, 0.0], 0.0), &[0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], true, &mut rays);
/// assert_eq!(rays.0.len(), 1);
/// assert!((rays.0[0].1[1] - (0.035 + 0.025)).abs() < 1e-6 && rays.0[0].2);
/// ```
#[derive(Clone, Debug)]
pub struct InfraredDrawing {
    /// Where each ray leaves the hull, and its direction, in the robot's frame.
    rays: Vec<Beam>,
    /// Range of the sensors from the hull [m].
    range: f32,
    /// Height of the sensors [m].
    height: f32,
}

impl InfraredDrawing {
    /// Creates one ray for each of `groups` groups of neighboring sensors, at the first sensor of the group. If the
    /// ring cannot be divided into groups of equal size, each sensor has a separate ray.
    pub fn for_robot(robot: &MobileRobot, groups: usize) -> Self {
        let angles = &robot.infrared.angles;
        let divided = groups > 0 && angles.len().is_multiple_of(groups);
        let size = if divided { (angles.len() / groups).max(1) } else { 1 };
        Self {
            rays: angles.iter().step_by(size).map(|angle| Beam::in_cone(robot.radius, *angle, 0.0, 0, 1)).collect(),
            range: robot.infrared.range as f32,
            height: (0.5 * robot.height) as f32,
        }
    }

    /// Gets the number of rays.
    pub fn count(&self) -> usize {
        self.rays.len()
    }

    /// Records one ray per channel. A ray ends at the distance at which
    /// [`InfraredRays`](crate::sensors::infrared::InfraredRays) would read the same value.
    ///
    /// The values `x` must have been read when the robot was at `pose`. If `met` is true, channels that detect nothing
    /// are omitted. This is useful when there are many robots.
    pub fn record(&self, pose: Pose, x: &[f32], met: bool, recorder: &mut dyn Recorder) {
        for (ray, &x) in self.rays.iter().zip(x).filter(|(_, x)| !met || **x > 0.0) {
            let length = self.range * (1.0 - x);
            let end = [0, 1].map(|k| ray.from[k] + length * ray.direction[k]);
            let [from, to] = [ray.from, end].map(|[u, v]| pose.transform([u, v, self.height]));
            recorder.ray(from, to, x > 0.0);
        }
    }
}
