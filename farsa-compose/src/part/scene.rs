//! Scene in which a part is built.

use std::fmt::Display;

use farsa_body::Pose;
use farsa_body::ports::{ActuatorId, BodyId, Handles, JointId, Kinematics, PairId};
use farsa_body::robots::MobileRobot;
use farsa_lab::Error;

use crate::arena::gathering::distance;

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
    /// Gets the robot on wheels, if any.
    fn mobile_robot(&self) -> Option<&MobileRobot>;
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
            return distance(&pose, &area) <= self.half[0] as f32;
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
pub struct PartScene<'s>(&'s dyn Surroundings);

impl<'s> PartScene<'s> {
    pub(crate) fn new(surroundings: &'s dyn Surroundings) -> Self {
        Self(surroundings)
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

    /// Gets the robot on wheels. Returns `None` for a robot with joints.
    pub fn mobile_robot(&self) -> Option<&'s MobileRobot> {
        self.0.mobile_robot()
    }
}
