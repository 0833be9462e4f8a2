//! A robot as data: segments and their joints, shapes, actuators and the pairs that may touch.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::actuators::law::Law;
use crate::ports::{ActuatorId, BodyId, JointId, PairId};
use crate::pose::{Pose, norm};
use crate::robot::mass_properties::MassProperties;
use crate::robot::shape::Shape;
use crate::robot::visual::Visual;

/// The motion of a segment relative to its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum JointKind {
    /// Turns about the joint's axis.
    Revolute,
    /// Slides along the joint's axis.
    Prismatic,
    /// Does not move.
    Fixed,
    /// Moves freely in the world. Only for a segment without parent.
    Floating,
}

/// The joint that carries a segment.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Joint {
    /// The joint's name, unique in the robot. May be empty for fixed and floating joints.
    pub name: String,
    /// The kind of motion.
    pub kind: JointKind,
    /// Axis in the joint's frame, normalized by the reader.
    pub axis: [f64; 3],
    /// The joint's frame in the parent's frame (the world's without parent), at joint position 0.
    pub placement: Pose<f64>,
    /// Lowest and highest position [rad or m], or infinite for none.
    pub range: [f64; 2],
    /// Inertia of the drive, added to the joint's own [kg m2 or kg].
    pub armature: f64,
    /// Viscous damping [N m s/rad or N s/m].
    pub damping: f64,
}

/// A rigid part of the robot with the joint that carries it. Its frame is the joint's frame after the motion.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Segment {
    /// The segment's name, unique in the robot.
    pub name: String,
    /// The segment that it hangs on, earlier in the list, or `None` for the world.
    pub parent: Option<BodyId>,
    /// The joint to the parent.
    pub joint: Joint,
    /// Mass [kg].
    pub mass: f64,
    /// Center of mass in the segment's frame [m].
    pub centre: [f64; 3],
    /// Inertia about the center of mass in the segment's axes [xx, yy, zz, xy, xz, yz, kg m2].
    pub inertia: [f64; 6],
}

/// A shape fixed to a segment or to the world.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Collider {
    /// The collider's name, unique in the robot.
    pub name: String,
    /// The segment it moves with, or `None` for the world.
    pub body: Option<BodyId>,
    /// Its form.
    pub shape: Shape,
    /// Its frame in the segment's frame.
    pub placement: Pose<f64>,
    /// The color it shows to cameras, red, green and blue [0..1]. Without one it is not there for cameras of a plane
    /// ([`Sight`](crate::ports::Sight)), and hides what is behind it from eyes with an image
    /// ([`Vision`](crate::ports::Vision)).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub color: Option<[f64; 3]>,
}

/// The interaction of two surfaces.
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
    /// The interaction of their surfaces.
    pub surface: Surface,
    /// Consecutive pairs with the same number may be searched together. They are searched only while the spheres around
    /// their first and around their second colliders are near each other. Grouping changes no motion.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub group: Option<u16>,
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

/// The ground below a body that slides in a plane, and rubs on it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ground {
    /// The body, as [`Robot::add_sliding_body`] makes it.
    pub body: BodyId,
    /// Coefficient of friction.
    pub friction: f64,
    /// The force that presses the body on the ground, such as its weight [N].
    pub load: f64,
    /// At which radius the ground acts on a body that turns: two thirds of that of a disc with even pressure [m].
    pub radius: f64,
}

/// A robot, or a scene of robots and things, as data. Every world is built from one.
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
    /// The ground below bodies that slide.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub grounds: Vec<Ground>,
    /// Shapes that views draw instead of the colliders of their segments. Worlds ignore them.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub visuals: Vec<Visual>,
}

/// Where the parts of a merged robot begin in the lists of the one that took them in, from [`Robot::merge`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Offsets {
    /// Index of its first segment.
    pub segments: usize,
    /// Index of its first collider.
    pub colliders: usize,
    /// Index of its first pair.
    pub pairs: usize,
    /// Index of its first actuator.
    pub actuators: usize,
}

impl Offsets {
    /// A body of the merged robot, by its new index.
    pub fn body(&self, body: BodyId) -> BodyId {
        BodyId((self.segments + body.index()) as u16)
    }

    /// A joint of the merged robot, by its new index.
    pub fn joint(&self, joint: JointId) -> JointId {
        JointId((self.segments + joint.index()) as u16)
    }

    /// An actuator of the merged robot, by its new index.
    pub fn actuator(&self, actuator: ActuatorId) -> ActuatorId {
        ActuatorId((self.actuators + actuator.index()) as u16)
    }

    /// A pair of the merged robot, by its new index.
    pub fn pair(&self, pair: PairId) -> PairId {
        PairId((self.pairs + pair.index()) as u16)
    }

    /// A collider of the merged robot, by its new index.
    pub fn collider(&self, collider: usize) -> usize {
        self.colliders + collider
    }
}

impl JointKind {
    /// Returns whether the joint has one degree of freedom: a position, a speed, a range.
    pub fn is_single(self) -> bool {
        matches!(self, Self::Revolute | Self::Prismatic)
    }
}

impl Joint {
    fn new(name: &str, kind: JointKind, axis: [f64; 3], placement: Pose<f64>, range: [f64; 2]) -> Self {
        Self { name: name.into(), kind, axis, placement, range, armature: 0.0, damping: 0.0 }
    }

    /// A joint that turns about `axis` within `range` [rad], without armature and damping.
    pub fn revolute(name: &str, axis: [f64; 3], placement: Pose<f64>, range: [f64; 2]) -> Self {
        Self::new(name, JointKind::Revolute, axis, placement, range)
    }

    /// A joint that slides along `axis` within `range` [m], without armature and damping.
    pub fn prismatic(name: &str, axis: [f64; 3], placement: Pose<f64>, range: [f64; 2]) -> Self {
        Self::new(name, JointKind::Prismatic, axis, placement, range)
    }

    /// A nameless joint that does not move.
    pub fn fixed(placement: Pose<f64>) -> Self {
        Self::new("", JointKind::Fixed, [0.0, 0.0, 1.0], placement, [0.0, 0.0])
    }

    /// A nameless joint that lets its segment move freely in the world, from `placement`.
    pub fn floating(placement: Pose<f64>) -> Self {
        Self::new("", JointKind::Floating, [0.0, 0.0, 1.0], placement, [0.0, 0.0])
    }

    /// Returns the joint with this armature [kg m2 or kg].
    #[must_use]
    pub fn with_armature(mut self, armature: f64) -> Self {
        self.armature = armature;
        self
    }

    /// Returns the joint with this viscous damping [N m s/rad or N s/m].
    #[must_use]
    pub fn with_damping(mut self, damping: f64) -> Self {
        self.damping = damping;
        self
    }
}

impl Segment {
    /// A segment on `parent` (`None` for the world) with these mass properties.
    pub fn new(name: &str, parent: Option<BodyId>, joint: Joint, body: MassProperties) -> Self {
        let MassProperties { mass, centre, inertia } = body;
        Self { name: name.into(), parent, joint, mass, centre, inertia }
    }

    /// Mass, center of mass and inertia in the segment's frame.
    pub fn mass_properties(&self) -> MassProperties {
        MassProperties { mass: self.mass, centre: self.centre, inertia: self.inertia }
    }
}

impl Collider {
    /// A shape on `body` (`None` for the world) at `placement` in its frame.
    pub fn new(name: &str, body: Option<BodyId>, shape: Shape, placement: Pose<f64>) -> Self {
        Self { name: name.into(), body, shape, placement, color: None }
    }

    /// Returns the collider with a color that cameras see, red, green and blue [0..1].
    #[must_use]
    pub fn with_color(self, color: [f64; 3]) -> Self {
        Self { color: Some(color), ..self }
    }

    /// Builds a capsule whose axis runs from point `a` to point `b` of the body's frame [m], of `radius` [m]. It is a
    /// ball where the points coincide.
    pub fn capsule_between(name: &str, body: Option<BodyId>, a: [f64; 3], b: [f64; 3], radius: f64) -> Self {
        let d = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        let length = norm(&d);
        let position = [0, 1, 2].map(|i| f64::midpoint(a[i], b[i]));
        // The shortest turn from z to d: the quaternion (z x d, |d| + z.d), normalized. Its length vanishes for d = -z.
        // A capsule looks the same with its ends exchanged, so d is turned to the upper half first.
        let d = if d[2] < 0.0 { d.map(|x| -x) } else { d };
        let [x, y, w] = [-d[1], d[0], length + d[2]];
        let n = norm(&[x, y, w]);
        let rotation = if n > 0.0 { [x / n, y / n, 0.0, w / n] } else { Pose::identity().rotation };
        Self::new(name, body, Shape::Capsule { radius, half_length: length / 2.0 }, Pose { position, rotation })
    }

    /// The mass properties of a solid of this shape and place with `mass` [kg], in the body's frame.
    pub fn mass_properties(&self, mass: f64) -> MassProperties {
        MassProperties::from_shape(&self.shape, mass).placed(&self.placement)
    }
}

impl Robot {
    /// A robot without parts.
    pub fn new(name: &str) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// Appends a segment. Its parent must be there already.
    pub fn add_segment(&mut self, segment: Segment) -> BodyId {
        self.segments.push(segment);
        BodyId((self.segments.len() - 1) as u16)
    }

    /// Appends a collider and returns its index.
    pub fn add_collider(&mut self, collider: Collider) -> usize {
        self.colliders.push(collider);
        self.colliders.len() - 1
    }

    /// Appends a pair of colliders, given by their indices, that may touch.
    pub fn add_pair(&mut self, colliders: [usize; 2], surface: Surface) -> PairId {
        self.pairs.push(Pair { colliders, surface, group: None });
        PairId((self.pairs.len() - 1) as u16)
    }

    /// Appends a group of pairs, given by the indices of their colliders. The group costs almost nothing while its
    /// first and its second colliders are apart. This pays for colliders that keep together, such as the parts of a
    /// hand.
    pub fn add_pair_group(&mut self, pairs: impl IntoIterator<Item = [usize; 2]>, surface: Surface) {
        let group = Some(self.first_group());
        self.pairs.extend(pairs.into_iter().map(|colliders| Pair { colliders, surface, group }));
    }

    /// A number that no group has.
    fn first_group(&self) -> u16 {
        self.pairs.iter().filter_map(|pair| pair.group).max().map_or(0, |group| group.saturating_add(1))
    }

    /// Appends an actuator on `joint`.
    pub fn add_actuator(&mut self, name: &str, joint: JointId, law: Law<f64>) -> ActuatorId {
        self.actuators.push(Actuator { name: name.into(), joint, law });
        ActuatorId((self.actuators.len() - 1) as u16)
    }

    /// Appends all parts of `other` and returns where they begin.
    ///
    /// No pair between the two is made. Names are kept: [`Robot::validate`] finds clashes, [`Robot::prefixed`] avoids
    /// them.
    pub fn merge(&mut self, other: &Robot) -> Offsets {
        let offsets = Offsets {
            segments: self.segments.len(),
            colliders: self.colliders.len(),
            pairs: self.pairs.len(),
            actuators: self.actuators.len(),
        };
        self.segments.extend(other.segments.iter().cloned().map(|mut segment| {
            segment.parent = segment.parent.map(|parent| offsets.body(parent));
            segment
        }));
        self.colliders.extend(other.colliders.iter().cloned().map(|mut collider| {
            collider.body = collider.body.map(|body| offsets.body(body));
            collider
        }));
        let group = self.first_group();
        self.pairs.extend(other.pairs.iter().map(|pair| Pair {
            colliders: pair.colliders.map(|collider| offsets.collider(collider)),
            group: pair.group.map(|number| number.saturating_add(group)),
            ..*pair
        }));
        self.actuators.extend(other.actuators.iter().cloned().map(|mut actuator| {
            actuator.joint = offsets.joint(actuator.joint);
            actuator
        }));
        self.grounds.extend(other.grounds.iter().map(|ground| Ground { body: offsets.body(ground.body), ..*ground }));
        self.visuals.extend(other.visuals.iter().map(|visual| {
            let body = visual.body.map(|body| offsets.body(body));
            Visual { body, ..*visual }
        }));
        offsets
    }

    /// Returns the robot with `prefix` before every name but its own. Empty names stay empty.
    #[must_use]
    pub fn prefixed(&self, prefix: &str) -> Self {
        let mut robot = self.clone();
        let segments = robot.segments.iter_mut().flat_map(|s| [&mut s.name, &mut s.joint.name]);
        let colliders = robot.colliders.iter_mut().map(|c| &mut c.name);
        let actuators = robot.actuators.iter_mut().map(|a| &mut a.name);
        for name in segments.chain(colliders).chain(actuators).filter(|name| !name.is_empty()) {
            *name = format!("{prefix}{name}");
        }
        robot
    }

    /// The joints with one degree of freedom, in the order of their segments.
    pub fn joints(&self) -> impl Iterator<Item = JointId> + '_ {
        let single = |(i, s): (usize, &Segment)| s.joint.kind.is_single().then_some(JointId(i as u16));
        self.segments.iter().enumerate().filter_map(single)
    }

    /// The bodies that have a collider or a visual, in the order of their segments.
    pub fn shaped_bodies(&self) -> impl Iterator<Item = BodyId> + '_ {
        let bodies = (0..self.segments.len()).map(|i| BodyId(i as u16));
        bodies.filter(|body| {
            self.colliders.iter().any(|collider| collider.body == Some(*body))
                || self.visuals.iter().any(|visual| visual.body == Some(*body))
        })
    }

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actuators::law::Servo;

    #[test]
    fn capsule_lies_between_its_ends() {
        let ends = [
            ([0.0; 3], [0.0, 0.0, 1.0]),
            ([0.0; 3], [0.0, 0.0, -1.0]),
            ([0.1, 0.2, 0.3], [0.4, -0.5, 0.1]),
            ([0.0; 3], [0.0, 1e-9, -1.0]),
            ([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]),
            ([0.3; 3], [0.3; 3]),
        ];
        for (a, b) in ends {
            let collider = Collider::capsule_between("c", None, a, b, 0.01);
            let Shape::Capsule { radius, half_length } = collider.shape else { panic!("no capsule") };
            assert_eq!(radius, 0.01);
            let norm: f64 = collider.placement.rotation.iter().map(|x| x * x).sum();
            assert!((norm - 1.0).abs() < 1e-14);
            let tips = [-1.0, 1.0].map(|s| collider.placement.transform([0.0, 0.0, s * half_length]));
            let near = |p: [f64; 3], q: [f64; 3]| (0..3).all(|i| (p[i] - q[i]).abs() < 1e-14);
            assert!(
                (near(tips[0], a) && near(tips[1], b)) || (near(tips[0], b) && near(tips[1], a)),
                "{a:?} {b:?} {tips:?}"
            );
        }
    }

    fn pendulum() -> Robot {
        let mut robot = Robot::new("pendulum");
        let fixed = Joint::fixed(Pose::identity());
        let base = robot.add_segment(Segment::new("base", None, fixed, MassProperties::sphere(0.0, 0.0)));
        let joint = Joint::revolute("hinge", [0.0, 1.0, 0.0], Pose::identity(), [-1.0, 1.0]).with_damping(0.1);
        let bob = robot.add_segment(Segment::new("bob", Some(base), joint, MassProperties::sphere(1.0, 0.1)));
        let ball =
            robot.add_collider(Collider::new("ball", Some(bob), Shape::Sphere { radius: 0.1 }, Pose::identity()));
        let floor = robot.add_collider(Collider::new("floor", None, Shape::Plane, Pose::at([0.0, 0.0, -1.0])));
        let surface = Surface { friction: 1.0, rolling_friction: 0.0, stiffness: 1e4, damping: 10.0 };
        robot.add_pair([ball, floor], surface);
        let law = Law::Servo(Servo { stiffness: 1.0, damping: 0.1, limit: 1.0 });
        robot.add_actuator("drive", JointId(bob.0), law);
        robot
    }

    #[test]
    fn merged_robots_keep_their_parts() {
        let one = pendulum();
        let mut scene = one.prefixed("left.");
        let offsets = scene.merge(&one.prefixed("right."));
        assert_eq!(offsets, Offsets { segments: 2, colliders: 2, pairs: 1, actuators: 1 });
        assert_eq!(scene.validate(), Ok(()));
        assert_eq!(scene.joint("right.hinge"), Some(offsets.joint(JointId(1))));
        assert_eq!(scene.body("right.bob"), Some(offsets.body(BodyId(1))));
        assert_eq!(scene.segments[3].parent, scene.body("right.base"));
        assert_eq!(scene.pair("right.floor", "right.ball"), Some(offsets.pair(PairId(0))));
        assert_eq!(scene.pair("left.floor", "right.ball"), None);
        assert_eq!(scene.actuator("right.drive"), Some(offsets.actuator(ActuatorId(0))));
        assert_eq!(scene.actuators[1].joint, JointId(3));
        assert_eq!(scene.collider("right.ball"), Some(offsets.collider(0)));
        assert_eq!(scene.colliders[2].body, scene.body("right.bob"));
        assert_eq!(scene.joints().collect::<Vec<_>>(), [JointId(1), JointId(3)]);
        assert!(scene.segments[0].joint.name.is_empty());
        let mut twins = one.clone();
        twins.merge(&one);
        assert!(twins.validate().is_err(), "two parts of one name");
    }
}
