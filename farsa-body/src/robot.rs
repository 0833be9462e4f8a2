//! A robot as data: segments and their joints, shapes, actuators and the pairs that may touch.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

use crate::actuator::Law;
use crate::ports::{ActuatorId, BodyId, JointId, PairId};
use crate::pose::Pose;

/// How a segment moves relative to its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum JointKind {
    /// Turns about the joint's axis.
    Revolute,
    /// Slides along the joint's axis.
    Prismatic,
    /// Does not move.
    Fixed,
    /// Moves freely in the world; only for a segment without parent.
    Floating,
}

/// The joint that carries a segment.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Joint {
    /// The joint's name, unique in the robot; may be empty for fixed and floating joints.
    pub name: String,
    /// How it moves.
    pub kind: JointKind,
    /// Axis in the joint's frame; normalised by the reader.
    pub axis: [f64; 3],
    /// The joint's frame in the parent's frame (the world's without parent), at joint position 0.
    pub placement: Pose<f64>,
    /// Lowest and highest position [rad or m]; infinite for none.
    pub range: [f64; 2],
    /// Inertia of the drive, added to the joint's own [kg m2 or kg].
    pub armature: f64,
    /// Viscous damping [N m s/rad or N s/m].
    pub damping: f64,
}

/// A rigid part of the robot with the joint that carries it; its frame is the joint's frame after the motion.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Segment {
    /// The segment's name, unique in the robot.
    pub name: String,
    /// The segment that it hangs on, earlier in the list; `None` for the world.
    pub parent: Option<BodyId>,
    /// How it moves relative to the parent.
    pub joint: Joint,
    /// Mass [kg].
    pub mass: f64,
    /// Centre of mass in the segment's frame [m].
    pub centre: [f64; 3],
    /// Inertia about the centre of mass in the segment's axes [xx, yy, zz, xy, xz, yz; kg m2].
    pub inertia: [f64; 6],
}

/// The form of a collider, in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Shape {
    /// A ball about the origin.
    Sphere {
        /// Radius [m].
        radius: f64,
    },
    /// All points within `radius` of the piece of the z axis from `-half_length` to `half_length`.
    Capsule {
        /// Radius [m].
        radius: f64,
        /// Half the length of the axis [m].
        half_length: f64,
    },
    /// A box about the origin.
    Box {
        /// Half the edge lengths along x, y, z [m].
        half: [f64; 3],
    },
    /// The half space z <= 0.
    Plane,
}

/// A shape fixed to a segment or to the world.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Collider {
    /// The collider's name, unique in the robot.
    pub name: String,
    /// The segment it moves with; `None` for the world.
    pub body: Option<BodyId>,
    /// Its form.
    pub shape: Shape,
    /// Its frame in the segment's frame.
    pub placement: Pose<f64>,
}

/// How two surfaces act on each other.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Surface {
    /// Coefficient of sliding friction.
    pub friction: f64,
    /// Rolling and spinning resistance: largest torque over normal force [m].
    pub rolling_friction: f64,
    /// Normal stiffness of one contact point [N/m].
    pub stiffness: f64,
    /// Normal damping of one contact point [N s/m].
    pub damping: f64,
}

/// Two colliders that may touch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pair {
    /// Indices of the two colliders.
    pub colliders: [usize; 2],
    /// How their surfaces act on each other.
    pub surface: Surface,
}

/// An actuator on a joint.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Actuator {
    /// The actuator's name, unique in the robot.
    pub name: String,
    /// The joint it acts on.
    pub joint: JointId,
    /// Its law.
    pub law: Law<f64>,
}

/// A robot, or a scene of robots and things, as data; every world is built from one.
#[derive(Clone, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Robot {
    /// The robot's name.
    pub name: String,
    /// The segments, parents before children.
    pub segments: Vec<Segment>,
    /// The shapes.
    pub colliders: Vec<Collider>,
    /// The pairs of colliders that may touch, in a fixed order.
    pub pairs: Vec<Pair>,
    /// The actuators.
    pub actuators: Vec<Actuator>,
}

/// What is wrong with a robot's description.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RobotError {
    /// A segment's parent comes later, or not at all.
    Parent {
        /// The segment's name.
        segment: String,
        /// The parent's index.
        parent: usize,
    },
    /// A number is NaN, infinite or out of its range.
    Value {
        /// The part's name.
        part: String,
        /// Which number.
        field: &'static str,
        /// Its value.
        value: f64,
    },
    /// An index points to nothing.
    Index {
        /// The part's name.
        part: String,
        /// Which index.
        field: &'static str,
        /// Its value.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// Two parts of one kind have the same name.
    Name {
        /// The name.
        name: String,
    },
    /// A floating joint on a segment that has a parent.
    Floating {
        /// The segment's name.
        segment: String,
    },
    /// A pair of shapes that no world can bring into contact.
    Shapes {
        /// The two colliders' names.
        colliders: [String; 2],
    },
}

impl fmt::Display for RobotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parent { segment, parent } => write!(f, "segment {segment}: parent {parent} is not an earlier segment"),
            Self::Value { part, field, value } => write!(f, "{part}: {field} is {value}"),
            Self::Index { part, field, index, count } => write!(f, "{part}: {field} {index} of {count}"),
            Self::Name { name } => write!(f, "the name {name} is used twice"),
            Self::Floating { segment } => write!(f, "segment {segment}: a floating joint must not have a parent"),
            Self::Shapes { colliders: [a, b] } => write!(f, "colliders {a} and {b}: no contact between such shapes"),
        }
    }
}

impl core::error::Error for RobotError {}

impl Robot {
    /// The body with this name.
    pub fn body(&self, name: &str) -> Option<BodyId> {
        self.segments.iter().position(|s| s.name == name).map(|i| BodyId(i as u16))
    }

    /// The joint with this name.
    pub fn joint(&self, name: &str) -> Option<JointId> {
        self.segments.iter().position(|s| s.joint.name == name).map(|i| JointId(i as u16))
    }

    /// The actuator with this name.
    pub fn actuator(&self, name: &str) -> Option<ActuatorId> {
        self.actuators.iter().position(|a| a.name == name).map(|i| ActuatorId(i as u16))
    }

    /// The index of the collider with this name.
    pub fn collider(&self, name: &str) -> Option<usize> {
        self.colliders.iter().position(|c| c.name == name)
    }

    /// The pair of the colliders with these names, in either order.
    pub fn pair(&self, a: &str, b: &str) -> Option<PairId> {
        let (a, b) = (self.collider(a)?, self.collider(b)?);
        self.pairs.iter().position(|p| p.colliders == [a, b] || p.colliders == [b, a]).map(|i| PairId(i as u16))
    }
}
