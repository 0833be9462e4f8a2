//! Velocities of bodies.

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Channels, Handles, Kinematics, Sensor};
use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::AXES;
use crate::sensors::axes::AxesName;
use crate::sensors::frame::FrameVelocity;

/// Velocity of the robot [m/s] and angular velocity [rad/s], three channels each.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct BodyVelocity {
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
    /// Axes of the velocity.
    #[serde(default)]
    axes: AxesName,
}

/// The velocity of a segment, or of a frame in one.
#[derive(Clone, Debug)]
pub(super) enum VelocitySensor {
    Body(sensors::BodyVelocity),
    Frame(FrameVelocity),
}

impl Channels for VelocitySensor {
    fn channels(&self) -> usize {
        6
    }
}

impl<W: Kinematics + Handles<Body = BodyId>> Sensor<W> for VelocitySensor {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        match self {
            Self::Body(velocity) => velocity.read(world, out),
            Self::Frame(velocity) => velocity.read(world, out),
        }
    }
}

impl SensorPart for BodyVelocity {
    type Sensor = VelocitySensor;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<VelocitySensor, Error> {
        let axes = self.axes.into();
        Ok(match scene.0.frame(self.body.as_ref(), "body")? {
            (body, frame) if frame == Pose::identity() => VelocitySensor::Body(sensors::BodyVelocity::new(body, axes)),
            (body, frame) => VelocitySensor::Frame(FrameVelocity::new(body, frame.cast(), axes)),
        })
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let [what, unit] = if channel < 3 { ["velocity", "m/s"] } else { ["angular velocity", "rad/s"] };
        let axis = AXES[channel % 3];
        let text = if scene.mobile_robot().is_some() {
            format!("{axis} of the robot's {what}")
        } else {
            let own = if self.axes == AxesName::Body { " in its axes" } else { "" };
            format!("{axis} of the {what} of {}{own}", scene.0.called(self.body.as_ref()))
        };
        Quantity::new(text, unit, [0.0, 1.0])
    }
}
