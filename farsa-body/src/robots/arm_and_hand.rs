//! The arm and hand of the experiment `reach-grasp-lift`. The arm has seven joints with muscles, and the hand has
//! twenty joints.

use alloc::format;
use alloc::vec::Vec;

use crate::actuators::law::{Law, Servo};
use crate::actuators::muscle::{MusclePair, MuscleVariant};
use crate::motors::joints::ServoRange;
use crate::ports::{ActuatorId, BodyId, JointId};
use crate::pose::Pose;
use crate::robot::description::{Collider, Robot, Segment, Surface};
use crate::robot::joint::Joint;
use crate::robot::mass_properties::MassProperties;
use crate::robot::validation::RobotError;
use crate::robots::hand::{Finger, Hand, Wrist, deg};

const JOINT_LABELS: [&str; 27] = [
    "shoulder adduction",
    "shoulder flexion",
    "internal rotation",
    "elbow extension",
    "forearm supination",
    "wrist flexion",
    "wrist abduction",
    "thumb opposition",
    "thumb proximal",
    "thumb middle",
    "thumb distal",
    "index abduction",
    "index proximal",
    "index middle",
    "index distal",
    "middle abduction",
    "middle proximal",
    "middle middle",
    "middle distal",
    "ring abduction",
    "ring proximal",
    "ring middle",
    "ring distal",
    "little abduction",
    "little proximal",
    "little middle",
    "little distal",
];

const MUSCLE_LABELS: [[&str; 2]; 7] = [
    ["shoulder abductor", "shoulder adductor"],
    ["shoulder extensor", "shoulder flexor"],
    ["external rotator", "internal rotator"],
    ["elbow flexor", "elbow extensor"],
    ["forearm pronator", "forearm supinator"],
    ["wrist extensor", "wrist flexor"],
    ["wrist adductor", "wrist abductor"],
];

/// The right arm and hand of [Ferrauto2010] with the dimensions of the iCub. All values can be changed.
///
/// At joint position 0, the arm points horizontally forward along +X of the world. The palm points down and the thumb
/// to the left (+Y). In this posture all frames are parallel to that of the world. The frame of the palm is located in
/// the wrist, with x towards the fingertips, y towards the thumb, and z out of the *back* of the hand. The arm is
/// attached to the world and not to a torso.
///
/// Joints, segments and actuators are numbered consistently. The joint Jn carries segment n - 1 and is driven by
/// actuator n - 1.
///
/// Deviations: the source does not specify the positions of the axes. The geometry, the masses, joint damping, armature
/// and the limits of the arm except for the elbow were chosen by experiments in another simulator.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct ArmAndHand {
    /// Position in the world at which the axes of J1 to J3 intersect (in meters).
    pub shoulder: [f64; 3],
    /// Distance from the shoulder to the elbow in meters.
    pub upper_arm_length: f64,
    /// Distance from the elbow to the wrist (in meters).
    pub forearm_length: f64,
    /// Ranges of J1 to J7 (in radians).
    pub arm_ranges: [[f64; 2]; 7],
    /// Largest active tension Tmax of the muscles of J1 to J7 (in newtons).
    pub tensions: [f64; 7],
    /// Moment arm of all muscles in meters.
    pub moment_arm: f64,
    /// Variant of the muscle model.
    pub muscle_variant: MuscleVariant,
    /// Factor that reduces the passive tension of [`MuscleVariant::Original`] in addition to 0.5. The other variant
    /// ignores it.
    pub passive_reduction: f64,
    /// Viscous damping of the arm joints, relative to the largest active torque r Tmax of the muscles (in s/rad).
    pub damping_per_torque: f64,
    /// Armature of the arm joints (in kg m2).
    pub arm_armature: f64,
    /// Armature of the hand joints (in kg m2).
    pub finger_armature: f64,
    /// Servo of each joint of the hand.
    pub servo: Servo<f64>,
    /// Passive viscous damping of the hand joints (in N m s/rad).
    pub finger_damping: f64,
    /// Masses of the segments of J1 to J7 (in kilograms). These are two shoulder segments, the upper arm, the
    /// elbow, the forearm, the wrist and the palm.
    pub arm_masses: [f64; 7],
    /// Mass of the first segment of each finger (in kilograms).
    pub knuckle_mass: f64,
    /// Masses of the phalanges, starting at the palm (in kilograms).
    pub phalange_masses: [f64; 3],
    /// Radius of the upper arm's capsule (in meters). The capsule is as long as the upper arm.
    pub upper_arm_radius: f64,
    /// Radius of the forearm's capsule in meters.
    pub forearm_radius: f64,
    /// Length of the axis of the forearm's capsule (in meters). The axis starts at the elbow.
    pub forearm_axis: f64,
    /// Half the edge lengths of the palm (in meters).
    pub palm_half: [f64; 3],
    /// Center of the palm's box in the frame of the palm (in meters).
    pub palm_box: [f64; 3],
    /// Point on the inner side of the palm used as its center, in the frame of the palm (in meters).
    pub palm_centre: [f64; 3],
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
    /// Properties of contacts between phalanges.
    pub surface: Surface,
}

impl Default for ArmAndHand {
    fn default() -> Self {
        let range = |low: f64, high: f64| [deg(low), deg(high)];
        let hand = Hand::default();
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
            finger_armature: hand.armature,
            servo: hand.servo,
            finger_damping: hand.damping,
            arm_masses: [0.19, 0.18, 0.884, 0.074, 0.525, 0.036, hand.palm_mass],
            knuckle_mass: hand.knuckle_mass,
            phalange_masses: hand.phalange_masses,
            upper_arm_radius: 0.025,
            forearm_radius: 0.020,
            forearm_axis: 0.130,
            palm_half: hand.palm_half,
            palm_box: hand.palm_box,
            palm_centre: hand.palm_centre,
            phalange_radii: hand.phalange_radii,
            phalange_lengths: hand.phalange_lengths,
            finger_bases: hand.finger_bases,
            abduction_ranges: hand.abduction_ranges,
            thumb_base: hand.thumb_base,
            thumb_link: hand.thumb_link,
            opposition_range: hand.opposition_range,
            flexion_range: hand.flexion_range,
            surface: hand.surface,
        }
    }
}

impl ArmAndHand {
    /// Body of the palm.
    pub const PALM: BodyId = BodyId(6);
    /// Outward normal of the inner side of the palm, in the frame of the palm.
    pub const PALM_NORMAL: [f64; 3] = [0.0, 0.0, -1.0];
    /// Indices of the colliders of the upper arm, the forearm and the palm. The phalanges follow.
    pub const ARM_COLLIDERS: [usize; 3] = [0, 1, 2];

    /// Returns the joints J1 to J27.
    pub fn joints() -> [JointId; 27] {
        core::array::from_fn(|i| JointId(i as u16))
    }

    /// Returns unique anatomical names for the joints J1 to J27.
    ///
    /// For the arm, the names describe a positive rotation from joint position 0. J1 adducts the arm in the horizontal
    /// plane, J2 flexes the shoulder (up), J3 rotates the humerus inwards, and J4 extends the elbow. J5 supinates the
    /// forearm, J6 flexes the wrist towards the palm, and J7 abducts it towards the thumb.
    ///
    /// For the hand, the names describe the motion or the phalange that flexes. Opposition and flexion are negative.
    /// Abduction joints turn towards the thumb for positive angles, so the index and the middle finger abduct while the
    /// ring and the little finger adduct.
    pub const fn joint_labels() -> [&'static str; 27] {
        JOINT_LABELS
    }

    /// Returns the anatomical names of the agonist and the antagonist of each joint from J1 to J7. The agonist turns
    /// its joint in the negative direction. The antagonist turns it in the positive direction. For the directions, see
    /// [`ArmAndHand::joint_labels`].
    pub const fn muscle_labels() -> [[&'static str; 2]; 7] {
        MUSCLE_LABELS
    }

    /// Returns the fifteen flexion joints from the thumb to the little finger. For each finger, the joint at the palm
    /// comes first.
    pub fn flexion_joints() -> [JointId; 15] {
        core::array::from_fn(|i| JointId(8 + i as u16 / 3 * 4 + i as u16 % 3))
    }

    /// Returns the three phalanges of a finger, starting at the palm.
    pub fn phalanges(finger: Finger) -> [BodyId; 3] {
        [0, 1, 2].map(|i| BodyId(finger.first_joint() + i))
    }

    /// Returns the indices of the colliders of a finger, starting at the palm.
    pub fn phalange_colliders(finger: Finger) -> [usize; 3] {
        [0, 1, 2].map(|i| 3 + 3 * finger as usize + i)
    }

    /// Returns the hand without the arm.
    pub fn hand(&self) -> Hand {
        Hand {
            palm_mass: self.arm_masses[6],
            palm_half: self.palm_half,
            palm_box: self.palm_box,
            palm_centre: self.palm_centre,
            armature: self.finger_armature,
            damping: self.finger_damping,
            servo: self.servo,
            knuckle_mass: self.knuckle_mass,
            phalange_masses: self.phalange_masses,
            phalange_radii: self.phalange_radii,
            phalange_lengths: self.phalange_lengths,
            finger_bases: self.finger_bases,
            abduction_ranges: self.abduction_ranges,
            thumb_base: self.thumb_base,
            thumb_link: self.thumb_link,
            opposition_range: self.opposition_range,
            flexion_range: self.flexion_range,
            surface: self.surface,
        }
    }

    /// Returns the distal phalange of a finger and the position of its tip in this frame (in meters). The tip is the
    /// end of the capsule's axis, one radius below its surface.
    pub fn fingertip(&self, finger: Finger) -> (BodyId, [f64; 3]) {
        (Self::phalanges(finger)[2], self.hand().fingertip(finger))
    }

    /// Returns nine groups of servos, each of which is controlled by one output. See [`Hand::servo_groups`] for a list.
    pub fn servo_groups(&self) -> [Vec<ServoRange>; 9] {
        self.hand().servo_groups(ActuatorId(Finger::Thumb.first_joint() - 1))
    }

    /// Builds the description of the robot.
    ///
    /// Its segments are `shoulder_base`, `shoulder`, `upper_arm`, `elbow`, `forearm`, `wrist` and `palm`, followed by
    /// segments such as `thumb_knuckle`, `thumb_proximal`, `thumb_middle` and `thumb_distal` for each finger. Colliders
    /// have the same names as their segments.
    ///
    /// The inertias of the upper arm, the forearm, the palm and the phalanges are those of solid colliders. All other
    /// segments have the inertia of a sphere that is as thick as their neighbors. By default, three kinds of contacts
    /// are possible. The two outer phalanges of the thumb can touch those of the other fingers. The distal phalanges of
    /// neighboring fingers can touch each other. The palm can touch the outer phalanges of the thumb and the distal
    /// ones of the other fingers. Use [`crate::robots::Tabletop`] or [`Robot::add_pair`] to add other pairs.
    ///
    /// # Errors
    /// Returns the errors of [`Robot::validate`].
    pub fn robot(&self) -> Result<Robot, RobotError> {
        let mut robot = Robot::new("arm_and_hand");
        let (hand, wrist) = (self.hand(), Wrist { palm: Self::PALM, prefix: "", mirrored: false });
        self.add_arm(&mut robot, &hand.palm_collider(&wrist));
        hand.add_fingers(&mut robot, &wrist);
        self.add_muscles(&mut robot);
        hand.add_servos(&mut robot, wrist.prefix, JointId(Finger::Thumb.first_joint() - 1));
        let [thumb, ..] = Self::phalange_colliders(Finger::Thumb);
        for pair in Hand::pairs(Self::ARM_COLLIDERS[2], thumb) {
            robot.add_pair(pair, self.surface);
        }
        robot.validate()?;
        Ok(robot)
    }

    fn add_arm(&self, robot: &mut Robot, palm_shape: &Collider) {
        let [shoulder_base, shoulder, upper_arm, elbow, forearm, wrist, palm] = self.arm_masses;
        let (thick, thin) = (self.upper_arm_radius, self.forearm_radius);
        let capsule = |name, body, length, radius| {
            Collider::capsule_between(name, Some(BodyId(body)), [0.0; 3], [length, 0.0, 0.0], radius)
        };
        let upper_arm_shape = capsule("upper_arm", 2, self.upper_arm_length, thick);
        let forearm_shape = capsule("forearm", 4, self.forearm_axis, thin);
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
        robot.colliders.extend([upper_arm_shape, forearm_shape, palm_shape.clone()]);
    }

    fn add_muscles(&self, robot: &mut Robot) {
        for (i, (tension, range)) in self.tensions.into_iter().zip(self.arm_ranges).enumerate() {
            let muscles = match self.muscle_variant {
                MuscleVariant::Thesis => MusclePair::thesis(tension, self.moment_arm, range),
                MuscleVariant::Original => {
                    MusclePair::original(tension, self.moment_arm, range, self.passive_reduction)
                }
            };
            robot.add_actuator(&format!("J{}", i + 1), JointId(i as u16), Law::MusclePair(muscles));
        }
    }
}
