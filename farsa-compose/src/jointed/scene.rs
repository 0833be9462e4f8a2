//! Robot with the floor and the objects, and the parts that names refer to.

use std::sync::Arc;

use farsa_body::Pose;
use farsa_body::ports::{BodyId, JointId, PairId};
use farsa_body::robot::{Collider, Robot, Shape, Surface};
use farsa_body::sensors::Point;
use farsa_lab::Error;
use farsa_models::mjcf::Keyframe;
use farsa_num::Scalar;
use farsa_view::shape::{Geometry, Role, SceneMesh, SceneObject};

use crate::check::source::Source;
use crate::document::{Document, Engine};
use crate::jointed::robot_model::RobotModel;
use crate::jointed::things::{Marker, Thing, What};
use crate::part::named_point::NamedPoint;

/// Scene of a document.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    /// Robot and things as one description.
    pub(crate) robot: Robot,
    /// Numbers of the robot's own segments and colliders.
    own: [usize; 2],
    frames: Vec<(String, Option<BodyId>, Pose<f64>)>,
    /// States of the robot from which a trial can start.
    pub(crate) postures: Vec<Keyframe>,
    pub(crate) things: Vec<Thing>,
    pub(crate) markers: Vec<Marker>,
    /// Drawn objects other than the robot.
    pub(crate) drawn: Vec<SceneObject>,
    /// Meshes of the robot.
    pub(crate) meshes: Arc<[SceneMesh]>,
    /// Collider of the floor.
    floor: Option<usize>,
    /// True for an engine in which cameras with sectors see.
    pub(crate) shows: bool,
}

/// Names of the robot and of the floor.
pub(crate) const ROBOT: &str = "robot";
const FLOOR: &str = "floor";

impl Scene {
    /// Builds the robot of a document with its surroundings.
    pub(crate) fn new(document: &Document, source: &Source) -> Result<Self, Error> {
        let RobotModel { mut robot, frames, touches, postures, meshes } = RobotModel::new(document, source)?;
        let shows = document.world.engine != Engine::Rapier;
        let own = [robot.segments.len(), robot.colliders.len()];
        let (mut things, mut markers, mut drawn) = (Vec::new(), Vec::new(), Vec::new());
        let floor = document.world.floor.then(|| {
            drawn.push(SceneObject::new(FLOOR, Geometry::Plane, Pose::identity(), Role::Ground));
            robot.add_collider(Collider::new(FLOOR, None, Shape::Plane, Pose::identity()))
        });
        for (index, object) in document.objects.iter().enumerate() {
            let path = format!("/objects/{index}");
            let is_taken = |name: &str| {
                let of_robot =
                    robot.body(name).is_some() || robot.joint(name).is_some() || robot.collider(name).is_some();
                of_robot || frames.iter().any(|(own, ..)| own == name)
            };
            let named = [ROBOT, FLOOR].contains(&object.name.as_str()) || is_taken(&object.name);
            if named || things.iter().any(|thing: &Thing| thing.name == object.name) {
                let why = format!("`{}` names something else already", object.name);
                return Err(source.wrong(&format!("{path}/name"), why));
            }
            things.push(Thing::add(object, &mut robot, &mut markers, &mut drawn, (&path, source))?);
        }
        let meshes = meshes.into();
        let mut scene = Self { robot, own, frames, postures, things, markers, drawn, meshes, floor, shows };
        scene.pair(document, touches);
        Ok(scene)
    }

    /// Adds the contact pairs: robot and floor, each thing and everything else. A robot that does not touch has none.
    fn pair(&mut self, document: &Document, touches: bool) {
        let (stiffness, friction) = (document.world.stiffness, document.world.friction);
        // Critical damping, c = 2 sqrt(k m), with the whole mass at one point.
        let surface = |mass: f64, friction| Surface {
            friction,
            rolling_friction: 0.0,
            stiffness,
            damping: 2.0 * Scalar::sqrt(stiffness * mass),
        };
        let [segments, colliders] = [self.own[0], if touches { self.own[1] } else { 0 }];
        let mass: f64 = self.robot.segments[..segments].iter().map(|segment| segment.mass).sum();
        let moves = |collider: &Collider| collider.body.is_some_and(|body| self.moves(body));
        let movable: Vec<bool> = self.robot.colliders.iter().map(moves).collect();
        let mut pairs = Vec::new();
        if let Some(floor) = self.floor {
            pairs.extend(
                (0..colliders)
                    .filter(|collider| movable[*collider])
                    .map(|collider| ([collider, floor], surface(mass, friction))),
            );
        }
        for (number, thing) in self.things.iter().enumerate() {
            let Some(collider) = thing.collider else { continue };
            // Two colliders that never move need no pair.
            let of_robot = (0..colliders).filter(|robot_collider| movable[*robot_collider] || movable[collider]);
            // Against a wall the mass is that of the robot.
            let smaller = if thing.mass > 0.0 { thing.mass } else { mass };
            pairs.extend(of_robot.map(|robot_collider| ([robot_collider, collider], surface(smaller, friction))));
            let floor = self.floor.filter(|_| thing.mass > 0.0);
            pairs.extend(floor.map(|floor| ([collider, floor], surface(thing.mass, thing.friction))));
            for other in &self.things[..number] {
                let Some(second) = other.collider.filter(|_| thing.mass > 0.0 || other.mass > 0.0) else { continue };
                // The lighter body determines the damping, because the damping of the heavier one would overdamp it.
                let mass = if other.mass > 0.0 { other.mass.min(smaller) } else { smaller };
                pairs.push(([second, collider], surface(mass, thing.friction.max(other.friction))));
            }
        }
        for (colliders, surface) in pairs {
            self.robot.add_pair(colliders, surface);
        }
    }

    /// Returns the names of two colliders of which one is the floor, fixed or part of a thing, else `None`.
    pub(crate) fn parts(&self, colliders: [usize; 2]) -> Option<[&str; 2]> {
        let [a, b] = colliders.map(|number| (number, &self.robot.colliders[number]));
        let around = |(number, collider): (usize, &Collider)| number >= self.own[1] || collider.body.is_none();
        match (around(a), around(b)) {
            (false, false) => None,
            (true, false) => Some([&b.1.name, &a.1.name]),
            _ => Some([&a.1.name, &b.1.name]),
        }
    }

    /// Returns the path of the part that can be moved apart from two colliders: a thing, or else the robot.
    pub(crate) fn place_of(&self, colliders: [usize; 2]) -> String {
        let thing = |collider| self.things.iter().position(|thing| thing.collider == Some(collider));
        let thing = colliders.into_iter().filter_map(thing).max();
        thing.map_or_else(|| "/robot".into(), |number| format!("/objects/{number}"))
    }

    /// Checks if a body can move in the world.
    fn moves(&self, body: BodyId) -> bool {
        let mut next = Some(body);
        while let Some(body) = next {
            let segment = &self.robot.segments[body.index()];
            if segment.joint.kind != farsa_body::robot::JointKind::Fixed {
                return true;
            }
            next = segment.parent;
        }
        false
    }

    /// Gets the number of the robot's own bodies.
    pub(crate) fn own_bodies(&self) -> usize {
        self.own[0]
    }

    /// Returns the robot without its surroundings, for drawings.
    pub(crate) fn alone(&self) -> Robot {
        let mut robot = self.robot.clone();
        robot.colliders.truncate(self.own[1]);
        robot.pairs.clear();
        robot
    }

    /// Returns a named body of the robot or frame of its file, with the pose in that body. Without a name it is the
    /// first body.
    pub(crate) fn body(
        &self,
        name: Option<&String>,
        path: &str,
        source: &Source,
    ) -> Result<(BodyId, Pose<f64>), Error> {
        let Some(name) = name else { return Ok((BodyId(0), Pose::identity())) };
        let of_file = self.frames.iter().find(|(known, body, _)| known == name && body.is_some());
        let of_file = of_file.and_then(|(_, body, placement)| Some(((*body)?, *placement)));
        let own =
            || self.robot.body(name).filter(|body| body.index() < self.own[0]).map(|body| (body, Pose::identity()));
        of_file.or_else(own).ok_or_else(|| Error::unknown(&source.of(path), "body", name, self.body_names()))
    }

    /// Returns the name of a body.
    pub(crate) fn body_name(&self, body: BodyId) -> &str {
        self.robot.segments.get(body.index()).map_or("", |segment| &segment.name)
    }

    fn body_names(&self) -> Vec<&str> {
        let of_file = self.frames.iter().filter(|(_, body, _)| body.is_some()).map(|(name, ..)| name.as_str());
        let own = self.robot.segments[..self.own[0]].iter().map(|segment| segment.name.as_str());
        own.chain(of_file).collect()
    }

    /// Returns a point of a body of the robot.
    pub(crate) fn point(
        &self,
        name: Option<&String>,
        point: [f64; 3],
        path: &str,
        source: &Source,
    ) -> Result<Point, Error> {
        let (body, placement) = self.body(name, &format!("{path}/body"), source)?;
        Ok(Point { body, at: placement.transform(point).map(|x| x as f32) })
    }

    /// Returns the center of a thing or of a body of the robot, and the distance of a thing's surface from it [m].
    pub(crate) fn point_named(&self, name: &String, path: &str, source: &Source) -> Result<(NamedPoint, f64), Error> {
        if let Some(thing) = self.things.iter().find(|thing| thing.name == *name) {
            return match thing.what {
                What::Body(body) => Ok((NamedPoint::Body(Point::origin(body)), thing.reach)),
                What::Marker(number) => Ok((NamedPoint::Marker(number), 0.0)),
                What::Wall => {
                    Err(source.wrong(path, format!("`{name}` is a wall, which has no middle to be measured")))
                }
            };
        }
        let named = self.body(Some(name), path, source).map_err(|_| {
            let names = self.things.iter().map(|thing| thing.name.as_str()).chain(self.body_names());
            Error::unknown(&source.of(path), "object", name, names)
        });
        let (body, placement) = named?;
        Ok((NamedPoint::Body(Point { body, at: placement.position.map(|x| x as f32) }), 0.0))
    }

    /// Returns a point of a body of the robot or of a thing. Without a name it is that of the first body.
    pub(crate) fn part_or_thing(
        &self,
        name: Option<&String>,
        point: [f64; 3],
        path: &str,
        source: &Source,
    ) -> Result<NamedPoint, Error> {
        let thing = self.things.iter().find(|thing| Some(&thing.name) == name);
        let path_of_name = || format!("{path}/body");
        match (thing.map(|thing| thing.what), name) {
            (Some(What::Body(body)), _) => Ok(NamedPoint::Body(Point { body, at: point.map(|x| x as f32) })),
            (Some(_), Some(name)) if point == [0.0; 3] => Ok(self.point_named(name, &path_of_name(), source)?.0),
            (Some(_), _) => Err(source.wrong(&format!("{path}/point"), "is for bodies that move")),
            (None, Some(name)) if self.body(Some(name), path, source).is_err() => {
                let names = self.body_names().into_iter().chain(self.things.iter().map(|thing| thing.name.as_str()));
                Err(Error::unknown(&source.of(&path_of_name()), "body", name, names))
            }
            (None, name) => Ok(NamedPoint::Body(self.point(name, point, path, source)?)),
        }
    }

    /// Returns the number of a posture of the robot by its name, which is empty for the configuration of the file.
    pub(crate) fn posture(&self, name: &str, path: &str, source: &Source) -> Result<usize, Error> {
        if self.postures.is_empty() {
            return Err(source.wrong(path, "is for a `model`, whose file has postures"));
        }
        let number = self.postures.iter().position(|posture| posture.name == name);
        let names = || self.postures.iter().skip(1).map(|posture| posture.name.as_str());
        number.ok_or_else(|| Error::unknown(&source.of(path), "keyframe", name, names()))
    }

    /// Returns a named joint of the robot.
    pub(crate) fn joint(&self, name: &str, path: &str, source: &Source) -> Result<JointId, Error> {
        let joints = || self.robot.joints().filter(|joint| joint.index() < self.own[0]);
        let named = joints().find(|joint| self.joint_name(*joint) == name);
        let valid = joints().map(|joint| self.joint_name(joint));
        named.ok_or_else(|| Error::unknown(&source.of(&format!("{path}/joint")), "joint", name, valid))
    }

    /// Returns true for a joint that slides instead of turning.
    pub(crate) fn is_rail(&self, joint: JointId) -> bool {
        let segment = self.robot.segments.get(joint.index());
        segment.is_some_and(|segment| segment.joint.kind == farsa_body::robot::JointKind::Prismatic)
    }

    /// Returns named joints, or without names all of the robot for which `all` is true.
    pub(crate) fn joints(
        &self,
        names: &[String],
        all: impl Fn(JointId) -> bool,
        path: &str,
        source: &Source,
    ) -> Result<Vec<JointId>, Error> {
        let joints_of_robot = || self.robot.joints().filter(|joint| joint.index() < self.own[0]);
        let joints: Vec<JointId> = if names.is_empty() {
            joints_of_robot().filter(|joint| all(*joint)).collect()
        } else {
            let named = |(index, name): (usize, &String)| {
                let joint = joints_of_robot().find(|joint| self.joint_name(*joint) == name);
                let valid = joints_of_robot().map(|joint| self.joint_name(joint));
                joint.ok_or_else(|| Error::unknown(&source.of(&format!("{path}/joints/{index}")), "joint", name, valid))
            };
            names.iter().enumerate().map(named).collect::<Result<_, _>>()?
        };
        if joints.is_empty() {
            return Err(source
                .wrong(path, "is for joints that the robot does not have; name `joints`, and how strong they are"));
        }
        Ok(joints)
    }

    /// Returns the name of a joint.
    pub(crate) fn joint_name(&self, joint: JointId) -> &str {
        self.robot.segments.get(joint.index()).map_or("", |segment| &segment.joint.name)
    }

    /// Gets the range of a joint [rad or m].
    pub(crate) fn range(&self, joint: JointId) -> [f64; 2] {
        self.robot.segments.get(joint.index()).map_or([f64::NEG_INFINITY, f64::INFINITY], |segment| segment.joint.range)
    }

    /// Returns the contact pairs between bodies of the robot, by default all, and a thing, the floor or everything.
    pub(crate) fn pairs(
        &self,
        bodies: &[String],
        with: Option<&String>,
        path: &str,
        source: &Source,
    ) -> Result<Vec<PairId>, Error> {
        let named = bodies.iter().enumerate();
        let named = named.map(|(index, name)| Ok(self.body(Some(name), &format!("{path}/bodies/{index}"), source)?.0));
        let named = named.collect::<Result<Vec<_>, Error>>()?;
        let feels = |collider: usize| {
            let body = self.robot.colliders[collider].body.filter(|_| collider < self.own[1]);
            body.is_some_and(|body| named.is_empty() || named.contains(&body))
        };
        let thing = match with {
            Some(name) if name != FLOOR => {
                let named_thing = self.things.iter().find(|thing| thing.name == *name);
                let names = self.things.iter().map(|thing| thing.name.as_str()).chain([FLOOR]);
                let place = source.of(&format!("{path}/with"));
                named_thing.ok_or_else(|| Error::unknown(&place, "object", name, names))?.collider
            }
            _ => None,
        };
        // The floor of a model is its fixed geometry.
        let is_floor = |collider: usize| {
            Some(collider) == self.floor || collider < self.own[1] && self.robot.colliders[collider].body.is_none()
        };
        let met = |collider: usize| match with {
            None => true,
            Some(name) if name == FLOOR => is_floor(collider),
            Some(_) => thing == Some(collider),
        };
        let pairs = self.robot.pairs.iter().enumerate().filter(|(_, pair)| {
            let [a, b] = pair.colliders;
            feels(a) && met(b) || feels(b) && met(a)
        });
        let ids: Vec<PairId> = pairs.map(|(number, _)| PairId(number as u16)).collect();
        if ids.is_empty() {
            return Err(source.wrong(path, "can touch nothing: no shape of the robot meets anything there"));
        }
        Ok(ids)
    }

    /// Returns the contact pairs between the robot and things.
    pub(crate) fn collisions(&self) -> Vec<PairId> {
        let things = self.things.iter().filter_map(|thing| thing.collider);
        let things: Vec<usize> = things.collect();
        let of_robot = |collider: usize| collider < self.own[1];
        let pairs = self.robot.pairs.iter().enumerate().filter(|(_, pair)| {
            let [a, b] = pair.colliders;
            of_robot(a) && things.contains(&b) || of_robot(b) && things.contains(&a)
        });
        pairs.map(|(number, _)| PairId(number as u16)).collect()
    }
}
