//! Validation of a robot's description.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;
use core::fmt;

use crate::actuators::law::Law;
use crate::pose::{Pose, norm};
use crate::robot::description::{JointKind, Robot, Segment, Surface};
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
    fn demand(&self, ok: bool, field: &'static str, value: f64) -> Result<(), RobotError> {
        if ok { Ok(()) } else { Err(RobotError::Value { part: self.0.into(), field, value }) }
    }

    fn finite(&self, field: &'static str, value: f64) -> Result<(), RobotError> {
        self.demand(value.is_finite(), field, value)
    }

    fn positive(&self, field: &'static str, value: f64) -> Result<(), RobotError> {
        self.demand(value.is_finite() && value > 0.0, field, value)
    }

    pub(super) fn not_negative(&self, field: &'static str, value: f64) -> Result<(), RobotError> {
        self.demand(value.is_finite() && value >= 0.0, field, value)
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
        }
        self.validate_visuals()?;
        self.validate_pairs()?;
        self.validate_grounds()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actuators::law::{Held, Servo, Torque, Velocity};
    use crate::actuators::muscle::MusclePair;
    use crate::ports::{BodyId, JointId};
    use crate::robot::description::{Collider, Joint};
    use crate::robot::mass_properties::MassProperties;
    use alloc::format;
    use alloc::string::ToString;
    use alloc::vec::Vec;

    fn good() -> Robot {
        let mut r = Robot::new("good");
        let at = Pose::at([0.0, 0.0, 0.1]);
        let ball = MassProperties::sphere(1.0, 0.1);
        let hinge = Joint::revolute("hinge", [0.0, 2.0, 0.0], at, [f64::NEG_INFINITY, f64::INFINITY]);
        let arm = r.add_segment(Segment::new("arm", None, hinge, ball));
        let slide = Joint::prismatic("slide", [1.0, 0.0, 0.0], at, [0.0, 0.1]);
        r.add_segment(Segment::new("hand", Some(arm), slide, ball));
        let skin = MassProperties::sphere(0.0, 0.0);
        r.add_segment(Segment::new("skin", Some(arm), Joint::fixed(at), skin));
        r.add_segment(Segment::new("thing", None, Joint::floating(at), ball));
        let shapes = [
            ("a", Some(BodyId(0)), Shape::Sphere { radius: 0.1 }),
            ("b", Some(BodyId(1)), Shape::Capsule { radius: 0.1, half_length: 0.0 }),
            ("c", Some(BodyId(3)), Shape::Box { half: [0.1; 3] }),
            ("d", None, Shape::Plane),
            ("e", Some(BodyId(2)), Shape::Plane),
        ];
        for (name, body, shape) in shapes {
            r.add_collider(Collider::new(name, body, shape, at));
        }
        let surface = Surface { friction: 1.0, rolling_friction: 0.0, stiffness: 1e4, damping: 10.0 };
        for pair in [[0, 1], [0, 2], [0, 3], [1, 2], [3, 1], [3, 2]] {
            r.add_pair(pair, surface);
        }
        r.add_actuator("muscles", JointId(0), Law::MusclePair(MusclePair::thesis(300.0, 0.01, [-1.0, 1.0])));
        r.add_actuator("servo", JointId(1), Law::Servo(Servo { stiffness: 1.0, damping: 0.1, limit: f64::INFINITY }));
        r.add_actuator("torque", JointId(0), Law::Torque(Torque { limit: 1.0 }));
        r.add_actuator("velocity", JointId(0), Law::Velocity(Velocity { gain: 1.0, limit: f64::INFINITY }));
        r.add_actuator("held", JointId(0), Law::Held(Held { stiffness: 1.0, damping: 0.0 }));
        r
    }

    fn fault(change: impl FnOnce(&mut Robot)) -> RobotError {
        let mut robot = good();
        change(&mut robot);
        robot.validate().expect_err("a fault")
    }

    fn muscles(robot: &mut Robot) -> &mut MusclePair<f64> {
        let Law::MusclePair(m) = &mut robot.actuators[0].law else { panic!("no muscles") };
        m
    }

    #[test]
    fn a_good_robot_passes() {
        assert_eq!(good().validate(), Ok(()));
        assert_eq!(Robot::default().validate(), Ok(()));
    }

    #[test]
    fn faults_of_structure() {
        let name = |s: &str| s.to_string();
        let structure = |why: &str| RobotError::Structure { why: why.into() };
        assert_eq!(
            fault(|r| r.segments[1].parent = Some(BodyId(1))),
            structure("segment hand: parent 1 is not an earlier segment")
        );
        let floating = structure("segment thing: a floating joint must not have a parent");
        assert_eq!(fault(|r| r.segments[3].parent = Some(BodyId(0))), floating);
        assert_eq!(fault(|r| r.segments[1].name = name("arm")), RobotError::Name { name: name("arm") });
        assert_eq!(fault(|r| r.segments[1].joint.name = name("hinge")), RobotError::Name { name: name("hinge") });
        assert_eq!(fault(|r| r.colliders[1].name = name("a")), RobotError::Name { name: name("a") });
        assert_eq!(fault(|r| r.actuators[1].name = name("held")), RobotError::Name { name: name("held") });
        assert_eq!(fault(|r| r.segments[1].name.clear()), structure("segment 1 has no name"));
        assert_eq!(fault(|r| r.segments[1].joint.name.clear()), structure("joint 1 has no name"));
        let body = RobotError::Index { part: name("a"), field: "body", index: 4, count: 4 };
        assert_eq!(fault(|r| r.colliders[0].body = Some(BodyId(4))), body);
        let joint = RobotError::Index { part: name("servo"), field: "joint", index: 9, count: 4 };
        assert_eq!(fault(|r| r.actuators[1].joint = JointId(9)), joint);
        assert_eq!(
            fault(|r| r.actuators[1].joint = JointId(2)),
            structure("actuator servo: the joint of segment skin neither turns nor slides")
        );
        let collider = RobotError::Index { part: name("a pair"), field: "collider", index: 5, count: 5 };
        assert_eq!(fault(|r| r.pairs[0].colliders[1] = 5), collider);
        let colliders = [name("b"), name("a")];
        assert_eq!(fault(|r| r.pairs[1].colliders = [1, 0]), RobotError::Pair { colliders, fault: PairFault::Twice });
        let colliders = [name("a"), name("a")];
        assert_eq!(
            fault(|r| r.pairs[0].colliders = [0, 0]),
            RobotError::Pair { colliders, fault: PairFault::SameBody }
        );
        let colliders = [name("d"), name("e")];
        assert_eq!(fault(|r| r.pairs[0].colliders = [3, 4]), RobotError::Pair { colliders, fault: PairFault::Shapes });
        let many = fault(|r| r.pairs = alloc::vec![r.pairs[0]; 65536]);
        assert_eq!(many, RobotError::Count { parts: "pairs", count: 65536 });
    }

    #[test]
    fn faults_of_numbers() {
        type Change = fn(&mut Robot);
        let values: [(&str, Change); 30] = [
            ("rotation", |r| r.segments[0].joint.placement.rotation[3] = 1.1),
            ("rotation", |r| r.colliders[0].placement.rotation[0] = f64::NAN),
            ("position", |r| r.colliders[0].placement.position[0] = f64::INFINITY),
            ("mass", |r| r.segments[0].mass = -1.0),
            ("mass", |r| r.segments[2].mass = f64::NAN),
            ("centre of mass", |r| r.segments[0].centre[2] = f64::NAN),
            ("inertia", |r| r.segments[0].inertia[5] = f64::NAN),
            ("armature", |r| r.segments[0].joint.armature = -1.0),
            ("joint damping", |r| r.segments[0].joint.damping = f64::NAN),
            ("axis", |r| r.segments[0].joint.axis = [0.0; 3]),
            ("axis", |r| r.segments[0].joint.axis[0] = f64::NAN),
            ("radius", |r| r.colliders[0].shape = Shape::Sphere { radius: 0.0 }),
            ("half length", |r| r.colliders[0].shape = Shape::Capsule { radius: 1.0, half_length: -1.0 }),
            ("half edge length", |r| r.colliders[0].shape = Shape::Box { half: [1.0, 0.0, 1.0] }),
            ("friction", |r| r.pairs[0].surface.friction = -0.1),
            ("rolling friction", |r| r.pairs[0].surface.rolling_friction = f64::NAN),
            ("contact stiffness", |r| r.pairs[0].surface.stiffness = 0.0),
            ("contact damping", |r| r.pairs[0].surface.damping = -1.0),
            ("tension", |r| muscles(r).tension = f64::NAN),
            ("moment arm", |r| muscles(r).moment_arm = -0.01),
            ("range", |r| muscles(r).upper = f64::INFINITY),
            ("upper end of the range", |r| muscles(r).upper = muscles(r).lower),
            ("rest length", |r| muscles(r).rest_length = 1.0),
            ("longest length", |r| muscles(r).longest = 2.5),
            ("shape", |r| muscles(r).shape = 0.0),
            ("viscosity", |r| muscles(r).viscosity = -0.9),
            ("limit", |r| r.actuators[2].law = Law::Torque(Torque { limit: f64::NAN })),
            ("damping", |r| r.actuators[3].law = Law::Held(Held { stiffness: 1.0, damping: -1.0 })),
            ("colour", |r| r.colliders[0].color = Some([0.0, 1.5, 0.0])),
            ("gain", |r| r.actuators[3].law = Law::Velocity(Velocity { gain: -1.0, limit: 1.0 })),
        ];
        for (expected, change) in values {
            let error = fault(change);
            let RobotError::Value { part, field, .. } = &error else { panic!("{expected}: {error}") };
            assert!(field.contains(expected), "{expected}: {error}");
            assert_eq!(format!("{error}").find(part.as_str()), Some(0), "the message names the part");
        }
        for range in [[1.0, -1.0], [f64::NAN, 1.0], [f64::INFINITY; 2]] {
            let error = fault(|r| r.segments[0].joint.range = range);
            assert!(matches!(&error, RobotError::Range { joint, .. } if joint == "hinge"), "{error}");
        }
        let impossible: Vec<fn(&mut Robot)> =
            alloc::vec![|r| r.segments[0].mass = 0.0, |r| r.segments[3].inertia = [0.0; 6], |r| r.segments[1]
                .inertia =
                [1.0, 1.0, 3.0, 0.0, 0.0, 0.0],];
        for change in impossible {
            let error = fault(change);
            assert!(matches!(error, RobotError::Inertia { .. }), "{error}");
        }
    }
}
