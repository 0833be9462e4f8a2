//! Joints between segments, and their laws.

use alloc::string::String;

use crate::pose::Pose;
use crate::robot::impedance::Impedance;

/// The kind of motion between a segment and its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum JointKind {
    /// The segment turns about the axis of the joint.
    Revolute,
    /// The segment slides along the axis of the joint.
    Prismatic,
    /// The segment cannot move.
    Fixed,
    /// The segment moves freely in the world. It must not have a parent.
    Floating,
}

/// The joint that connects a segment to its parent.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Joint {
    /// Name of the joint, unique in the robot. It may be empty for fixed and floating joints.
    pub name: String,
    /// Kind of motion that the joint permits.
    pub kind: JointKind,
    /// Axis in the frame of the joint. It does not have to be normalized, but it must be longer than 1e-6.
    pub axis: [f64; 3],
    /// Frame of the joint at position 0, relative to the parent or the world.
    pub placement: Pose<f64>,
    /// Lowest and highest position in radians or meters. They may be infinite.
    pub range: [f64; 2],
    /// Inertia of the drive (in kg m2 or kg). It is added to the inertia of the segment.
    pub armature: f64,
    /// Viscous damping of the joint (in N m s/rad or N s/m).
    pub damping: f64,
    /// Stiffness of the joint's spring (in N m/rad or N/m).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "is_zero"))]
    pub stiffness: f64,
    /// Position at which the spring exerts no effort (in radians or meters). It may be outside of the range.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "is_zero"))]
    pub rest: f64,
    /// Dry friction of the joint, as the largest effort with which it resists motion (in N m or N).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "is_zero"))]
    pub friction: f64,
    /// Largest speed (in rad/s or m/s). Whatever effort this takes holds the joint at it.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub speed_limit: Option<f64>,
    /// Law of the stops at the ends of the range. By default it is the world's.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub stop: Option<Stop>,
}

/// A spring, a damper and an inertia that push a joint back that is beyond an end of its range. rapier has stops that do not
/// yield instead.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Stop {
    /// Stiffness (in N m/rad or N/m).
    pub stiffness: f64,
    /// Viscous damping (in N m s/rad or N s/m).
    pub damping: f64,
    /// Inertia that the joint gains (in kg m2 or kg). MuJoCo's limits act like this.
    pub inertia: f64,
    /// Impedance over the way beyond the end, which otherwise is constant.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub impedance: Option<Impedance>,
}

#[cfg(feature = "serde")]
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
pub(super) fn is_zero(x: &f64) -> bool {
    *x == 0.0
}

impl JointKind {
    /// Returns true if the joint has exactly one degree of freedom.
    pub fn is_single(self) -> bool {
        matches!(self, Self::Revolute | Self::Prismatic)
    }
}

impl Joint {
    fn new(name: &str, kind: JointKind, axis: [f64; 3], placement: Pose<f64>, range: [f64; 2]) -> Self {
        Self {
            name: name.into(),
            kind,
            axis,
            placement,
            range,
            armature: 0.0,
            damping: 0.0,
            stiffness: 0.0,
            rest: 0.0,
            friction: 0.0,
            speed_limit: None,
            stop: None,
        }
    }

    /// Creates a joint that turns about `axis` within `range` (in radians). It has no armature and no damping.
    pub fn revolute(name: &str, axis: [f64; 3], placement: Pose<f64>, range: [f64; 2]) -> Self {
        Self::new(name, JointKind::Revolute, axis, placement, range)
    }

    /// Creates a joint that slides along `axis` within `range` (in meters). It has no armature and no damping.
    pub fn prismatic(name: &str, axis: [f64; 3], placement: Pose<f64>, range: [f64; 2]) -> Self {
        Self::new(name, JointKind::Prismatic, axis, placement, range)
    }

    /// Creates a joint that cannot move. Its name is empty.
    pub fn fixed(placement: Pose<f64>) -> Self {
        Self::new("", JointKind::Fixed, [0.0, 0.0, 1.0], placement, [0.0, 0.0])
    }

    /// Creates a joint for a segment that moves freely in the world and starts at `placement`. Its name is empty.
    pub fn floating(placement: Pose<f64>) -> Self {
        Self::new("", JointKind::Floating, [0.0, 0.0, 1.0], placement, [0.0, 0.0])
    }

    /// Sets the armature (in kg m2 or kg).
    #[must_use]
    pub fn with_armature(mut self, armature: f64) -> Self {
        self.armature = armature;
        self
    }

    /// Sets the viscous damping (in N m s/rad or N s/m).
    #[must_use]
    pub fn with_damping(mut self, damping: f64) -> Self {
        self.damping = damping;
        self
    }

    /// Sets the stiffness of the spring (in N m/rad or N/m) and the position at which it exerts no effort (in radians
    /// or meters).
    #[must_use]
    pub fn with_spring(mut self, stiffness: f64, rest: f64) -> Self {
        self.stiffness = stiffness;
        self.rest = rest;
        self
    }

    /// Sets the largest speed (in rad/s or m/s).
    #[must_use]
    pub fn with_speed_limit(mut self, speed: f64) -> Self {
        self.speed_limit = Some(speed);
        self
    }

    /// Sets the dry friction, the largest effort with which the joint resists motion (in N m or N).
    #[must_use]
    pub fn with_friction(mut self, friction: f64) -> Self {
        self.friction = friction;
        self
    }
}
