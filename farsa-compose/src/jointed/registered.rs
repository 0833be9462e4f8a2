//! Registered parts.

use farsa_body::Pose;
use farsa_body::ports::{ActuatorId, BodyId, Channels, JointId, Motor, PairId, Sensor};
use farsa_body::robots::MobileRobot;
use farsa_body::sensors::Point;
use farsa_lab::Error;

use crate::check::completed::builder;
use crate::check::source::Source;
use crate::jointed::SpatialWorld;
use crate::jointed::named_point::NamedPoint;
use crate::jointed::scene::Scene;
use crate::part::PartScene;
use crate::part::definition::{Build, Given};
use crate::part::object::{SpatialMotor, SpatialSensor, SpatialStart, SpatialTerm};
use crate::part::scene::{Area, Surroundings};

/// A registered sensor.
#[derive(Clone, Debug)]
pub(crate) struct RegisteredSensor(pub(crate) Box<dyn SpatialSensor>);

impl Channels for RegisteredSensor {
    fn channels(&self) -> usize {
        self.0.channels()
    }

    fn reset(&mut self) {
        self.0.reset();
    }
}

impl<W: SpatialWorld> Sensor<W> for RegisteredSensor {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        world.sense(&mut *self.0, out);
    }
}

/// A registered motor.
#[derive(Clone, Debug)]
pub(crate) struct RegisteredMotor(pub(crate) Box<dyn SpatialMotor>);

impl Channels for RegisteredMotor {
    fn channels(&self) -> usize {
        self.0.channels()
    }

    fn reset(&mut self) {
        self.0.reset();
    }
}

impl<W: SpatialWorld> Motor<W> for RegisteredMotor {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        world.drive(&mut *self.0, y);
    }
}

/// Scene of a part of a robot with joints.
#[derive(Clone, Copy)]
pub(crate) struct PartOfSpatial<'s> {
    pub(crate) scene: &'s Scene,
    /// Path of the part in the document.
    pub(crate) path: &'s str,
    pub(crate) source: &'s Source,
}

impl PartOfSpatial<'_> {
    /// Error for a body of a file that is not at the origin of its segment. A part would measure another place.
    fn frame(&self, name: Option<&str>, body: BodyId) -> Error {
        let (name, body) = (name.unwrap_or_default(), self.scene.body_name(body));
        self.error(format!(
            "`{name}` is not at the origin of its segment `{body}`, where a registered part would measure"
        ))
    }
}

impl Surroundings for PartOfSpatial<'_> {
    fn error(&self, why: String) -> Error {
        self.source.wrong(self.path, why)
    }

    fn body(&self, name: Option<&str>) -> Result<BodyId, Error> {
        let name = name.map(str::to_owned);
        let (body, placement) = self.scene.body(name.as_ref(), self.path, self.source)?;
        if placement == Pose::identity() { Ok(body) } else { Err(self.frame(name.as_deref(), body)) }
    }

    fn thing(&self, name: &str) -> Result<BodyId, Error> {
        match self.scene.point_named(&name.to_owned(), self.path, self.source)?.0 {
            NamedPoint::Body(point) if point == Point::origin(point.body) => Ok(point.body),
            NamedPoint::Body(point) => Err(self.frame(Some(name), point.body)),
            NamedPoint::Marker(_) => Err(self.error(format!("`{name}` is a marker, which has no body"))),
        }
    }

    fn area(&self, name: &str) -> Result<Area, Error> {
        Err(self.error(format!("`{name}` is an area, and areas are for robots on wheels")))
    }

    fn robots(&self) -> Vec<BodyId> {
        vec![BodyId(0)]
    }

    fn joints(&self, names: &[String]) -> Result<Vec<JointId>, Error> {
        self.scene.joints(names, |_| true, self.path, self.source)
    }

    fn actuators(&self, joints: &[String]) -> Result<Vec<ActuatorId>, Error> {
        let actuator = |joint: &JointId| {
            let number = self.scene.robot.actuators.iter().position(|actuator| actuator.joint == *joint);
            number.map(|number| ActuatorId(number as u16))
        };
        let named = self.joints(joints)?;
        if joints.is_empty() {
            return Ok(named.iter().filter_map(actuator).collect());
        }
        let lacks = |joint: &JointId| self.error(format!("`{}` has no actuator", self.scene.joint_name(*joint)));
        named.iter().map(|joint| actuator(joint).ok_or_else(|| lacks(joint))).collect()
    }

    fn contacts(&self, bodies: &[String], with: Option<&str>) -> Result<Vec<PairId>, Error> {
        self.scene.pairs(bodies, with.map(str::to_owned).as_ref(), self.path, self.source)
    }

    fn mobile_robot(&self) -> Option<&MobileRobot> {
        None
    }
}

/// Reason against a part of the other robots.
const OTHER: &str = "is for robots on wheels; this one has joints";

/// Builds a registered sensor in a scene.
pub(crate) fn sensor(kind: &str, keys: &Given, scene: PartOfSpatial<'_>) -> Result<RegisteredSensor, Error> {
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), OTHER, |build| match build {
        Build::Sensor((_, build), _) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map(RegisteredSensor).map_err(|error| source.at(path, error))
}

/// Builds a registered motor in a scene.
pub(crate) fn motor(kind: &str, keys: &Given, scene: PartOfSpatial<'_>) -> Result<RegisteredMotor, Error> {
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), OTHER, |build| match build {
        Build::Motor((_, build), _) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map(RegisteredMotor).map_err(|error| source.at(path, error))
}

/// Builds a registered term in a scene.
pub(crate) fn term(kind: &str, keys: &Given, scene: PartOfSpatial<'_>) -> Result<Box<dyn SpatialTerm>, Error> {
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), OTHER, |build| match build {
        Build::Term((_, build)) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map_err(|error| source.at(path, error))
}

/// Builds a registered placement in a scene.
pub(crate) fn start(kind: &str, keys: &Given, scene: PartOfSpatial<'_>) -> Result<Box<dyn SpatialStart>, Error> {
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), OTHER, |build| match build {
        Build::Start((_, build)) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map_err(|error| source.at(path, error))
}
