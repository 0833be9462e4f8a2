//! Validation of a robot's description.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;
use core::fmt;

use crate::actuators::law::Law;
use crate::pose::{Pose, norm};
use crate::robot::description::{Robot, Segment, Surface};
use crate::robot::impedance::Impedance;
use crate::robot::joint::JointKind;
use crate::robot::shape::Shape;

/// An error in the description of a robot.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RobotError {
    /// A number is NaN, infinite or out of its range.
    Value {
        /// Name of the part.
        part: String,
        /// Name of the field.
        field: &'static str,
        /// Invalid value.
        value: f64,
    },
    /// The range of a joint contains NaN or ends before it begins.
    Range {
        /// Name of the joint.
        joint: String,
        /// Invalid range [rad or m].
        range: [f64; 2],
    },
    /// A moving body cannot have this mass or inertia.
    Inertia {
        /// Name of the segment.
        segment: String,
        /// Mass of the segment [kg].
        mass: f64,
        /// Inertia [xx, yy, zz, xy, xz, yz, kg m2].
        inertia: [f64; 6],
    },
    /// An index is beyond the end of its list.
    Index {
        /// Name of the part.
        part: String,
        /// Name of the field.
        field: &'static str,
        /// Invalid index.
        index: usize,
        /// Length of the list.
        count: usize,
    },
    /// There are more than 65535 parts of one kind, so they cannot be numbered.
    Count {
        /// Kind of the parts.
        parts: &'static str,
        /// Number of parts.
        count: usize,
    },
    /// Two parts of the same kind have the same name.
    Name {
        /// Duplicate name.
        name: String,
    },
    /// A part has an invalid position in the description.
    ///
    /// Examples are a parent that follows its child, a floating joint below another segment, and an actuator on a fixed
    /// joint. Another example is ground below a body that does not slide in a plane. Parts without a name are also
    /// reported with this variant.
    Structure {
        /// A description of the part and the problem.
        why: String,
    },
    /// Two colliders of a pair cannot touch.
    Pair {
        /// Names of the two colliders.
        colliders: [String; 2],
        /// The reason why they cannot touch.
        fault: PairFault,
    },
}

/// The reason why a pair of colliders cannot touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PairFault {
    /// Contacts between these shapes are not supported by any world.
    Shapes,
    /// Both colliders belong to the same body or to the world.
    SameBody,
    /// The pair is already in the list.
    Twice,
}

impl fmt::Display for RobotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value { part, field, value } => write!(f, "{part}: {field} is {value}"),
            Self::Range { joint, range: [low, high] } => write!(f, "joint {joint}: no range from {low} to {high}"),
            Self::Inertia { segment, mass, inertia } => {
                write!(f, "segment {segment}: no body has mass {mass} and inertia {inertia:?}")
            }
            Self::Index { part, field, index, count } => write!(f, "{part}: {field} {index} of {count}"),
            Self::Count { parts, count } => write!(f, "{count} {parts} are more than 65535"),
            Self::Name { name } => write!(f, "the name {name} is used twice"),
            Self::Structure { why } => f.write_str(why),
            Self::Pair { colliders: [a, b], fault } => match fault {
                PairFault::Shapes => write!(f, "colliders {a} and {b}: no contact between such shapes"),
                PairFault::SameBody => write!(f, "colliders {a} and {b} are on one body"),
                PairFault::Twice => write!(f, "colliders {a} and {b} are paired twice"),
            },
        }
    }
}

impl core::error::Error for RobotError {}

/// Demands of a number of the named part: NaN never passes.
pub(super) struct Part<'a>(pub(super) &'a str);

impl Part<'_> {
    pub(super) fn demand(&self, ok: bool, field: &'static str, value: f64) -> Result<(), RobotError> {
        if ok { Ok(()) } else { Err(RobotError::Value { part: self.0.into(), field, value }) }
    }

    fn finite(&self, field: &'static str, value: f64) -> Result<(), RobotError> {
        self.demand(value.is_finite(), field, value)
    }

    pub(super) fn positive(&self, field: &'static str, value: f64) -> Result<(), RobotError> {
        self.demand(value.is_finite() && value > 0.0, field, value)
    }

    pub(super) fn not_negative(&self, field: &'static str, value: f64) -> Result<(), RobotError> {
        self.demand(value.is_finite() && value >= 0.0, field, value)
    }

    pub(super) fn impedance(&self, law: Option<Impedance>) -> Result<(), RobotError> {
        let Some(Impedance { surface, deep, width, midpoint, power }) = law else { return Ok(()) };
        let shares = [
            ("impedance at the surface", surface),
            ("impedance at depth", deep),
            ("midpoint of the impedance", midpoint),
        ];
        for (field, value) in shares {
            self.demand(value > 0.0 && value < 1.0, field, value)?;
        }
        self.positive("width of the impedance", width)?;
        self.demand(power == 1 || power == 2, "power of the impedance", power.into())
    }

    fn vector(&self, field: &'static str, vector: &[f64]) -> Result<(), RobotError> {
        vector.iter().try_for_each(|x| self.finite(field, *x))
    }

    pub(super) fn placement(&self, placement: &Pose<f64>) -> Result<(), RobotError> {
        self.vector("position", &placement.position)?;
        self.vector("rotation", &placement.rotation)?;
        let n = norm(&placement.rotation);
        self.demand((n - 1.0).abs() <= 1e-6, "length of the rotation's quaternion", n)
    }

    pub(super) fn shape(&self, shape: &Shape) -> Result<(), RobotError> {
        match shape {
            Shape::Sphere { radius } => self.positive("radius", *radius),
            Shape::Capsule { radius, half_length } => {
                self.positive("radius", *radius)?;
                self.not_negative("half length", *half_length)
            }
            Shape::Cylinder { radius, half_length } => {
                self.positive("radius", *radius)?;
                self.positive("half length", *half_length)
            }
            Shape::Box { half } => half.iter().try_for_each(|x| self.positive("half edge length", *x)),
            Shape::Plane => Ok(()),
        }
    }

    pub(super) fn surface(&self, surface: &Surface) -> Result<(), RobotError> {
        self.not_negative("friction", surface.friction)?;
        self.not_negative("rolling friction", surface.rolling_friction)?;
        self.positive("contact stiffness", surface.stiffness)?;
        self.not_negative("contact damping", surface.damping)
    }

    pub(super) fn color(&self, color: Option<[f64; 3]>) -> Result<(), RobotError> {
        let mut shades = color.into_iter().flatten();
        shades.try_for_each(|shade| self.demand((0.0..=1.0).contains(&shade), "colour", shade))
    }

    fn law(&self, law: &Law<f64>) -> Result<(), RobotError> {
        match law {
            Law::MusclePair(m) => {
                self.not_negative("tension", m.tension)?;
                self.finite("moment arm", m.moment_arm)?;
                self.not_negative("moment arm", m.moment_arm)?;
                self.vector("range", &[m.lower, m.upper])?;
                self.demand(m.upper > m.lower, "upper end of the range", m.upper)?;
                self.vector("length", &[m.shortest, m.rest_length, m.longest])?;
                self.demand(m.rest_length >= m.shortest, "rest length", m.rest_length)?;
                self.demand(m.longest > m.rest_length, "longest length", m.longest)?;
                self.positive("shape", m.shape)?;
                self.not_negative("passive scale", m.passive_scale)?;
                self.not_negative("viscosity", m.viscosity)
            }
            Law::Servo(s) => {
                self.not_negative("stiffness", s.stiffness)?;
                self.not_negative("damping", s.damping)?;
                self.demand(s.limit >= 0.0, "limit", s.limit)
            }
            Law::Torque(t) => self.demand(t.limit >= 0.0, "limit", t.limit),
            Law::Velocity(v) => {
                self.not_negative("gain", v.gain)?;
                self.demand(v.limit >= 0.0, "limit", v.limit)
            }
            Law::Held(h) => {
                self.not_negative("stiffness", h.stiffness)?;
                self.not_negative("damping", h.damping)
            }
        }
    }
}

fn unique<'a>(names: impl Iterator<Item = &'a String>) -> Result<(), RobotError> {
    let mut seen = BTreeSet::new();
    for name in names.filter(|name| !name.is_empty()) {
        if !seen.insert(name) {
            return Err(RobotError::Name { name: name.clone() });
        }
    }
    Ok(())
}

fn named<'a>(part: &'static str, mut names: impl Iterator<Item = &'a String>) -> Result<(), RobotError> {
    names.position(String::is_empty).map_or(Ok(()), |index| Err(unnamed(part, index)))
}

fn unnamed(part: &str, index: usize) -> RobotError {
    RobotError::Structure { why: format!("{part} {index} has no name") }
}

pub(super) fn index(part: &str, field: &'static str, index: usize, count: usize) -> Result<(), RobotError> {
    if index < count { Ok(()) } else { Err(RobotError::Index { part: part.into(), field, index, count }) }
}

fn segment(own_index: usize, segment: &Segment) -> Result<(), RobotError> {
    let part = Part(&segment.name);
    let joint = &segment.joint;
    if let Some(parent) = segment.parent {
        if parent.index() >= own_index {
            let (name, parent) = (&segment.name, parent.index());
            let why = format!("segment {name}: parent {parent} is not an earlier segment");
            return Err(RobotError::Structure { why });
        }
        if joint.kind == JointKind::Floating {
            let why = format!("segment {}: a floating joint must not have a parent", segment.name);
            return Err(RobotError::Structure { why });
        }
    }
    part.placement(&joint.placement)?;
    part.not_negative("mass", segment.mass)?;
    part.vector("centre of mass", &segment.centre)?;
    part.vector("inertia", &segment.inertia)?;
    part.not_negative("armature", joint.armature)?;
    part.not_negative("joint damping", joint.damping)?;
    part.not_negative("joint stiffness", joint.stiffness)?;
    part.finite("rest position", joint.rest)?;
    part.not_negative("joint friction", joint.friction)?;
    if let Some(speed) = joint.speed_limit {
        part.positive("largest speed", speed)?;
    }
    if let Some(stop) = joint.stop {
        part.positive("stiffness of the stops", stop.stiffness)?;
        part.not_negative("damping of the stops", stop.damping)?;
        part.not_negative("inertia of the stops", stop.inertia)?;
        part.impedance(stop.impedance)?;
    }
    if !segment.mass_properties().is_physical(joint.kind != JointKind::Fixed) {
        let Segment { name, mass, inertia, .. } = segment.clone();
        return Err(RobotError::Inertia { segment: name, mass, inertia });
    }
    if joint.kind.is_single() {
        if joint.name.is_empty() {
            return Err(unnamed("joint", own_index));
        }
        part.vector("axis", &joint.axis)?;
        let length = norm(&joint.axis);
        part.demand(length.is_finite() && length > 1e-6, "length of the axis", length)?;
        let [low, high] = joint.range;
        if !(low <= high && low < f64::INFINITY && high > f64::NEG_INFINITY) {
            return Err(RobotError::Range { joint: joint.name.clone(), range: joint.range });
        }
    }
    Ok(())
}

impl Robot {
    /// Checks that a world can be built from the description, and returns the first error.
    ///
    /// The structure must be valid. Indices exist, parents precede their children, and there are at most 65535 parts of
    /// a kind. Names are not empty and are unique within their kind. Only segments without a parent may have a floating
    /// joint. Each pair has two different bodies, contains at most one plane and is listed once.
    ///
    /// All numbers must be finite. Quaternions are normalized to 1e-6, axes are longer than 1e-6, and ranges are
    /// ordered. Moving bodies have positive masses and inertias that can exist. The values of shapes, laws and surfaces
    /// are positive.
    ///
    /// # Errors
    /// Returns the first [`RobotError`] found.
    pub fn validate(&self) -> Result<(), RobotError> {
        let counts = [
            ("segments", self.segments.len()),
            ("colliders", self.colliders.len()),
            ("pairs", self.pairs.len()),
            ("actuators", self.actuators.len()),
            ("visuals", self.visuals.len()),
        ];
        for (parts, count) in counts {
            if count > usize::from(u16::MAX) {
                return Err(RobotError::Count { parts, count });
            }
        }
        named("segment", self.segments.iter().map(|s| &s.name))?;
        named("collider", self.colliders.iter().map(|c| &c.name))?;
        named("actuator", self.actuators.iter().map(|a| &a.name))?;
        unique(self.segments.iter().map(|s| &s.name))?;
        unique(self.segments.iter().map(|s| &s.joint.name))?;
        unique(self.colliders.iter().map(|c| &c.name))?;
        unique(self.actuators.iter().map(|a| &a.name))?;
        for (i, one) in self.segments.iter().enumerate() {
            segment(i, one)?;
        }
        for collider in &self.colliders {
            if let Some(body) = collider.body {
                index(&collider.name, "body", body.index(), self.segments.len())?;
            }
            Part(&collider.name).shape(&collider.shape)?;
            Part(&collider.name).placement(&collider.placement)?;
            Part(&collider.name).color(collider.color)?;
        }
        for actuator in &self.actuators {
            index(&actuator.name, "joint", actuator.joint.index(), self.segments.len())?;
            let carried = &self.segments[actuator.joint.index()];
            if !carried.joint.kind.is_single() {
                let (name, segment) = (&actuator.name, &carried.name);
                let why = format!("actuator {name}: the joint of segment {segment} neither turns nor slides");
                return Err(RobotError::Structure { why });
            }
            Part(&actuator.name).law(&actuator.law)?;
            if let Some([low, high]) = actuator.command_range {
                let part = Part(&actuator.name);
                part.demand(low < f64::INFINITY, "lower end of the commands", low)?;
                part.demand(high > f64::NEG_INFINITY && low <= high, "upper end of the commands", high)?;
            }
        }
        self.validate_visuals()?;
        self.validate_pairs()?;
        self.validate_grounds()
    }
}

#[cfg(test)]
#[path = "validation_tests.rs"]
mod tests;
