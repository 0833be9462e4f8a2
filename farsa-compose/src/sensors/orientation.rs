//! Orientations of bodies, without their places.

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Channels, Handles, Kinematics, Sensor};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::AXES;

/// Orientation of the robot as a quaternion x, y, z, w with w of at least 0.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Orientation {
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
}

/// Direction of up in the axes of the robot, three channels.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Up {
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
}

/// Body with the rotation of a frame in it.
#[derive(Clone, Copy, Debug)]
struct Turned {
    body: BodyId,
    frame: Pose,
}

impl Turned {
    fn new(body: Option<&String>, scene: &PartScene<'_>) -> Result<Self, Error> {
        let (body, frame) = scene.0.frame(body, "body")?;
        Ok(Self { body, frame: frame.cast() })
    }

    fn pose<W: Kinematics + Handles<Body = BodyId> + ?Sized>(&self, world: &W) -> Pose {
        world.pose(self.body).compose(&self.frame)
    }
}

/// Sensor of a quaternion.
#[derive(Clone, Debug)]
pub(super) struct OrientationSensor(Turned);

impl Channels for OrientationSensor {
    fn channels(&self) -> usize {
        4
    }
}

impl<W: Kinematics + Handles<Body = BodyId>> Sensor<W> for OrientationSensor {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let rotation = self.0.pose(world).rotation;
        // q and -q are the same orientation.
        let sign = if rotation[3] < 0.0 { -1.0 } else { 1.0 };
        out.iter_mut().zip(rotation).for_each(|(out, part)| *out = sign * part);
    }
}

/// Sensor of the vertical.
#[derive(Clone, Debug)]
pub(super) struct UpSensor(Turned);

impl Channels for UpSensor {
    fn channels(&self) -> usize {
        3
    }
}

impl<W: Kinematics + Handles<Body = BodyId>> Sensor<W> for UpSensor {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let up = self.0.pose(world).rotate_back([0.0, 0.0, 1.0]);
        out.iter_mut().zip(up).for_each(|(out, part)| *out = part);
    }
}

impl SensorPart for Orientation {
    type Sensor = OrientationSensor;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<OrientationSensor, Error> {
        Turned::new(self.body.as_ref(), scene).map(OrientationSensor)
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let part = ["x", "y", "z", "w"][channel % 4];
        Quantity::new(format!("{part} of the orientation of {}", scene.0.called(self.body.as_ref())), "1", [0.0, 1.0])
    }
}

impl SensorPart for Up {
    type Sensor = UpSensor;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<UpSensor, Error> {
        Turned::new(self.body.as_ref(), scene).map(UpSensor)
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let text =
            format!("{} of the vertical in the axes of {}", AXES[channel % 3], scene.0.called(self.body.as_ref()));
        Quantity::new(text, "1", [0.0, 1.0])
    }
}
