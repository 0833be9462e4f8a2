//! Scene in which a part is built.

use std::cell::RefCell;
use std::fmt::Display;

use farsa_body::Pose;
use farsa_body::actuators::Law;
use farsa_body::ports::{ActuatorId, BodyId, Handles, JointId, Kinematics, PairId};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_body::sensors::Point;
use farsa_lab::Error;
use farsa_num::Scalar;

use crate::part::files::Files;
use crate::part::named_point::NamedPoint;
use crate::part::wiring::Wiring;

/// Reasons against a part of the other robots.
pub(crate) const ON_WHEELS: &str = "is for robots on wheels; this one has joints";
pub(crate) const WITH_JOINTS: &str = "is for robots with joints; this one is on wheels";

/// Scene of a part in a world of either kind.
pub(crate) trait Surroundings {
    /// Creates an error with the place of the part.
    fn error(&self, why: String) -> Error;
    /// Returns a body of the robot.
    fn body(&self, name: Option<&str>) -> Result<BodyId, Error>;
    /// Returns the body of a thing.
    fn thing(&self, name: &str) -> Result<BodyId, Error>;
    /// Returns a named area.
    fn area(&self, name: &str) -> Result<Area, Error>;
    /// Lists the bodies of all robots on wheels, or the first body of the robot with joints.
    fn robots(&self) -> Vec<BodyId>;
    /// Returns joints of the robot.
    fn joints(&self, names: &[String]) -> Result<Vec<JointId>, Error>;
    /// Returns the actuators of joints.
    fn actuators(&self, joints: &[String]) -> Result<Vec<ActuatorId>, Error>;
    /// Returns contact pairs of the robot.
    fn contacts(&self, bodies: &[String], with: Option<&str>) -> Result<Vec<PairId>, Error>;
    /// Returns the contact pairs of all robots with anything, or of the robot with joints with things.
    fn collisions(&self) -> Vec<PairId>;
    /// Gets the robot on wheels, if any.
    fn mobile_robot(&self) -> Option<&MobileRobot>;
    /// Gets the parts of the robot on wheels, if any.
    fn parts(&self) -> Option<MobileParts>;
    /// Creates an error with the place of a key of the part.
    fn error_at(&self, key: &str, why: String) -> Error;
    /// Gets the path of the part in the document.
    fn path(&self) -> &str;
    /// Formats the place of the part in the file.
    fn line(&self) -> String;
    /// Gets the files of the document, while sensors are built.
    fn files(&self) -> Option<&Files<'_>>;
    /// Returns true with the section `foraging`.
    fn has_food(&self) -> bool;
    /// Returns the body of a thing that earlier rules place, or that has a place. `key` names it.
    fn placed_before(&self, name: &str, key: &str) -> Result<BodyId, Error>;
    /// Reads a point for the rule's thing or robot. In a plane, its height is 0.
    fn start_point(&self, at: &[f64], key: &str) -> Result<[f64; 3], Error>;
    /// Returns the number of an earlier rule with a choice among this many points.
    fn earlier_choice(&self, name: &str, points: usize) -> Result<usize, Error>;
    /// Gets the number of the robot on wheels, from 0.
    fn robot(&self) -> usize;
    /// Returns true for a body that can move during a trial of robots on wheels.
    fn moves(&self, body: BodyId) -> bool;
    /// Gets the sides of the arena [m].
    fn size(&self) -> [f64; 2];
    /// Returns a round obstacle with its radius [m]. `key` names it.
    fn cylinder(&self, name: &str, key: &str) -> Result<(BodyId, f64), Error>;
    /// Returns all areas of a name. `key` names them.
    fn areas(&self, name: &str, key: &str) -> Result<Vec<Area>, Error>;
    /// Returns the robots of a group, from the first up to the one after the last. `key` names it.
    fn group(&self, name: &str, key: &str) -> Result<[usize; 2], Error>;
    /// Returns the first channel of a sensor and the one after the last. `key` names it.
    fn sensor_channels(&self, name: &str, key: &str) -> Result<[usize; 2], Error>;
    /// Returns a thing or body of a robot with joints, with the distance of its surface from the center [m].
    fn target_with_reach(&self, name: &str, key: &str) -> Result<(NamedPoint, f64), Error>;
    /// Returns a point of a body of the robot or of a thing.
    fn part_or_thing(&self, body: Option<&String>, point: [f64; 3]) -> Result<NamedPoint, Error>;
    /// Returns the joint of the key `joint`.
    fn one_joint(&self, name: &str) -> Result<JointId, Error>;
    /// Returns true for an engine in which cameras with sectors see.
    fn shows(&self) -> bool;
    /// Returns a body of the robot, or a frame of its file with the pose in that body. `key` names it.
    fn frame(&self, body: Option<&String>, key: &str) -> Result<(BodyId, Pose<f64>), Error>;
    /// Returns a point of a body of the robot.
    fn point(&self, body: Option<&String>, point: [f64; 3]) -> Result<Point, Error>;
    /// Returns a thing or a body of the robot with joints. `key` names it.
    fn target(&self, name: &str, key: &str) -> Result<NamedPoint, Error>;
    /// Returns the contact pairs of bodies of the robot with a thing, the floor or everything.
    fn touching(&self, bodies: &[String], with: Option<&String>) -> Result<Vec<PairId>, Error>;
    /// Returns the name of a body for descriptions.
    fn called(&self, body: Option<&String>) -> String;
    /// Returns the name of a body.
    fn body_name(&self, body: BodyId) -> &str;
    /// Returns the name of a joint.
    fn joint_name(&self, joint: JointId) -> &str;
    /// Gets the range of a joint [rad or m].
    fn range(&self, joint: JointId) -> [f64; 2];
    /// Returns the position of a joint in a keyframe of the model, or in the configuration of the file for an empty name.
    fn position_in(&self, keyframe: &str, joint: JointId) -> Result<f64, Error>;
    /// Describes the joint of a channel, from those named or from all that fit.
    fn joint(&self, names: &[String], channel: usize, fits: &dyn Fn(JointId) -> bool) -> JointAbout;
    /// Returns named joints, or without names all that fit.
    fn fitting(&self, names: &[String], fits: &dyn Fn(JointId) -> bool) -> Result<Vec<JointId>, Error>;
    /// Returns the present actuators.
    fn wiring(&self) -> Wiring;
    /// Gets the actuators, while motors are built.
    fn open_wiring(&self) -> Option<&RefCell<Wiring>>;
}

/// Name and identifier of a joint, its range [rad or m], the units of its position, speed and effort, and its own largest torque.
#[derive(Clone, Debug, Default)]
pub(crate) struct JointAbout {
    pub(crate) name: String,
    pub(crate) id: Option<JointId>,
    pub(crate) range: [f64; 2],
    pub(crate) units: [&'static str; 3],
    pub(crate) torque: Option<f64>,
}

/// Scene of a robot on wheels.
pub(crate) struct OnWheels<'s> {
    scene: PartScene<'s>,
    pub(crate) robot: &'s MobileRobot,
    pub(crate) parts: MobileParts,
}

impl OnWheels<'_> {
    /// Creates the error of a part that the robot lacks.
    pub(crate) fn lacks(&self, what: &str) -> Error {
        self.scene.error(format!("needs {what}; the {} has none", self.robot.name))
    }
}

/// A disc or rectangle of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    /// Body of the area.
    pub body: BodyId,
    /// Half the sides of a rectangle, or the radius of a disc twice \[m\].
    pub half: [f64; 2],
    /// True for a disc.
    pub disc: bool,
}

impl Area {
    /// Checks if the origin of a pose is in the area.
    pub fn contains<W: Kinematics + Handles<Body = BodyId>>(&self, world: &W, pose: Pose) -> bool {
        let area = world.pose(self.body);
        if self.disc {
            let [x, y] = [0, 1].map(|k| pose.position[k] - area.position[k]);
            return Scalar::sqrt(x * x + y * y) <= self.half[0] as f32;
        }
        // In the axes of the rectangle, where its sides are parallel to x and y.
        let [u, v] = [0, 1].map(|k| f64::from(pose.position[k] - area.position[k]));
        let [x, y, _] = area.cast::<f64>().rotate_back([u, v, 0.0]);
        x.abs() <= self.half[0] && y.abs() <= self.half[1]
    }
}

/// Scene of an experiment, for the names in a part's settings.
///
/// Each method returns an error with the place in the file and the nearest valid name.
#[derive(Clone, Copy)]
pub struct PartScene<'s>(pub(crate) &'s dyn Surroundings);

impl<'s> PartScene<'s> {
    pub(crate) fn new(surroundings: &'s dyn Surroundings) -> Self {
        Self(surroundings)
    }

    /// Gets the scene of a robot on wheels.
    pub(crate) fn planar(&self) -> Result<OnWheels<'s>, Error> {
        let found = self.0.mobile_robot().zip(self.0.parts());
        let (robot, parts) = found.ok_or_else(|| self.error(ON_WHEELS))?;
        Ok(OnWheels { scene: *self, robot, parts })
    }

    /// Describes the joint of a channel of a motor, from those named or from all with an actuator of this kind. A
    /// motor with a `given` law is on all joints.
    pub(crate) fn driven_joint(
        &self,
        names: &[String],
        channel: usize,
        given: bool,
        kind: fn(&Law<f64>) -> bool,
    ) -> JointAbout {
        let wiring = self.0.wiring();
        self.0.joint(names, channel, &|joint| given || wiring.has(joint, kind))
    }

    /// Creates an error that names the part in the file.
    pub fn error(&self, why: impl Display) -> Error {
        self.0.error(why.to_string())
    }

    /// Returns a body of the robot by name, by default the first. A robot on wheels has one body, without a name.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] for an unknown body, and for one of a file that is not at the origin of its segment.
    pub fn body(&self, name: Option<&str>) -> Result<BodyId, Error> {
        self.0.body(name)
    }

    /// Returns the body of a named thing.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] for an unknown thing, a wall, a marker, and a body that is not at the origin of its
    /// segment.
    pub fn thing(&self, name: &str) -> Result<BodyId, Error> {
        self.0.thing(name)
    }

    /// Returns a disc or rectangle of the ground.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] for an unknown name, for another thing, and for a robot with joints.
    pub fn area(&self, name: &str) -> Result<Area, Error> {
        self.0.area(name)
    }

    /// Lists the bodies of all robots on wheels, or the first body of the robot with joints.
    pub fn robots(&self) -> Vec<BodyId> {
        self.0.robots()
    }

    /// Returns joints of the robot by name, by default all. Robots on wheels have the joints of their wheels.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] for an unknown joint.
    pub fn joints(&self, names: &[String]) -> Result<Vec<JointId>, Error> {
        self.0.joints(names)
    }

    /// Returns the actuators of joints, by default of all with an actuator. Robots on wheels have those of their
    /// wheels.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] for an unknown joint, and for one without an actuator.
    pub fn actuators(&self, joints: &[String]) -> Result<Vec<ActuatorId>, Error> {
        self.0.actuators(joints)
    }

    /// Returns the contact pairs between bodies of the robot, by default all, and a thing or `floor`, by default
    /// anything. A robot on wheels has one pair for all contacts.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] for an unknown name, and if nothing can touch.
    pub fn contacts(&self, bodies: &[String], with: Option<&str>) -> Result<Vec<PairId>, Error> {
        self.0.contacts(bodies, with)
    }

    /// Returns the contact pairs that count as collisions: those of all robots on wheels, or those between the robot
    /// with joints and things.
    pub fn collisions(&self) -> Vec<PairId> {
        self.0.collisions()
    }

    /// Gets the robot on wheels. Returns `None` for a robot with joints.
    pub fn mobile_robot(&self) -> Option<&'s MobileRobot> {
        self.0.mobile_robot()
    }
}
