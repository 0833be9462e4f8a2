//! Sensors of a robot with joints.

use farsa_body::ports::{Channels, PairId, Sensor};
use farsa_body::sensors::{
    BodyPose, BodyVelocity, CameraImage, ColorBlobs, ContactForce, Height, JointPosition, JointSpeed, Signal,
    TargetPosition, Touch, VisualOffset,
};
use farsa_body::{ChannelError, Pose};
use farsa_lab::Error;

use crate::check::source::Source;
use crate::document::SensorKind;
use crate::jointed::SpatialWorld;
use crate::jointed::eyes::{blobs, image, offset};
use crate::jointed::frame::{FramePose, FrameVelocity};
use crate::jointed::marker_position::MarkerPosition;
use crate::jointed::named_point::NamedPoint;
use crate::jointed::registered::{self, PartOfSpatial, RegisteredSensor};
use crate::jointed::scene::Scene;
use crate::parts::eye::{Eye, eye};

/// A sensor of a robot with joints.
#[derive(Clone, Debug)]
pub(crate) enum Sensing {
    JointPosition(Vec<JointPosition>),
    JointSpeed(Vec<JointSpeed>),
    Touch(Touch<Vec<PairId>>),
    ContactForce(ContactForce<Vec<PairId>>),
    Target(TargetPosition),
    Marker(MarkerPosition),
    Pose(BodyPose),
    FramePose(FramePose),
    Velocity(BodyVelocity),
    FrameVelocity(FrameVelocity),
    Height(Height),
    Camera(Camera),
    Image(CameraImage),
    Blobs(ColorBlobs),
    Offset(VisualOffset),
    Constant(Signal<1>),
    Registered(RegisteredSensor),
}

/// Calls a method of the sensor of any kind.
macro_rules! sensor {
    ($sensing:expr, $sensor:ident => $call:expr) => {
        match $sensing {
            Sensing::JointPosition($sensor) => $call,
            Sensing::JointSpeed($sensor) => $call,
            Sensing::Touch($sensor) => $call,
            Sensing::ContactForce($sensor) => $call,
            Sensing::Target($sensor) => $call,
            Sensing::Marker($sensor) => $call,
            Sensing::Pose($sensor) => $call,
            Sensing::FramePose($sensor) => $call,
            Sensing::Velocity($sensor) => $call,
            Sensing::FrameVelocity($sensor) => $call,
            Sensing::Height($sensor) => $call,
            Sensing::Camera($sensor) => $call,
            Sensing::Image($sensor) => $call,
            Sensing::Blobs($sensor) => $call,
            Sensing::Offset($sensor) => $call,
            Sensing::Constant($sensor) => $call,
            Sensing::Registered($sensor) => $call,
        }
    };
}

/// A camera with sectors. Some worlds have nothing for it to see.
#[derive(Clone, Debug)]
pub(crate) struct Camera(Eye);

impl Channels for Camera {
    fn channels(&self) -> usize {
        self.0.channels()
    }

    fn reset(&mut self) {
        self.0.reset();
    }
}

impl<W: SpatialWorld> Sensor<W> for Camera {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        world.show(&mut self.0, out);
    }
}

impl Channels for Sensing {
    fn channels(&self) -> usize {
        sensor!(self, sensor => sensor.channels())
    }

    fn reset(&mut self) {
        sensor!(self, sensor => sensor.reset());
    }
}

impl<W: SpatialWorld> Sensor<W> for Sensing {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        sensor!(self, sensor => sensor.read(world, out));
    }
}

impl Sensing {
    /// Gets the camera of an image.
    pub(crate) fn camera(&self) -> Option<&farsa_body::sensors::Camera> {
        match self {
            Self::Image(image) => Some(image.camera()),
            Self::Blobs(blobs) => Some(blobs.camera()),
            _ => None,
        }
    }

    /// Updates the position of a marker from those of all markers [m].
    pub(crate) fn look(&mut self, markers: &[[f32; 3]]) {
        if let Self::Marker(marker) = self {
            marker.look(markers);
        }
    }
}

/// Reason against a part of robots on wheels.
pub(crate) const ON_WHEELS: &str = "is for robots on wheels; this one has joints";

/// Builds the sensor at a path of the document.
pub(crate) fn sensor(kind: &SensorKind, scene: &Scene, path: &str, source: &Source) -> Result<Sensing, Error> {
    let wrong = |error: ChannelError| source.wrong(path, error);
    let body = |name: &Option<String>| scene.body(name.as_ref(), &format!("{path}/body"), source);
    Ok(match kind {
        SensorKind::JointPosition { joints, from, to } => {
            let build = |joint| {
                let [low, high] = scene.range(joint);
                let ends = [from.unwrap_or(low), to.unwrap_or(high)].map(|end| end as f32);
                let why = || format!("lacks `from` or `to`: `{}` has no range of its own", scene.joint_name(joint));
                if ends.iter().all(|end| end.is_finite()) {
                    return JointPosition::new(joint, ends[0], ends[1]).map_err(wrong);
                }
                Err(source.wrong(path, why()))
            };
            let joints = scene.joints(joints, |_| true, path, source)?;
            Sensing::JointPosition(joints.into_iter().map(build).collect::<Result<_, _>>()?)
        }
        SensorKind::JointSpeed { joints } => {
            let joints = scene.joints(joints, |_| true, path, source)?;
            Sensing::JointSpeed(joints.into_iter().map(JointSpeed::new).collect())
        }
        SensorKind::Touch { bodies, with } => {
            let pairs = scene.pairs(bodies, with.as_ref(), path, source)?;
            Sensing::Touch(Touch::new(pairs, 1.0).map_err(wrong)?)
        }
        SensorKind::ContactForce { bodies, with } => {
            Sensing::ContactForce(ContactForce::new(scene.pairs(bodies, with.as_ref(), path, source)?))
        }
        SensorKind::TargetPosition { target, body, point, axes, scale } => {
            let from = scene.point(body.as_ref(), *point, path, source)?;
            match scene.point_named(target, &format!("{path}/target"), source)?.0 {
                NamedPoint::Body(target) => {
                    Sensing::Target(TargetPosition::new(target, from, (*axes).into(), *scale as f32).map_err(wrong)?)
                }
                NamedPoint::Marker(marker) => {
                    Sensing::Marker(MarkerPosition::new(marker, from, (*axes).into(), *scale as f32))
                }
            }
        }
        SensorKind::BodyPose { body: name } => match body(name)? {
            (body, frame) if frame == Pose::identity() => Sensing::Pose(BodyPose::new(body)),
            (body, frame) => Sensing::FramePose(FramePose::new(body, frame.cast())),
        },
        SensorKind::BodyVelocity { body: name, axes } => match body(name)? {
            (body, frame) if frame == Pose::identity() => Sensing::Velocity(BodyVelocity::new(body, (*axes).into())),
            (body, frame) => Sensing::FrameVelocity(FrameVelocity::new(body, frame.cast(), (*axes).into())),
        },
        SensorKind::Height { body, point } => {
            Sensing::Height(Height::new(scene.point(body.as_ref(), *point, path, source)?))
        }
        SensorKind::Camera(camera) => {
            let (body, placement) = scene.body(camera.body.as_ref(), &format!("{path}/body"), source)?;
            if placement != Pose::identity() {
                let why = format!("lies within `{}`; a camera is at the origin of a body", scene.body_name(body));
                return Err(source.wrong(&format!("{path}/body"), why));
            }
            Sensing::Camera(Camera(eye(body, camera).map_err(wrong)?))
        }
        SensorKind::CameraImage { eye } => Sensing::Image(image(eye, scene, path, source)?),
        SensorKind::ColorBlobs { eye, colors } => Sensing::Blobs(blobs(eye, colors, scene, path, source)?),
        SensorKind::VisualOffset { eye, of, from } => Sensing::Offset(offset(eye, [of, from], scene, path, source)?),
        SensorKind::Constant { value } => Sensing::Constant(Signal::new([*value as f32])),
        SensorKind::Registered { kind, keys } => {
            Sensing::Registered(registered::sensor(kind, keys, PartOfSpatial { scene, path, source })?)
        }
        _ => return Err(source.wrong(path, ON_WHEELS)),
    })
}
