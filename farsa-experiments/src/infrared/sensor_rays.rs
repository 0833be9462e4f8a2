//! Infrared sensors as rays to be drawn.

use farsa_body::{Beam, MobileRobot, Pose, Recorder};

/// The infrared sensors of a robot as one ray each: where it leaves the hull and its direction, in the robot's frame.
#[derive(Clone, Debug)]
pub(crate) struct SensorRays {
    rays: Vec<Beam>,
    /// How far the sensors see from the hull \[m\].
    range: f32,
    /// How high they sit \[m\].
    height: f32,
}

/// Which rays are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RayFilter {
    /// All of them.
    All,
    /// Those of sensors that read something: a crowd has too many others.
    Met,
}

impl SensorRays {
    /// Those of all sensors of a robot.
    pub(crate) fn for_robot(robot: &MobileRobot) -> Self {
        Self {
            rays: robot.infrared.angles.iter().map(|angle| Beam::in_cone(robot.radius, *angle, 0.0, 0, 1)).collect(),
            range: robot.infrared.range as f32,
            height: (0.5 * robot.height) as f32,
        }
    }

    /// Number of sensors.
    pub(crate) fn count(&self) -> usize {
        self.rays.len()
    }

    /// Records a ray for each sensor: it ends where an object would be that gives the same reading.
    ///
    /// `x` is what each sensor read when the robot was at `pose`.
    pub(crate) fn record(&self, pose: Pose, x: &[f32], filter: RayFilter, recorder: &mut dyn Recorder) {
        for (ray, &x) in self.rays.iter().zip(x).filter(|(_, x)| filter == RayFilter::All || **x > 0.0) {
            let length = self.range * (1.0 - x);
            let end = [0, 1].map(|k| ray.from[k] + length * ray.direction[k]);
            let [from, to] = [ray.from, end].map(|[u, v]| pose.transform([u, v, self.height]));
            recorder.ray(from, to, x > 0.0);
        }
    }
}
