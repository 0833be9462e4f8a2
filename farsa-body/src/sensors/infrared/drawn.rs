//! Infrared sensors as rays to be drawn.

use alloc::vec::Vec;

use crate::pose::Pose;
use crate::recorder::Recorder;
use crate::robots::mobile::MobileRobot;
use crate::sensors::beam::Beam;

/// Infrared channels of a robot as one ray each, for recordings.
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
    /// The range of the sensors from the hull [m].
    range: f32,
    /// The height of the sensors [m].
    height: f32,
}

impl InfraredDrawing {
    /// Builds the rays of a ring of sensors in `groups` groups of neighbors, at the first sensor of each. Every sensor
    /// has its own ray where the ring cannot be divided so.
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

    /// Number of rays.
    pub fn count(&self) -> usize {
        self.rays.len()
    }

    /// Records a ray for each channel: it ends where a thing would be that gives the same reading by
    /// [`InfraredRays`](crate::sensors::infrared::InfraredRays).
    ///
    /// `x` is what each channel read when the robot was at `pose`. `met`: only those that read something, where a crowd
    /// has too many others.
    pub fn record(&self, pose: Pose, x: &[f32], met: bool, recorder: &mut dyn Recorder) {
        for (ray, &x) in self.rays.iter().zip(x).filter(|(_, x)| !met || **x > 0.0) {
            let length = self.range * (1.0 - x);
            let end = [0, 1].map(|k| ray.from[k] + length * ray.direction[k]);
            let [from, to] = [ray.from, end].map(|[u, v]| pose.transform([u, v, self.height]));
            recorder.ray(from, to, x > 0.0);
        }
    }
}
