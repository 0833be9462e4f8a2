//! Registered parts.

use std::cell::RefCell;

use farsa_body::Pose;
use farsa_body::ports::{ActuatorId, BodyId, Channels, JointId, Motor, PairId, Sensor};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_body::sensors::Point;
use farsa_lab::Error;
use serde_json::Map;

use crate::arena::ArenaWorld;
use crate::arena::field::Forager;
use crate::arena::scene::{Scene, Thing, flat, one_body, within_walls};
use crate::check::completed::{builder, channels_of};
use crate::check::source::Source;
use crate::document::{Ending, MotorKind, Placing, RewardKind, SensorKind};
use crate::part::PartScene;
use crate::part::definition::Build;
use crate::part::files::Files;
use crate::part::named_point::NamedPoint;
use crate::part::object::{PlanarEnd, PlanarMotor, PlanarSensor, PlanarStart, PlanarTerm};
use crate::part::scene::{Area, JointAbout, Surroundings, WITH_JOINTS};
use crate::part::wiring::Wiring;
use crate::parts::rule_of::RuleOf;
use crate::sensors::forager::ForagerSensor;
use crate::sensors::infrared::InfraredSensor;

/// A registered sensor.
#[derive(Clone, Debug)]
pub(crate) struct RegisteredSensor(pub(crate) Box<dyn PlanarSensor>);

impl RegisteredSensor {
    /// Updates a sensor of the robot's own state.
    pub(crate) fn feel(&mut self, forager: &Forager) {
        if let Some(sensor) = (*self.0).as_any_mut().downcast_mut::<ForagerSensor>() {
            sensor.feel(forager.energy, forager.carried);
        }
    }

    /// Gets the infrared sensors.
    pub(crate) fn infrared(&self) -> Option<&InfraredSensor> {
        (*self.0).as_any().downcast_ref()
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

impl<W: ArenaWorld> Sensor<W> for RegisteredSensor {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        world.sense(&mut *self.0, out);
    }
}

/// A registered motor.
#[derive(Clone, Debug)]
pub(crate) struct RegisteredMotor {
    motor: Box<dyn PlanarMotor>,
    /// Values at rest [channels].
    rest: Vec<f32>,
}

impl RegisteredMotor {
    /// Stops the motor and writes the corresponding values [channels].
    pub(crate) fn rest<W: ArenaWorld>(&mut self, y: &mut [f32], world: &mut W) {
        y.copy_from_slice(&self.rest);
        self.drive(y, world);
    }
}

impl Channels for RegisteredMotor {
    fn channels(&self) -> usize {
        self.motor.channels()
    }

    fn reset(&mut self) {
        self.motor.reset();
    }
}

impl<W: ArenaWorld> Motor<W> for RegisteredMotor {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        world.drive(&mut *self.motor, y);
    }
}

/// Scene of a part of a robot on wheels.
#[derive(Clone, Copy)]
pub(crate) struct PartOfPlanar<'s> {
    pub(crate) scene: &'s Scene,
    pub(crate) robot: usize,
    /// Files of the document, for sensors.
    pub(crate) files: Option<&'s Files<'s>>,
    /// Sensors with their channels, for terms.
    pub(crate) sensors: &'s [(String, [usize; 2])],
    /// Rule of a placement.
    pub(crate) rule: Option<RuleOf<'s>>,
    /// Path of the part in the document.
    pub(crate) path: &'s str,
    pub(crate) source: &'s Source,
}

impl PartOfPlanar<'_> {
    /// Returns the body of the robot, or an error for names and points of bodies.
    fn only_body(&self, body: Option<&String>, bodies: &[String], point: [f64; 3]) -> Result<BodyId, Error> {
        one_body(body, bodies, &point, self.path, self.source)?;
        Ok(self.scene.parts(self.robot).body)
    }
}

impl Surroundings for PartOfPlanar<'_> {
    fn error(&self, why: String) -> Error {
        self.source.wrong(self.path, why)
    }

    fn body(&self, name: Option<&str>) -> Result<BodyId, Error> {
        let named = name.map(|name| self.error(format!("names the body `{name}` of a robot on wheels")));
        named.map_or_else(|| Ok(self.scene.parts(self.robot).body), Err)
    }

    fn thing(&self, name: &str) -> Result<BodyId, Error> {
        self.scene.body(name, self.path, self.source)
    }

    fn area(&self, name: &str) -> Result<Area, Error> {
        match self.scene.thing(name, self.path, self.source)? {
            Thing::Area(area) => Ok(area),
            _ => Err(self.error(format!("`{name}` is no disc or rectangle"))),
        }
    }

    fn robots(&self) -> Vec<BodyId> {
        (0..self.scene.robots.len()).map(|robot| self.scene.parts(robot).body).collect()
    }

    fn joints(&self, names: &[String]) -> Result<Vec<JointId>, Error> {
        let parts = self.scene.parts(self.robot);
        if names.is_empty() {
            return Ok(parts.wheels.to_vec());
        }
        let place = |index: usize| format!("{}/joints/{index}", self.path);
        let named = names.iter().enumerate();
        named.map(|(index, name)| wheel(name, &parts, &place(index), self.source)).collect()
    }

    fn actuators(&self, joints: &[String]) -> Result<Vec<ActuatorId>, Error> {
        let parts = self.scene.parts(self.robot);
        let motor = |joint: JointId| parts.motors[usize::from(joint == parts.wheels[1])];
        Ok(self.joints(joints)?.into_iter().map(motor).collect())
    }

    fn contacts(&self, bodies: &[String], with: Option<&str>) -> Result<Vec<PairId>, Error> {
        if bodies.is_empty() && with.is_none() {
            return Ok(vec![PairId(self.scene.parts(self.robot).body.0)]);
        }
        Err(self.error("names contacts of a robot on wheels, which has one pair for all".into()))
    }

    fn collisions(&self) -> Vec<PairId> {
        self.robots().into_iter().map(|body| PairId(body.0)).collect()
    }

    fn mobile_robot(&self) -> Option<&MobileRobot> {
        self.scene.robots.get(self.robot)
    }

    fn parts(&self) -> Option<MobileParts> {
        Some(self.scene.parts(self.robot))
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
        self.files
    }

    fn has_food(&self) -> bool {
        self.scene.has_food
    }

    fn placed_before(&self, name: &str, key: &str) -> Result<BodyId, Error> {
        let path = format!("{}/{key}", self.path);
        let body = self.scene.body(name, &path, self.source)?;
        let is_placed = self.rule.is_some_and(|RuleOf { document, placed, .. }| {
            let is_fixed = document.objects.iter().any(|object| object.name == name && object.at.is_some());
            is_fixed || placed.contains(&body)
        });
        let why = || self.source.wrong(&path, format!("`{name}` has to be placed before"));
        is_placed.then_some(body).ok_or_else(why)
    }

    fn start_point(&self, at: &[f64], key: &str) -> Result<[f64; 3], Error> {
        let path = format!("{}/{key}", self.path);
        let [x, y] = flat(at, &path, self.source)?;
        if let Some(RuleOf { document, number, .. }) = self.rule {
            let place = &document.start[number].place;
            // Only lamps may be beyond the walls.
            if !document.objects.iter().any(|object| object.name == *place && object.shines()) {
                within_walls(document, [x, y], &path, self.source)?;
            }
        }
        Ok([x, y, 0.0])
    }

    fn earlier_choice(&self, name: &str, points: usize) -> Result<usize, Error> {
        let rule = self.rule.ok_or_else(|| self.error("is no placement".into()))?;
        rule.earlier_choice(name, points, self.source)
    }

    fn robot(&self) -> usize {
        self.robot
    }

    fn moves(&self, body: BodyId) -> bool {
        let is_robot = (0..self.scene.robots.len()).any(|robot| self.scene.parts(robot).body == body);
        self.scene.pulls || !self.scene.blocks.is_empty() || is_robot
    }

    fn size(&self) -> [f64; 2] {
        self.scene.size
    }

    fn cylinder(&self, name: &str, key: &str) -> Result<(BodyId, f64), Error> {
        let path = format!("{}/{key}", self.path);
        let thing = self.scene.thing(name, &path, self.source)?;
        let hint = if thing == Thing::Wall { "; the term `touch` counts walls" } else { "" };
        thing.solid().ok_or_else(|| self.source.wrong(&path, format!("`{name}` is no cylinder{hint}")))
    }

    fn areas(&self, name: &str, key: &str) -> Result<Vec<Area>, Error> {
        let path = format!("{}/{key}", self.path);
        let area = |thing: Thing| match thing {
            Thing::Area(area) => Ok(area),
            _ => Err(self.source.wrong(&path, format!("`{name}` is no disc or rectangle"))),
        };
        self.scene.things(name, &path, self.source)?.into_iter().map(area).collect()
    }

    fn group(&self, name: &str, key: &str) -> Result<[usize; 2], Error> {
        self.scene.groups.find(name, &format!("{}/{key}", self.path), self.source)
    }

    fn sensor_channels(&self, name: &str, key: &str) -> Result<[usize; 2], Error> {
        channels_of(self.sensors, name, &format!("{}/{key}", self.path), self.source)
    }

    fn target_with_reach(&self, name: &str, key: &str) -> Result<(NamedPoint, f64), Error> {
        Ok((self.target(name, key)?, 0.0))
    }

    fn part_or_thing(&self, body: Option<&String>, point: [f64; 3]) -> Result<NamedPoint, Error> {
        Ok(NamedPoint::Body(self.point(body, point)?))
    }

    fn one_joint(&self, name: &str) -> Result<JointId, Error> {
        wheel(name, &self.scene.parts(self.robot), self.path, self.source)
    }

    fn shows(&self) -> bool {
        true
    }

    fn frame(&self, body: Option<&String>, _: &str) -> Result<(BodyId, Pose<f64>), Error> {
        Ok((self.only_body(body, &[], [0.0; 3])?, Pose::identity()))
    }

    fn point(&self, body: Option<&String>, point: [f64; 3]) -> Result<Point, Error> {
        self.only_body(body, &[], point).map(Point::origin)
    }

    fn target(&self, name: &str, key: &str) -> Result<NamedPoint, Error> {
        let body = self.scene.body(name, &format!("{}/{key}", self.path), self.source)?;
        Ok(NamedPoint::Body(Point::origin(body)))
    }

    fn touching(&self, bodies: &[String], with: Option<&String>) -> Result<Vec<PairId>, Error> {
        // The pair with the number of a body covers all contacts of that body.
        Ok(vec![PairId(self.only_body(with, bodies, [0.0; 3])?.0)])
    }

    fn called(&self, _: Option<&String>) -> String {
        "the robot".into()
    }

    fn body_name(&self, _: BodyId) -> &str {
        &self.scene.robots[self.robot].name
    }

    fn joint_name(&self, joint: JointId) -> &str {
        WHEELS[usize::from(joint == self.scene.parts(self.robot).wheels[1])]
    }

    fn range(&self, _: JointId) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    fn joint(&self, names: &[String], channel: usize, _: &dyn Fn(JointId) -> bool) -> JointAbout {
        let name = names.get(channel).map_or(WHEELS[channel % 2], String::as_str).replace('-', " ");
        JointAbout { name, id: None, range: [0.0, 1.0], units: ["rad", "rad/s", "N m"], torque: None }
    }

    fn fitting(&self, names: &[String], _: &dyn Fn(JointId) -> bool) -> Result<Vec<JointId>, Error> {
        self.joints(names)
    }

    fn wiring(&self) -> Wiring {
        Wiring::default()
    }

    fn position_in(&self, _: &str, _: JointId) -> Result<f64, Error> {
        Err(self.error(WITH_JOINTS.into()))
    }

    fn open_wiring(&self) -> Option<&RefCell<Wiring>> {
        None
    }
}

/// Names of the joints.
const WHEELS: [&str; 2] = ["left-wheel", "right-wheel"];

/// Returns a wheel by name.
fn wheel(name: &str, parts: &MobileParts, path: &str, source: &Source) -> Result<JointId, Error> {
    Ok(parts.wheels[source.position(WHEELS.into_iter(), ("joint", name), path)?])
}

/// Builds a registered sensor in a scene.
pub(crate) fn sensor(given: &SensorKind, scene: PartOfPlanar<'_>) -> Result<RegisteredSensor, Error> {
    let SensorKind { kind, keys } = given;
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), WITH_JOINTS, |build| match build {
        Build::Sensor((build, _), _) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map(RegisteredSensor).map_err(|error| source.at(path, error))
}

/// Builds a registered motor in a scene.
pub(crate) fn motor(given: &MotorKind, scene: PartOfPlanar<'_>) -> Result<RegisteredMotor, Error> {
    let MotorKind { kind, keys } = given;
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), WITH_JOINTS, |build| match build {
        Build::Motor((build, _), read) => Some(build.map(|build| (build, *read))),
        _ => None,
    });
    let (build, read) = build?;
    let motor = build(keys, &PartScene::new(&scene)).map_err(|error| source.at(path, error))?;
    let part = read(keys).map_err(|error| source.at(path, error))?;
    Ok(RegisteredMotor { rest: (0..motor.channels()).map(|channel| part.rest(channel)).collect(), motor })
}

/// Rejects a term for robots with joints.
pub(crate) fn check_term(given: &RewardKind, path: &str, source: &Source) -> Result<(), Error> {
    let build = builder((&given.kind, path, source), WITH_JOINTS, |build| match build {
        Build::Term((build, _), _) => Some(*build),
        _ => None,
    });
    build.map(|_| ())
}

/// Builds a registered term in a scene.
pub(crate) fn term(given: &RewardKind, scene: PartOfPlanar<'_>) -> Result<Box<dyn PlanarTerm>, Error> {
    let RewardKind { kind, keys } = given;
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), WITH_JOINTS, |build| match build {
        Build::Term((build, _), _) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map_err(|error| source.at(path, error))
}

/// Builds a registered placement in a scene.
pub(crate) fn start(given: &Placing, scene: PartOfPlanar<'_>) -> Result<Box<dyn PlanarStart>, Error> {
    let Placing { at: kind, keys } = given;
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, &format!("{path}/at"), source), WITH_JOINTS, |build| match build {
        Build::Start((build, _), _) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map_err(|error| source.at(path, error))
}

/// Builds a registered end in a scene.
pub(crate) fn end(ending: &Ending, scene: PartOfPlanar<'_>) -> Result<Box<dyn PlanarEnd>, Error> {
    let (path, source) = (scene.path, scene.source);
    let build = builder((&ending.0, path, source), WITH_JOINTS, |build| match build {
        Build::End((build, _), _) => Some(*build),
        _ => None,
    });
    build?(&Map::new(), &PartScene::new(&scene)).map_err(|error| source.at(path, error))
}
