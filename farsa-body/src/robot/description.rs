//! The description of a robot. This consists of segments, joints, shapes, actuators and pairs that may touch.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::actuators::law::Law;
use crate::ports::{ActuatorId, BodyId, JointId, PairId};
use crate::pose::{Pose, norm};
use crate::robot::impedance::Impedance;
use crate::robot::joint::Joint;
use crate::robot::mass_properties::MassProperties;
use crate::robot::shape::Shape;
use crate::robot::visual::Visual;

/// A rigid part of the robot, together with its joint. Its frame moves with the joint.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Segment {
    /// Name of the segment, unique in the robot.
    pub name: String,
    /// Parent of the segment, or `None` for the world. It must be earlier in the list.
    pub parent: Option<BodyId>,
    /// Joint that connects the segment to its parent.
    pub joint: Joint,
    /// Mass of the segment in kilograms.
    pub mass: f64,
    /// Center of mass in the frame of the segment (in meters).
    pub centre: [f64; 3],
    /// Inertia about the center of mass in the axes of the segment [xx, yy, zz, xy, xz, yz, kg m2].
    pub inertia: [f64; 6],
}

/// A shape attached to a segment or to the world.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Collider {
    /// Name of the collider, unique in the robot.
    pub name: String,
    /// Segment to which the collider is attached, or `None` for the world.
    pub body: Option<BodyId>,
    /// Shape of the collider.
    pub shape: Shape,
    /// Pose of the collider in the frame of the segment.
    pub placement: Pose<f64>,
    /// Red, green and blue components of the color that cameras see (between 0 and 1). A collider without a color
    /// is invisible for cameras in a plane ([`Sight`](crate::ports::Sight)). In images
    /// ([`Vision`](crate::ports::Vision)) it hides everything behind it.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub color: Option<[f64; 3]>,
}

/// The properties of a contact between two surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Surface {
    /// Coefficient of sliding friction.
    pub friction: f64,
    /// Resistance to rolling and spinning, as the ratio of the largest torque and the normal force (in meters).
    pub rolling_friction: f64,
    /// Normal stiffness of a contact point (in N/m).
    pub stiffness: f64,
    /// Normal damping of a contact point (in N s/m).
    pub damping: f64,
}

/// A pair of colliders that may touch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pair {
    /// Indices of the two colliders.
    pub colliders: [usize; 2],
    /// Properties of the contact between them.
    pub surface: Surface,
    /// Consecutive pairs with the same number can be skipped together. This happens while the spheres around all first
    /// and all second colliders are far apart. Groups do not change the motion.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub group: Option<u16>,
    /// Further properties of contacts that act like those of MuJoCo.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub soft: Option<SoftContact>,
    /// Coefficient of restitution in [0..1], the share of the normal speed that is left after a fast impact. URDF and MJCF
    /// have none.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "crate::robot::joint::is_zero"))]
    pub restitution: f64,
}

/// Properties of contacts that stop motion gradually, like those of MuJoCo.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SoftContact {
    /// Inertia that a touching point adds along its normal (in kg).
    pub inertia: f64,
    /// Damping and inertia with which friction stops a point, as long as it is below its limit (in N s/m and kg).
    pub friction: [f64; 2],
    /// Distance of the surfaces at which the contact begins and its depth is 0 (in meters).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "crate::robot::joint::is_zero"))]
    pub margin: f64,
    /// True for MuJoCo's pyramid of four edges instead of a round cone of friction. Each edge is a separate contact along
    /// the normal plus or minus a tangent times the friction, with a quarter of spring, damper and inertia. A point that
    /// slides is lifted.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "is_false"))]
    pub is_pyramid: bool,
    /// Impedance over the depth, which otherwise is constant.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub impedance: Option<Impedance>,
}

#[cfg(feature = "serde")]
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_false(x: &bool) -> bool {
    !*x
}

/// An actuator that drives a joint.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Actuator {
    /// Name of the actuator, unique in the robot.
    pub name: String,
    /// Joint that the actuator drives.
    pub joint: JointId,
    /// Law that determines the torque.
    pub law: Law<f64>,
    /// Lowest and highest first command, in the unit of the law's command. Worlds clamp commands to it.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub command_range: Option<[f64; 2]>,
}

/// The ground below a body that slides in a plane. It exerts friction on the body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ground {
    /// Body created by [`Robot::add_sliding_body`].
    pub body: BodyId,
    /// Coefficient of friction between the body and the ground.
    pub friction: f64,
    /// Force that presses the body on the ground (in newtons), for example its weight.
    pub load: f64,
    /// Effective radius for the friction of a rotating body (in meters). For a disc with uniform pressure it is two
    /// thirds of its radius.
    pub radius: f64,
}

/// The description of a robot or of a scene with robots and objects. All worlds are built from it.
#[derive(Clone, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Robot {
    /// Name of the robot.
    pub name: String,
    /// Segments of the robot. Parents must come before their children.
    pub segments: Vec<Segment>,
    /// Shapes that are used for contacts and sensors.
    pub colliders: Vec<Collider>,
    /// Pairs of colliders that may touch.
    pub pairs: Vec<Pair>,
    /// Actuators that drive the joints.
    pub actuators: Vec<Actuator>,
    /// Ground below sliding bodies.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub grounds: Vec<Ground>,
    /// Shapes drawn instead of the colliders. They are ignored by worlds.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub visuals: Vec<Visual>,
}

/// The indices at which the parts of a merged robot start. It is returned by [`Robot::merge`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Offsets {
    /// Index of the first segment.
    pub segments: usize,
    /// Index of the first collider.
    pub colliders: usize,
    /// Index of the first pair.
    pub pairs: usize,
    /// Index of the first actuator.
    pub actuators: usize,
}

impl Offsets {
    /// Returns the new identifier of a body.
    pub fn body(&self, body: BodyId) -> BodyId {
        BodyId((self.segments + body.index()) as u16)
    }

    /// Returns the new identifier of a joint.
    pub fn joint(&self, joint: JointId) -> JointId {
        JointId((self.segments + joint.index()) as u16)
    }

    /// Returns the new identifier of an actuator.
    pub fn actuator(&self, actuator: ActuatorId) -> ActuatorId {
        ActuatorId((self.actuators + actuator.index()) as u16)
    }

    /// Returns the new identifier of a pair.
    pub fn pair(&self, pair: PairId) -> PairId {
        PairId((self.pairs + pair.index()) as u16)
    }

    /// Returns the new index of a collider.
    pub fn collider(&self, collider: usize) -> usize {
        self.colliders + collider
    }
}

impl Segment {
    /// Creates a segment with the given mass properties. The parent is `None` for the world.
    pub fn new(name: &str, parent: Option<BodyId>, joint: Joint, body: MassProperties) -> Self {
        let MassProperties { mass, centre, inertia } = body;
        Self { name: name.into(), parent, joint, mass, centre, inertia }
    }

    /// Returns the mass, the center of mass and the inertia in the frame of the segment.
    pub fn mass_properties(&self) -> MassProperties {
        MassProperties { mass: self.mass, centre: self.centre, inertia: self.inertia }
    }
}

impl Collider {
    /// Creates a collider at the given pose in the frame of `body`, or in the world for `None`.
    pub fn new(name: &str, body: Option<BodyId>, shape: Shape, placement: Pose<f64>) -> Self {
        Self { name: name.into(), body, shape, placement, color: None }
    }

    /// Sets the color that cameras see, with red, green and blue in [0..1].
    #[must_use]
    pub fn with_color(self, color: [f64; 3]) -> Self {
        Self { color: Some(color), ..self }
    }

    /// Creates a capsule whose axis extends from point `a` to point `b` in the frame of the body (in meters). If the
    /// points coincide, the result is a sphere.
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

    /// Computes the mass properties of a solid with this shape and the given mass (in kilograms) in the frame of the
    /// body.
    pub fn mass_properties(&self, mass: f64) -> MassProperties {
        MassProperties::from_shape(&self.shape, mass).placed(&self.placement)
    }
}

impl Robot {
    /// Creates a robot without any parts.
    pub fn new(name: &str) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// Adds a segment. Its parent must have been added before.
    pub fn add_segment(&mut self, segment: Segment) -> BodyId {
        self.segments.push(segment);
        BodyId((self.segments.len() - 1) as u16)
    }

    /// Adds a collider and returns its index.
    pub fn add_collider(&mut self, collider: Collider) -> usize {
        self.colliders.push(collider);
        self.colliders.len() - 1
    }

    /// Adds a pair of colliders that may touch. They are given by their indices.
    pub fn add_pair(&mut self, colliders: [usize; 2], surface: Surface) -> PairId {
        self.pairs.push(Pair { colliders, surface, group: None, soft: None, restitution: 0.0 });
        PairId((self.pairs.len() - 1) as u16)
    }

    /// Adds a group of pairs, given by the indices of their colliders. The group needs almost no time as long
    /// as its first and its second colliders are far apart. This is useful for colliders that move together, such as
    /// the parts of a hand.
    pub fn add_pair_group(&mut self, pairs: impl IntoIterator<Item = [usize; 2]>, surface: Surface) {
        let group = Some(self.first_group());
        self.pairs.extend(pairs.into_iter().map(|colliders| Pair {
            colliders,
            surface,
            group,
            soft: None,
            restitution: 0.0,
        }));
    }

    /// A number that no group has.
    fn first_group(&self) -> u16 {
        self.pairs.iter().filter_map(|pair| pair.group).max().map_or(0, |group| group.saturating_add(1))
    }

    /// Adds an actuator that drives `joint`. The efforts of all actuators of a joint add up.
    pub fn add_actuator(&mut self, name: &str, joint: JointId, law: Law<f64>) -> ActuatorId {
        self.actuators.push(Actuator { name: name.into(), joint, law, command_range: None });
        ActuatorId((self.actuators.len() - 1) as u16)
    }

    /// Adds all parts of another robot and returns their offsets.
    ///
    /// No pairs between the two robots are added. Names are not changed. Use [`Robot::prefixed`] to avoid duplicates,
    /// which are detected by [`Robot::validate`].
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

    /// Returns a copy in which `prefix` is added to all names except that of the robot. Empty names stay empty.
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

    /// Returns an iterator over the joints with one degree of freedom, in the order of their segments.
    pub fn joints(&self) -> impl Iterator<Item = JointId> + '_ {
        let single = |(i, s): (usize, &Segment)| s.joint.kind.is_single().then_some(JointId(i as u16));
        self.segments.iter().enumerate().filter_map(single)
    }

    /// Returns an iterator over the bodies that have a collider or a visual, in the order of their segments.
    pub fn shaped_bodies(&self) -> impl Iterator<Item = BodyId> + '_ {
        let bodies = (0..self.segments.len()).map(|i| BodyId(i as u16));
        bodies.filter(|body| {
            self.colliders.iter().any(|collider| collider.body == Some(*body))
                || self.visuals.iter().any(|visual| visual.body == Some(*body))
        })
    }

    /// Returns the body with the given name.
    pub fn body(&self, name: &str) -> Option<BodyId> {
        self.segments.iter().position(|s| s.name == name).map(|i| BodyId(i as u16))
    }

    /// Returns the joint with the given name.
    pub fn joint(&self, name: &str) -> Option<JointId> {
        self.segments.iter().position(|s| s.joint.name == name).map(|i| JointId(i as u16))
    }

    /// Returns the actuator with the given name.
    pub fn actuator(&self, name: &str) -> Option<ActuatorId> {
        self.actuators.iter().position(|a| a.name == name).map(|i| ActuatorId(i as u16))
    }

    /// Returns the index of the collider with the given name.
    pub fn collider(&self, name: &str) -> Option<usize> {
        self.colliders.iter().position(|c| c.name == name)
    }

    /// Returns the pair of the colliders with the given names, in either order.
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
