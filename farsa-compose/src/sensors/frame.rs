//! Pose and velocity of a body of the robot's file, whose frame is off that of its segment.

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Channels, Handles, Kinematics, Sensor};
use farsa_body::sensors::Axes;

/// A sensor of the pose of a frame, in seven channels, as `BodyPose` for segments.
#[derive(Clone, Copy, Debug)]
pub(super) struct FramePose {
    body: BodyId,
    frame: Pose,
}

impl FramePose {
    /// Creates a sensor of a frame in the axes of a segment.
    pub(super) fn new(body: BodyId, frame: Pose) -> Self {
        Self { body, frame }
    }
}

impl Channels for FramePose {
    fn channels(&self) -> usize {
        7
    }
}

impl<W: Kinematics + Handles<Body = BodyId>> Sensor<W> for FramePose {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let Pose { position: [x, y, z], rotation } = world.pose(self.body).compose(&self.frame);
        let [a, b, c, w] = if rotation[3] < 0.0 { rotation.map(|q| -q) } else { rotation };
        out.iter_mut().zip([x, y, z, a, b, c, w]).for_each(|(o, value)| *o = value);
    }
}

/// A sensor of the velocity of a frame, in six channels, as `BodyVelocity` for segments.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameVelocity {
    body: BodyId,
    frame: Pose,
    axes: Axes,
}

impl FrameVelocity {
    /// Creates a sensor of a frame in the axes of a segment.
    pub(super) fn new(body: BodyId, frame: Pose, axes: Axes) -> Self {
        Self { body, frame, axes }
    }
}

impl Channels for FrameVelocity {
    fn channels(&self) -> usize {
        6
    }
}

impl<W: Kinematics + Handles<Body = BodyId>> Sensor<W> for FrameVelocity {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let (twist, pose) = (world.velocity(self.body), world.pose(self.body));
        let ([x, y, z], [u, v, w]) = (pose.rotate(self.frame.position), twist.angular);
        // v + w x r
        let turning = [v * z - w * y, w * x - u * z, u * y - v * x];
        let linear = [0, 1, 2].map(|k| twist.linear[k] + turning[k]);
        let (linear, angular) = match self.axes {
            Axes::World => (linear, twist.angular),
            Axes::Body => {
                let pose = pose.compose(&self.frame);
                (pose.rotate_back(linear), pose.rotate_back(twist.angular))
            }
        };
        out.iter_mut().zip(linear.into_iter().chain(angular)).for_each(|(o, value)| *o = value);
    }
}
