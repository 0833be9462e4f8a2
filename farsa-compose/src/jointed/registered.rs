//! Registered parts.

use std::cell::RefCell;

use farsa_body::Pose;
use farsa_body::ports::{ActuatorId, BodyId, Channels, JointId, Motor, PairId, Sensor};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_body::sensors::Point;
use farsa_lab::Error;
use serde_json::Map;

use crate::check::completed::{builder, channels_of};
use crate::check::source::Source;
use crate::document::{Ending, MotorKind, Placing, RewardKind, SensorKind};
use crate::jointed::SpatialWorld;
use crate::jointed::scene::Scene;
use crate::part::PartScene;
use crate::part::definition::Build;
use crate::part::files::Files;
use crate::part::named_point::NamedPoint;
use crate::part::object::{SpatialEnd, SpatialMotor, SpatialSensor, SpatialStart, SpatialTerm};
use crate::part::scene::{Area, JointAbout, ON_WHEELS, Surroundings};
use crate::part::wiring::Wiring;
use crate::parts::rule_of::RuleOf;
use crate::sensors::target_position::TargetSensor;

/// A registered sensor.
#[derive(Clone, Debug)]
pub(crate) struct RegisteredSensor(pub(crate) Box<dyn SpatialSensor>);

impl RegisteredSensor {
    /// Updates the position of a marker from those of all markers [m].
    pub(crate) fn look(&mut self, markers: &[[f32; 3]]) {
        if let Some(sensor) = (*self.0).as_any_mut().downcast_mut::<TargetSensor>() {
            sensor.look(markers);
        }
    }
}

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
    /// Actuators of motors, while motors are built.
    pub(crate) wiring: Option<&'s RefCell<Wiring>>,
    /// Sensors with their channels, for terms.
    pub(crate) sensors: &'s [(String, [usize; 2])],
    /// Rule of a placement.
    pub(crate) rule: Option<RuleOf<'s>>,
    /// Path of the part in the document.
    pub(crate) path: &'s str,
    pub(crate) source: &'s Source,
}

impl PartOfSpatial<'_> {
    /// Error for a body of a file that is not at the origin of its segment. A part would measure another place.
    fn off_origin(&self, name: Option<&str>, body: BodyId) -> Error {
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
        if placement == Pose::identity() { Ok(body) } else { Err(self.off_origin(name.as_deref(), body)) }
    }

    fn thing(&self, name: &str) -> Result<BodyId, Error> {
        match self.scene.point_named(&name.to_owned(), self.path, self.source)?.0 {
            NamedPoint::Body(point) if point == Point::origin(point.body) => Ok(point.body),
            NamedPoint::Body(point) => Err(self.off_origin(Some(name), point.body)),
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
        let wiring = self.wiring();
        let actuator = |joint: &JointId| wiring.first(*joint);
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

    fn collisions(&self) -> Vec<PairId> {
        self.scene.collisions()
    }

    fn mobile_robot(&self) -> Option<&MobileRobot> {
        None
    }

    fn parts(&self) -> Option<MobileParts> {
        None
    }

    fn error_at(&self, key: &str, why: String) -> Error {
        self.source.wrong(&format!("{}/{key}", self.path), why)
    }

    fn path(&self) -> &str {
        self.path
    }

    fn line(&self) -> String {
        self.source.of(self.path)
    }

    fn files(&self) -> Option<&Files<'_>> {
        None
    }

    fn has_food(&self) -> bool {
        false
    }

    fn placed_before(&self, name: &str, key: &str) -> Result<BodyId, Error> {
        Err(self.error_at(key, format!("`{name}` has to be placed before")))
    }

    fn start_point(&self, at: &[f64], key: &str) -> Result<[f64; 3], Error> {
        let why = || self.error_at(key, format!("has {} values where 3 are wanted: x, y and z", at.len()));
        at.try_into().map_err(|_| why())
    }

    fn earlier_choice(&self, name: &str, points: usize) -> Result<usize, Error> {
        let rule = self.rule.ok_or_else(|| self.error("is no placement".into()))?;
        rule.earlier_choice(name, points, self.source)
    }

    fn robot(&self) -> usize {
        0
    }

    fn moves(&self, _: BodyId) -> bool {
        true
    }

    fn size(&self) -> [f64; 2] {
        [0.0; 2]
    }

    fn cylinder(&self, _: &str, _: &str) -> Result<(BodyId, f64), Error> {
        Err(self.error(ON_WHEELS.into()))
    }

    fn areas(&self, _: &str, _: &str) -> Result<Vec<Area>, Error> {
        Err(self.error(ON_WHEELS.into()))
    }

    fn group(&self, _: &str, _: &str) -> Result<[usize; 2], Error> {
        Err(self.error(ON_WHEELS.into()))
    }

    fn sensor_channels(&self, name: &str, key: &str) -> Result<[usize; 2], Error> {
        channels_of(self.sensors, name, &format!("{}/{key}", self.path), self.source)
    }

    fn target_with_reach(&self, name: &str, key: &str) -> Result<(NamedPoint, f64), Error> {
        self.scene.point_named(&name.to_owned(), &format!("{}/{key}", self.path), self.source)
    }

    fn part_or_thing(&self, body: Option<&String>, point: [f64; 3]) -> Result<NamedPoint, Error> {
        self.scene.part_or_thing(body, point, self.path, self.source)
    }

    fn one_joint(&self, name: &str) -> Result<JointId, Error> {
        self.scene.joint(name, self.path, self.source)
    }

    fn shows(&self) -> bool {
        self.scene.shows
    }

    fn frame(&self, body: Option<&String>, key: &str) -> Result<(BodyId, Pose<f64>), Error> {
        self.scene.body(body, &format!("{}/{key}", self.path), self.source)
    }

    fn point(&self, body: Option<&String>, point: [f64; 3]) -> Result<Point, Error> {
        self.scene.point(body, point, self.path, self.source)
    }

    fn target(&self, name: &str, key: &str) -> Result<NamedPoint, Error> {
        Ok(self.scene.point_named(&name.to_owned(), &format!("{}/{key}", self.path), self.source)?.0)
    }

    fn touching(&self, bodies: &[String], with: Option<&String>) -> Result<Vec<PairId>, Error> {
        self.scene.pairs(bodies, with, self.path, self.source)
    }

    fn called(&self, body: Option<&String>) -> String {
        body.cloned().unwrap_or_else(|| self.scene.body_name(BodyId(0)).to_owned())
    }

    fn body_name(&self, body: BodyId) -> &str {
        self.scene.body_name(body)
    }

    fn joint_name(&self, joint: JointId) -> &str {
        self.scene.joint_name(joint)
    }

    fn range(&self, joint: JointId) -> [f64; 2] {
        self.scene.range(joint)
    }

    fn joint(&self, names: &[String], channel: usize, fits: &dyn Fn(JointId) -> bool) -> JointAbout {
        let scene = self.scene;
        let mut joints = scene.robot.joints().filter(|joint| joint.index() < scene.own_bodies());
        let joint = match names.get(channel) {
            Some(name) => joints.find(|joint| scene.joint_name(*joint) == name),
            None => joints.filter(|joint| fits(*joint)).nth(channel),
        };
        let slides = joint.is_some_and(|joint| scene.is_rail(joint));
        JointAbout {
            name: joint.map_or_else(String::new, |joint| scene.joint_name(joint).to_owned()),
            id: joint,
            range: joint.map_or([0.0, 1.0], |joint| scene.range(joint)),
            units: if slides { ["m", "m/s", "N"] } else { ["rad", "rad/s", "N m"] },
            torque: joint.and_then(|joint| self.wiring().limit(joint)),
        }
    }

    fn fitting(&self, names: &[String], fits: &dyn Fn(JointId) -> bool) -> Result<Vec<JointId>, Error> {
        self.scene.joints(names, fits, self.path, self.source)
    }

    fn wiring(&self) -> Wiring {
        self.wiring.map_or_else(|| Wiring::new(&self.scene.robot), |wiring| wiring.borrow().clone())
    }

    fn position_in(&self, keyframe: &str, joint: JointId) -> Result<f64, Error> {
        let path = format!("{}/around", self.path);
        let posture = &self.scene.postures[self.scene.posture(keyframe, &path, self.source)?];
        let mut joints = self.scene.robot.joints().zip(&posture.joints);
        Ok(joints.find(|(known, _)| *known == joint).map_or(0.0, |(_, position)| *position))
    }

    fn open_wiring(&self) -> Option<&RefCell<Wiring>> {
        self.wiring
    }
}

/// Builds a registered sensor in a scene.
pub(crate) fn sensor(given: &SensorKind, scene: PartOfSpatial<'_>) -> Result<RegisteredSensor, Error> {
    let SensorKind { kind, keys } = given;
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), ON_WHEELS, |build| match build {
        Build::Sensor((_, build), _) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map(RegisteredSensor).map_err(|error| source.at(path, error))
}

/// Builds a registered motor in a scene.
pub(crate) fn motor(given: &MotorKind, scene: PartOfSpatial<'_>) -> Result<RegisteredMotor, Error> {
    let MotorKind { kind, keys } = given;
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), ON_WHEELS, |build| match build {
        Build::Motor((_, build), _) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map(RegisteredMotor).map_err(|error| source.at(path, error))
}

/// Builds a registered term in a scene.
pub(crate) fn term(given: &RewardKind, scene: PartOfSpatial<'_>) -> Result<Box<dyn SpatialTerm>, Error> {
    let RewardKind { kind, keys } = given;
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), ON_WHEELS, |build| match build {
        Build::Term((_, build), _) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map_err(|error| source.at(path, error))
}

/// Builds a registered placement in a scene.
pub(crate) fn start(given: &Placing, scene: PartOfSpatial<'_>) -> Result<Box<dyn SpatialStart>, Error> {
    let Placing { at: kind, keys } = given;
    let (path, source) = (scene.path, scene.source);
    let build = builder(
        (kind, &format!("{path}/at"), source),
        "is for robots on wheels; next to one with joints it is `in-box` or `fixed`",
        |build| match build {
            Build::Start((_, build), _) => Some(*build),
            _ => None,
        },
    );
    let build = build?;
    build(keys, &PartScene::new(&scene)).map_err(|error| source.at(path, error))
}

/// Builds a registered end in a scene.
pub(crate) fn end(ending: &Ending, scene: PartOfSpatial<'_>) -> Result<Box<dyn SpatialEnd>, Error> {
    let (path, source) = (scene.path, scene.source);
    let build = builder((&ending.0, path, source), ON_WHEELS, |build| match build {
        Build::End((_, build), _) => Some(*build),
        _ => None,
    });
    build?(&Map::new(), &PartScene::new(&scene)).map_err(|error| source.at(path, error))
}
