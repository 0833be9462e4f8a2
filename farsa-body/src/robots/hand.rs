//! A hand with twenty joints and nine groups of servos. You can attach it to any palm on either side.

use alloc::format;
use alloc::vec::Vec;

use crate::actuators::law::{Law, Servo};
use crate::motors::joints::ServoRange;
use crate::ports::{ActuatorId, BodyId, JointId};
use crate::pose::Pose;
use crate::robot::description::{Collider, Robot, Segment, Surface};
use crate::robot::joint::Joint;
use crate::robot::mass_properties::MassProperties;
use crate::robot::shape::Shape;
use crate::robots::mirror;

/// The five fingers in the order of their joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Finger {
    /// Thumb, with the opposition J8 and the joints J9 to J11.
    Thumb,
    /// Index finger, with the abduction J12 and the joints J13 to J15.
    Index,
    /// Middle finger, with the abduction J16 and the joints J17 to J19.
    Middle,
    /// Ring finger, with the abduction J20 and the joints J21 to J23.
    Ring,
    /// Little finger, with the abduction J24 and the joints J25 to J27.
    Little,
}

impl Finger {
    /// All fingers from the thumb to the little finger.
    pub const ALL: [Self; 5] = [Self::Thumb, Self::Index, Self::Middle, Self::Ring, Self::Little];

    fn name(self) -> &'static str {
        ["thumb", "index", "middle", "ring", "little"][self as usize]
    }

    /// The number of its first joint. This joint abducts or opposes it.
    pub(crate) fn first_joint(self) -> u16 {
        FIRST + 4 * self as u16
    }
}

/// The number of the hand's first joint: the arm has seven.
const FIRST: u16 = 8;

/// The names of a finger's phalanges, from the palm outwards.
const PHALANGES: [&str; 3] = ["proximal", "middle", "distal"];

pub(crate) const fn deg(x: f64) -> f64 {
    x * (core::f64::consts::PI / 180.0)
}

/// Where a hand is attached, and which one it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wrist<'a> {
    /// Body of the palm.
    pub(crate) palm: BodyId,
    /// Prefix of all names.
    pub(crate) prefix: &'a str,
    /// True if the hand is a left one.
    pub(crate) mirrored: bool,
}

impl Wrist<'_> {
    fn point(&self, p: [f64; 3]) -> [f64; 3] {
        if self.mirrored { mirror::point(p) } else { p }
    }

    fn axis(&self, a: [f64; 3]) -> [f64; 3] {
        if self.mirrored { mirror::axis(a) } else { a }
    }
}

/// The hand of [Ferrauto2010]. Its five fingers have four joints each, and nine groups of servos drive the joints. All
/// values can be changed.
///
/// The values describe the right hand in the frame of the palm. The origin is in the wrist, x points to the fingertips,
/// y to the thumb, and z out of the *back* of the hand. The left hand is the mirror image, with y pointing away from
/// the thumb. The joints are named J8 to J27, and a robot with two hands adds a prefix. For deviations from the source,
/// see [`crate::robots::ArmAndHand`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Hand {
    /// Mass of the palm in kilograms.
    pub palm_mass: f64,
    /// Half the edge lengths of the palm (in meters).
    pub palm_half: [f64; 3],
    /// Center of the palm's box in the frame of the palm (in meters).
    pub palm_box: [f64; 3],
    /// Point on the inner side of the palm used as its center, in the frame of the palm (in meters).
    pub palm_centre: [f64; 3],
    /// Armature of the joints (in kg m2).
    pub armature: f64,
    /// Passive viscous damping of the joints (in N m s/rad).
    pub damping: f64,
    /// Servo of each joint.
    pub servo: Servo<f64>,
    /// Mass of the first segment of each finger (in kilograms).
    pub knuckle_mass: f64,
    /// Masses of the phalanges, starting at the palm (in kilograms).
    pub phalange_masses: [f64; 3],
    /// Radii of the capsules of the phalanges, starting at the palm (in meters). Each axis extends to the next
    /// joint or to the tip.
    pub phalange_radii: [f64; 3],
    /// Lengths of the phalanges, starting at the palm, for all fingers from the thumb to the little finger (in
    /// meters).
    pub phalange_lengths: [[f64; 3]; 5],
    /// Positions of the index, middle, ring and little finger in the frame of the palm (in meters).
    pub finger_bases: [[f64; 3]; 4],
    /// Ranges of the abduction joints J12, J16, J20 and J24 (in radians).
    pub abduction_ranges: [[f64; 2]; 4],
    /// Position of the thumb in the frame of the palm (in meters).
    pub thumb_base: [f64; 3],
    /// Distance from the base of the thumb to its first flexion joint (in meters).
    pub thumb_link: f64,
    /// Range of the opposition J8 of the thumb (in radians).
    pub opposition_range: [f64; 2],
    /// Range of the fifteen flexion joints (in radians).
    pub flexion_range: [f64; 2],
    /// Properties of contacts between the phalanges and with the palm.
    pub surface: Surface,
}

impl Default for Hand {
    fn default() -> Self {
        let range = |low: f64, high: f64| [deg(low), deg(high)];
        Self {
            palm_mass: 0.15,
            palm_half: [0.030, 0.031, 0.010],
            palm_box: [0.050, 0.0, 0.0],
            palm_centre: [0.0625, 0.0, -0.010],
            armature: 5e-4,
            damping: 0.002,
            servo: Servo { stiffness: 1.0, damping: 0.04, limit: 0.3 },
            knuckle_mass: 0.005,
            phalange_masses: [0.012, 0.008, 0.006],
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

impl Hand {
    /// Outward normal of the inner side of the palm. In the frame of the palm it is the same for both hands.
    pub const PALM_NORMAL: [f64; 3] = [0.0, 0.0, -1.0];

    /// Computes the total mass of the palm and the fingers (in kilograms).
    pub fn mass(&self) -> f64 {
        self.palm_mass + 5.0 * (self.knuckle_mass + self.phalange_masses.iter().sum::<f64>())
    }

    /// Returns the ranges of J8 to J27 (in radians).
    pub fn ranges(&self) -> [[f64; 2]; 20] {
        core::array::from_fn(|i| match (i / 4, i % 4) {
            (0, 0) => self.opposition_range,
            (finger, 0) => self.abduction_ranges[finger - 1],
            _ => self.flexion_range,
        })
    }

    /// Returns the tip of a finger of the right hand in the frame of its distal phalange (in meters). The tip is the
    /// end of the capsule's axis, one radius below its surface. For the left hand, y has the opposite sign.
    pub fn fingertip(&self, finger: Finger) -> [f64; 3] {
        let tip = self.phalange_lengths[finger as usize][2];
        if finger == Finger::Thumb { [0.0, tip, 0.0] } else { [tip, 0.0, 0.0] }
    }

    /// Returns nine groups of servos, each of which is controlled by one output. The argument `first` is the servo of
    /// J8. At an output of 0, the fingers are extended and close together. At an output of 1, they are flexed and
    /// spread.
    ///
    /// The groups have the following order [Ferrauto2010, chapter 2]:
    ///
    /// 1. J8
    /// 2. J9
    /// 3. J10 and J11
    /// 4. J13
    /// 5. J14 and J15
    /// 6. J17
    /// 7. J18 and J19
    /// 8. J12, J16, J20 and J24 for abduction. The index and middle finger move from the lower to the upper limit, and
    ///    the ring and little finger in the opposite direction
    /// 9. J21 to J23 and J25 to J27
    pub fn servo_groups(&self, first: ActuatorId) -> [Vec<ServoRange>; 9] {
        let servo = |n: u16, from: f64, to: f64| ServoRange {
            servo: ActuatorId(first.0 + n - FIRST),
            from: from as f32,
            to: to as f32,
        };
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

    /// The palm's collider. This is also the solid that has its mass.
    pub(crate) fn palm_collider(&self, wrist: &Wrist<'_>) -> Collider {
        let placement = Pose::at(wrist.point(self.palm_box));
        Collider::new(
            &format!("{}palm", wrist.prefix),
            Some(wrist.palm),
            Shape::Box { half: self.palm_half },
            placement,
        )
    }

    /// Appends the segments and colliders of the five fingers.
    pub(crate) fn add_fingers(&self, robot: &mut Robot, wrist: &Wrist<'_>) {
        for finger in Finger::ALL {
            self.add_finger(robot, wrist, finger);
        }
    }

    fn add_finger(&self, robot: &mut Robot, wrist: &Wrist<'_>, finger: Finger) {
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
        let (link, along) = (wrist.point(link), wrist.point(along));
        let prefix = wrist.prefix;
        let joint = |n: u16, axis, at, range| {
            Joint::revolute(&format!("{prefix}J{n}"), wrist.axis(axis), Pose::at(at), range)
                .with_armature(self.armature)
                .with_damping(self.damping)
        };
        let knuckle = MassProperties::sphere(self.knuckle_mass, self.phalange_radii[0]);
        let knuckle = knuckle.placed(&Pose::at(link.map(|x| x / 2.0)));
        let name = format!("{prefix}{}_knuckle", finger.name());
        let first = joint(number, first_axis, wrist.point(base), range);
        let mut parent = robot.add_segment(Segment::new(&name, Some(wrist.palm), first, knuckle));
        let mut at = link;
        for (i, part) in PHALANGES.iter().enumerate() {
            let name = format!("{prefix}{}_{part}", finger.name());
            let end = along.map(|x| x * self.phalange_lengths[finger as usize][i]);
            let body = BodyId(robot.segments.len() as u16);
            let shape = Collider::capsule_between(&name, Some(body), [0.0; 3], end, self.phalange_radii[i]);
            let mass = shape.mass_properties(self.phalange_masses[i]);
            let flexion = joint(number + 1 + i as u16, flexion_axis, at, self.flexion_range);
            parent = robot.add_segment(Segment::new(&name, Some(parent), flexion, mass));
            robot.add_collider(shape);
            at = end;
        }
    }

    /// Appends the servos on the hand's joints, `first` being J8.
    pub(crate) fn add_servos(&self, robot: &mut Robot, prefix: &str, first: JointId) {
        for i in 0..20 {
            robot.add_actuator(&format!("{prefix}J{}", FIRST + i), JointId(first.0 + i), Law::Servo(self.servo));
        }
    }

    /// Returns the pairs of the hand's colliders that may touch, with the palm's index and that of the first phalange.
    /// They are the thumb's two outer phalanges with the other fingers' two outer ones, neighboring fingers' distal
    /// ones, and the palm with the thumb's two outer phalanges and the others' distal ones.
    pub(crate) fn pairs(palm: usize, first: usize) -> Vec<[usize; 2]> {
        let phalanges = |finger: Finger| [0, 1, 2].map(|i| first + 3 * finger as usize + i);
        let mut pairs = Vec::new();
        let [_, thumb_middle, thumb_distal] = phalanges(Finger::Thumb);
        for thumb in [thumb_middle, thumb_distal] {
            for finger in &Finger::ALL[1..] {
                let [_, middle, distal] = phalanges(*finger);
                pairs.extend([[thumb, middle], [thumb, distal]]);
            }
        }
        for fingers in Finger::ALL[1..].windows(2) {
            pairs.push([fingers[0], fingers[1]].map(|finger| phalanges(finger)[2]));
        }
        // A closed hand without something in it would reach through its own palm.
        let others = Finger::ALL[1..].iter().map(|finger| phalanges(*finger)[2]);
        pairs.extend([thumb_middle, thumb_distal].into_iter().chain(others).map(|phalanx| [phalanx, palm]));
        pairs
    }
}
