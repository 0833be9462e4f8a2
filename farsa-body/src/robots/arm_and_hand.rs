//! The arm and hand of the experiment `reach-grasp-lift`: seven muscle-driven joints, twenty in the hand.

use alloc::format;
use alloc::vec::Vec;

use crate::actuators::law::{Law, Servo};
use crate::actuators::muscle::{MusclePair, MuscleVariant};
use crate::motors::joints::ServoRange;
use crate::ports::{ActuatorId, BodyId, JointId};
use crate::pose::Pose;
use crate::robot::description::{Collider, Joint, Robot, Segment, Surface};
use crate::robot::mass_properties::MassProperties;
use crate::robot::shape::Shape;
use crate::robot::validation::RobotError;

/// One of the five fingers, in the order of their joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Finger {
    /// J8 (opposition), J9 to J11.
    Thumb,
    /// J12 (abduction), J13 to J15.
    Index,
    /// J16 (abduction), J17 to J19.
    Middle,
    /// J20 (abduction), J21 to J23.
    Ring,
    /// J24 (abduction), J25 to J27.
    Little,
}

impl Finger {
    /// All fingers, from the thumb to the little finger.
    pub const ALL: [Self; 5] = [Self::Thumb, Self::Index, Self::Middle, Self::Ring, Self::Little];

    fn name(self) -> &'static str {
        ["thumb", "index", "middle", "ring", "little"][self as usize]
    }

    /// The number of its first joint, which abducts or opposes it.
    fn first_joint(self) -> u16 {
        8 + 4 * self as u16
    }
}

/// The names of a finger's phalanges, from the palm outwards.
const PHALANGES: [&str; 3] = ["proximal", "middle", "distal"];

const fn deg(x: f64) -> f64 {
    x * (core::f64::consts::PI / 180.0)
}

/// The right arm and hand of [Ferrauto2010] with the sizes of the iCub, every number a field.
///
/// At joint positions 0 the arm points straight forward (+X of the world), horizontal, palm down, thumb to the left
/// (+Y); all segments' axes are then those of the world. The palm's frame lies in the wrist: x to the fingertips, y to
/// the thumb, z out of the *back* of the hand. The arm hangs in the world, not on a torso.
///
/// Joints, segments and actuators are numbered alike: joint Jn carries segment n - 1 and is driven by actuator n - 1.
/// Deviations from the source: it does not say where the axes lie, so the geometry, the masses, the limits of the arm
/// but the elbow's, joint damping and armature are our own choice, found by trial in another simulator.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct ArmAndHand {
    /// Where the axes of J1 to J3 meet, in the world [m].
    pub shoulder: [f64; 3],
    /// From the shoulder to the elbow [m].
    pub upper_arm_length: f64,
    /// From the elbow to the wrist [m].
    pub forearm_length: f64,
    /// Ranges of J1 to J7 [rad].
    pub arm_ranges: [[f64; 2]; 7],
    /// Largest active tension of the muscles of J1 to J7, Tmax [N].
    pub tensions: [f64; 7],
    /// Moment arm of all muscles [m].
    pub moment_arm: f64,
    /// Which reading of the muscle model.
    pub muscle_variant: MuscleVariant,
    /// The reduction factor of [`MuscleVariant::Original`] on the passive tension, beside its 0.5; the other ignores
    /// it.
    pub passive_reduction: f64,
    /// Viscous damping of the arm's joints divided by the muscles' largest active torque, r Tmax [s/rad]; 0 for none.
    pub damping_per_torque: f64,
    /// Armature of the arm's joints [kg m2].
    pub arm_armature: f64,
    /// Armature of the hand's joints [kg m2].
    pub finger_armature: f64,
    /// The servo on each joint of the hand.
    pub servo: Servo<f64>,
    /// Passive viscous damping of the hand's joints [N m s/rad].
    pub finger_damping: f64,
    /// Masses of the segments on J1 to J7: two of the shoulder, upper arm, elbow, forearm, wrist, palm [kg].
    pub arm_masses: [f64; 7],
    /// Mass of each finger's segment on its first joint [kg].
    pub knuckle_mass: f64,
    /// Masses of the phalanges, from the palm outwards [kg].
    pub phalange_masses: [f64; 3],
    /// Radius of the upper arm's capsule, as long as the upper arm [m].
    pub upper_arm_radius: f64,
    /// Radius of the forearm's capsule [m].
    pub forearm_radius: f64,
    /// Length of the axis of the forearm's capsule, from the elbow [m].
    pub forearm_axis: f64,
    /// Half the palm's edge lengths [m].
    pub palm_half: [f64; 3],
    /// Centre of the palm's box in the palm's frame [m].
    pub palm_box: [f64; 3],
    /// The point on the palm's inner face that counts as its centre, in the palm's frame [m].
    pub palm_centre: [f64; 3],
    /// Radii of the phalanges' capsules, from the palm outwards; their axes run from joint to joint, or to the tip [m].
    pub phalange_radii: [f64; 3],
    /// Lengths of the phalanges, from the palm outwards, for the fingers from the thumb to the little one [m].
    pub phalange_lengths: [[f64; 3]; 5],
    /// Bases of index, middle, ring and little finger in the palm's frame [m].
    pub finger_bases: [[f64; 3]; 4],
    /// Ranges of their abduction joints J12, J16, J20, J24 [rad].
    pub abduction_ranges: [[f64; 2]; 4],
    /// Base of the thumb in the palm's frame [m].
    pub thumb_base: [f64; 3],
    /// From the thumb's base to its first flexion joint [m].
    pub thumb_link: f64,
    /// Range of the thumb's opposition J8 [rad].
    pub opposition_range: [f64; 2],
    /// Range of the fifteen flexion joints [rad].
    pub flexion_range: [f64; 2],
    /// Contact of the hand's phalanges with each other.
    pub surface: Surface,
}

impl Default for ArmAndHand {
    fn default() -> Self {
        let range = |low: f64, high: f64| [deg(low), deg(high)];
        Self {
            shoulder: [-0.025, -0.108, 0.21],
            upper_arm_length: 0.152,
            forearm_length: 0.137,
            arm_ranges: [
                range(-140.0, 100.0),
                range(-110.0, 90.0),
                range(-110.0, 90.0),
                range(-170.0, 0.0),
                range(-100.0, 100.0),
                range(-100.0, 100.0),
                range(-40.0, 40.0),
            ],
            tensions: [300.0, 3000.0, 300.0, 300.0, 300.0, 200.0, 200.0],
            moment_arm: 0.010,
            muscle_variant: MuscleVariant::Thesis,
            passive_reduction: 1.0,
            damping_per_torque: 1.0 / 8.0,
            arm_armature: 0.010,
            finger_armature: 5e-4,
            servo: Servo { stiffness: 1.0, damping: 0.04, limit: 0.3 },
            finger_damping: 0.002,
            arm_masses: [0.19, 0.18, 0.884, 0.074, 0.525, 0.036, 0.15],
            knuckle_mass: 0.005,
            phalange_masses: [0.012, 0.008, 0.006],
            upper_arm_radius: 0.025,
            forearm_radius: 0.020,
            forearm_axis: 0.130,
            palm_half: [0.030, 0.031, 0.010],
            palm_box: [0.050, 0.0, 0.0],
            palm_centre: [0.0625, 0.0, -0.010],
            phalange_radii: [0.0065, 0.0060, 0.0055],
            phalange_lengths: [
                [0.0260, 0.0220, 0.0168],
                [0.0259, 0.0220, 0.0168],
                [0.0285, 0.0240, 0.0168],
                [0.0259, 0.0220, 0.0168],
                [0.0219, 0.0190, 0.0168],
            ],
            finger_bases: [[0.080, 0.025, 0.0], [0.080, 0.008, 0.0], [0.080, -0.008, 0.0], [0.080, -0.024, 0.0]],
            abduction_ranges: [range(0.0, 15.0), range(-2.0, 2.0), range(-10.0, 0.0), range(-15.0, 0.0)],
            thumb_base: [0.028, 0.020, -0.002],
            thumb_link: 0.010,
            opposition_range: range(-120.0, 0.0),
            flexion_range: range(-90.0, 0.0),
            surface: Surface { friction: 1.0, rolling_friction: 0.0, stiffness: 2e5, damping: 100.0 },
        }
    }
}

impl ArmAndHand {
    /// The palm.
    pub const PALM: BodyId = BodyId(6);
    /// The outward normal of the palm's inner face, in the palm's frame.
    pub const PALM_NORMAL: [f64; 3] = [0.0, 0.0, -1.0];
    /// Indices of the colliders of upper arm, forearm and palm; those of the phalanges follow.
    pub const ARM_COLLIDERS: [usize; 3] = [0, 1, 2];

    /// J1 to J27.
    pub fn joints() -> [JointId; 27] {
        core::array::from_fn(|i| JointId(i as u16))
    }

    /// The fifteen joints that flex, from the thumb's to the little finger's, each from the palm outwards.
    pub fn flexion_joints() -> [JointId; 15] {
        core::array::from_fn(|i| JointId(8 + i as u16 / 3 * 4 + i as u16 % 3))
    }

    /// The three phalanges of a finger, from the palm outwards.
    pub fn phalanges(finger: Finger) -> [BodyId; 3] {
        [0, 1, 2].map(|i| BodyId(finger.first_joint() + i))
    }

    /// The indices of their colliders.
    pub fn phalange_colliders(finger: Finger) -> [usize; 3] {
        [0, 1, 2].map(|i| 3 + 3 * finger as usize + i)
    }

    /// The distal phalange of a finger and its tip in that frame [m]: the end of the capsule's axis, one radius within
    /// its surface.
    pub fn fingertip(&self, finger: Finger) -> (BodyId, [f64; 3]) {
        let tip = self.phalange_lengths[finger as usize][2];
        (Self::phalanges(finger)[2], if finger == Finger::Thumb { [0.0, tip, 0.0] } else { [tip, 0.0, 0.0] })
    }

    /// The nine groups of servos that each follow one output, with their positions at output 0 (extended, fingers
    /// together) and 1 (flexed, spread).
    ///
    /// In this order: J8; J9; J10, J11; J13; J14, J15; J17; J18, J19; J12, J16, J20, J24 (abduction: index and middle
    /// from the lower to the upper limit, ring and little the other way); J21 to J23, J25 to J27 [Ferrauto2010, chapter
    /// 2].
    pub fn servo_groups(&self) -> [Vec<ServoRange>; 9] {
        let servo =
            |n: u16, from: f64, to: f64| ServoRange { servo: ActuatorId(n - 1), from: from as f32, to: to as f32 };
        let [flexed, extended] = self.flexion_range;
        let flexion = |joints: &[u16]| joints.iter().map(|n| servo(*n, extended, flexed)).collect();
        let [opposed, aside] = self.opposition_range;
        let abduction = [12, 16, 20, 24].into_iter().zip(self.abduction_ranges);
        [
            alloc::vec![servo(8, aside, opposed)],
            flexion(&[9]),
            flexion(&[10, 11]),
            flexion(&[13]),
            flexion(&[14, 15]),
            flexion(&[17]),
            flexion(&[18, 19]),
            abduction.map(|(n, [low, high])| if n < 20 { servo(n, low, high) } else { servo(n, high, low) }).collect(),
            flexion(&[21, 22, 23, 25, 26, 27]),
        ]
    }

    /// The robot: segments `shoulder_base`, `shoulder`, `upper_arm`, `elbow`, `forearm`, `wrist`, `palm`, then per
    /// finger `thumb_knuckle`, `thumb_proximal`, `thumb_middle`, `thumb_distal`; colliders named as their segments.
    ///
    /// Upper arm, forearm, palm and phalanges have their collider's inertia as solids; the other segments that of balls
    /// as thick as their neighbours. The pairs are the thumb's two outer phalanges with the other fingers' two outer
    /// ones, neighbouring fingers' distal ones, and the palm with the thumb's two outer phalanges and the others'
    /// distal ones; use [`crate::Tabletop`] or [`Robot::add_pair`] for others.
    ///
    /// # Errors
    /// What [`Robot::validate`] finds with the numbers given.
    pub fn robot(&self) -> Result<Robot, RobotError> {
        let mut robot = Robot::new("arm_and_hand");
        self.add_arm(&mut robot);
        for finger in Finger::ALL {
            self.add_finger(&mut robot, finger);
        }
        self.add_actuators(&mut robot);
        let [_, thumb_middle, thumb_distal] = Self::phalange_colliders(Finger::Thumb);
        for thumb in [thumb_middle, thumb_distal] {
            for finger in &Finger::ALL[1..] {
                let [_, middle, distal] = Self::phalange_colliders(*finger);
                robot.add_pair([thumb, middle], self.surface);
                robot.add_pair([thumb, distal], self.surface);
            }
        }
        for fingers in Finger::ALL[1..].windows(2) {
            let distal = [fingers[0], fingers[1]].map(|finger| Self::phalange_colliders(finger)[2]);
            robot.add_pair(distal, self.surface);
        }
        // A closed hand without something in it would reach through its own palm.
        let palm = Self::ARM_COLLIDERS[2];
        let others = Finger::ALL[1..].iter().map(|finger| Self::phalange_colliders(*finger)[2]);
        for phalanx in [thumb_middle, thumb_distal].into_iter().chain(others) {
            robot.add_pair([phalanx, palm], self.surface);
        }
        robot.validate()?;
        Ok(robot)
    }

    fn add_arm(&self, robot: &mut Robot) {
        let [shoulder_base, shoulder, upper_arm, elbow, forearm, wrist, palm] = self.arm_masses;
        let (thick, thin) = (self.upper_arm_radius, self.forearm_radius);
        let capsule = |name, body, length, radius| {
            Collider::capsule_between(name, Some(BodyId(body)), [0.0; 3], [length, 0.0, 0.0], radius)
        };
        let upper_arm_shape = capsule("upper_arm", 2, self.upper_arm_length, thick);
        let forearm_shape = capsule("forearm", 4, self.forearm_axis, thin);
        let half = self.palm_half;
        let palm_shape = Collider::new("palm", Some(Self::PALM), Shape::Box { half }, Pose::at(self.palm_box));
        let ball = MassProperties::sphere;
        // Name, axis, place in the parent's frame, body.
        let (here, elbow_at) = ([0.0; 3], [self.upper_arm_length, 0.0, 0.0]);
        let parts = [
            ("shoulder_base", [0.0, 0.0, 1.0], self.shoulder, ball(shoulder_base, thick)),
            ("shoulder", [0.0, -1.0, 0.0], here, ball(shoulder, thick)),
            ("upper_arm", [-1.0, 0.0, 0.0], here, upper_arm_shape.mass_properties(upper_arm)),
            ("elbow", [0.0, 0.0, -1.0], elbow_at, ball(elbow, thin)),
            ("forearm", [1.0, 0.0, 0.0], here, forearm_shape.mass_properties(forearm)),
            ("wrist", [0.0, 1.0, 0.0], [self.forearm_length, 0.0, 0.0], ball(wrist, thin)),
            ("palm", [0.0, 0.0, 1.0], here, palm_shape.mass_properties(palm)),
        ];
        let mut parent = None;
        for (i, (name, axis, at, body)) in parts.into_iter().enumerate() {
            let damping = self.damping_per_torque * self.moment_arm * self.tensions[i];
            let joint = Joint::revolute(&format!("J{}", i + 1), axis, Pose::at(at), self.arm_ranges[i])
                .with_armature(self.arm_armature)
                .with_damping(damping);
            parent = Some(robot.add_segment(Segment::new(name, parent, joint, body)));
        }
        robot.colliders.extend([upper_arm_shape, forearm_shape, palm_shape]);
    }

    fn add_finger(&self, robot: &mut Robot, finger: Finger) {
        let number = finger.first_joint();
        // The thumb's phalanges lie along y and flex about z, so that opposition turns them under the palm.
        let thumb = finger == Finger::Thumb;
        let (base, first_axis, range, link, along, flexion_axis) = if thumb {
            let link = [0.0, self.thumb_link, 0.0];
            (self.thumb_base, [1.0, 0.0, 0.0], self.opposition_range, link, [0.0, 1.0, 0.0], [0.0, 0.0, 1.0])
        } else {
            let i = finger as usize - 1;
            let (base, range) = (self.finger_bases[i], self.abduction_ranges[i]);
            (base, [0.0, 0.0, 1.0], range, [0.0; 3], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0])
        };
        let joint = |n: u16, axis, at, range| {
            Joint::revolute(&format!("J{n}"), axis, Pose::at(at), range)
                .with_armature(self.finger_armature)
                .with_damping(self.finger_damping)
        };
        let knuckle = MassProperties::sphere(self.knuckle_mass, self.phalange_radii[0]);
        let knuckle = knuckle.placed(&Pose::at(link.map(|x| x / 2.0)));
        let name = format!("{}_knuckle", finger.name());
        let first = joint(number, first_axis, base, range);
        let mut parent = robot.add_segment(Segment::new(&name, Some(Self::PALM), first, knuckle));
        let mut at = link;
        for (i, part) in PHALANGES.iter().enumerate() {
            let name = format!("{}_{part}", finger.name());
            let end = along.map(|x| x * self.phalange_lengths[finger as usize][i]);
            let body = BodyId(number + i as u16);
            let shape = Collider::capsule_between(&name, Some(body), [0.0; 3], end, self.phalange_radii[i]);
            let mass = shape.mass_properties(self.phalange_masses[i]);
            let flexion = joint(number + 1 + i as u16, flexion_axis, at, self.flexion_range);
            parent = robot.add_segment(Segment::new(&name, Some(parent), flexion, mass));
            robot.add_collider(shape);
            at = end;
        }
    }

    fn add_actuators(&self, robot: &mut Robot) {
        for (i, joint) in Self::joints().into_iter().enumerate() {
            let law = if let (Some(tension), Some(range)) = (self.tensions.get(i), self.arm_ranges.get(i)) {
                Law::MusclePair(match self.muscle_variant {
                    MuscleVariant::Thesis => MusclePair::thesis(*tension, self.moment_arm, *range),
                    MuscleVariant::Original => {
                        MusclePair::original(*tension, self.moment_arm, *range, self.passive_reduction)
                    }
                })
            } else {
                Law::Servo(self.servo)
            };
            robot.add_actuator(&format!("J{}", i + 1), joint, law);
        }
    }
}
