//! Poses of bodies.

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Channels, Handles, Kinematics, Sensor};
use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::AXES;
use crate::sensors::frame::FramePose;

/// Pose of the robot: x, y, z [m] and a quaternion.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct BodyPose {
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
}

/// The pose of a segment, or of a frame in one.
#[derive(Clone, Debug)]
pub(super) enum PoseSensor {
    Body(sensors::BodyPose),
    Frame(FramePose),
}

impl Channels for PoseSensor {
    fn channels(&self) -> usize {
        7
    }
}

impl<W: Kinematics + Handles<Body = BodyId>> Sensor<W> for PoseSensor {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        match self {
            Self::Body(pose) => pose.read(world, out),
            Self::Frame(pose) => pose.read(world, out),
        }
    }
}

impl SensorPart for BodyPose {
    type Sensor = PoseSensor;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<PoseSensor, Error> {
        Ok(match scene.0.frame(self.body.as_ref(), "body")? {
            (body, frame) if frame == Pose::identity() => PoseSensor::Body(sensors::BodyPose::new(body)),
            (body, frame) => PoseSensor::Frame(FramePose::new(body, frame.cast())),
        })
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let body = scene.0.called(self.body.as_ref());
        if channel < 3 {
            return Quantity::new(format!("{} of {body}", AXES[channel]), "m", [0.0, 1.0]);
        }
        let part = ["x", "y", "z", "w"][(channel - 3) % 4];
        let text = if scene.mobile_robot().is_some() {
            format!("{part} of the robot's orientation")
        } else {
            format!("{part} of the orientation of {body}")
        };
        Quantity::new(text, "1", [0.0, 1.0])
    }
}
