//! The robot with its fields, and how it is put together.

use alloc::format;
use alloc::vec::Vec;

use crate::actuators::law::{Law, Servo, Velocity};
use crate::motors::joints::ServoRange;
use crate::ports::{ActuatorId, BodyId, JointId};
use crate::pose::Pose;
use crate::robot::description::{Joint, Robot, Segment, Surface};
use crate::robots::hand::{Finger, Hand, Wrist};
use crate::robots::icub::chain::{Chain, Side};
use crate::robots::icub::colliders;
use crate::robots::icub::error::IcubError;
use crate::robots::icub::look;
use crate::robots::icub::posture::IcubPosture;
use crate::robots::icub::table::Part;
use crate::robots::mirror;

/// The right palm's axes in the world at joint positions 0, where the arm hangs down with the palm to the body. The
/// axis x points down, y forward and z to the right.
const RIGHT_PALM: [f64; 4] = [0.5, 0.5, -0.5, 0.5];

/// The meaning of the commands of torso, neck and arms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum JointControl {
    /// Joint speeds [rad/s], by [`Law::Velocity`].
    Velocity,
    /// Joint positions [rad], by [`Law::Servo`].
    #[default]
    Position,
}

/// The upper body of the iCub [Metta2010]: torso, neck, two arms and two hands on a fixed root, 60 joints in six
/// chains.
///
/// X is forward, Y left and Z up, the file's root frame [Gepetto2025] turned by pi about z, and the origin is its root
/// link. At joint positions 0 (out of the elbows' limits) the robot is upright and its arms hang. All segments' axes
/// are then those of the world but those of the palms and what they carry, whose frames [`Hand`] describes. Joints have
/// the names, signs and limits of the file. The hands have `l_J8` to `l_J27` and `r_J8` to `r_J27`. Segments and joints
/// are numbered alike, in the order of [`Chain::ALL`], whichever chains are actuated. Actuators are numbered in the
/// same order without the rigid chains'.
///
/// The left side is the mirror image of the right one: at equal joint angles the robot is symmetric.
///
/// Deviations from the file:
///
/// The file has no fingers, so the hands are those of [`crate::robots::ArmAndHand`], as light as the file's hand of
/// 0.213 kg. They miss its center of mass by 7 mm.
///
/// The file's left side is not quite the image of its right one, which is used for both. The first shoulder segment's
/// inertia is half of the right one's, the second one's center of mass 0.18 mm off.
///
/// Balls of our choice have the inertia of neck, head and wrist, for which the file has none. The file's damping of 1 N
/// m s/rad in every joint, more than the wrist's motors could overcome, is replaced by one in proportion to the effort.
/// Armature, gains and surfaces are our choice. There are no legs.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Icub {
    /// Where the root link is in the world [m].
    pub root: [f64; 3],
    /// The chains that are actuated, in any order. The joints of the others are fixed.
    pub actuated: Vec<Chain>,
    /// The joint angles at which rigid chains are fixed, and a start for the others.
    pub posture: IcubPosture,
    /// The meaning of the commands of torso, neck and arms. Hands have position servos.
    pub control: JointControl,
    /// The error at which a position servo exerts its joint's effort [rad].
    pub saturation_angle: f64,
    /// Damping of a position servo divided by its stiffness [s].
    pub servo_time: f64,
    /// The lack of speed at which a velocity motor exerts its joint's effort [rad/s].
    pub saturation_speed: f64,
    /// Viscous damping of the joints of torso, neck and arms divided by their efforts [s/rad]: one over their highest
    /// speed.
    pub damping_per_effort: f64,
    /// Armature of these joints [kg m2].
    pub armature: f64,
    /// Both hands.
    pub hand: Hand,
    /// Contact of arms and palms with the trunk, the head and the other arm.
    pub skin: Surface,
}

impl Default for Icub {
    /// All chains are actuated, by position.
    fn default() -> Self {
        Self {
            root: [0.0; 3],
            actuated: Chain::ALL.to_vec(),
            posture: IcubPosture::default(),
            control: JointControl::default(),
            saturation_angle: 0.1,
            servo_time: 0.05,
            saturation_speed: 0.02,
            damping_per_effort: 1.0 / 8.0,
            armature: 0.01,
            hand: Hand {
                palm_mass: 0.105,
                knuckle_mass: 0.0035,
                phalange_masses: [0.0083, 0.0056, 0.0042],
                ..Hand::default()
            },
            skin: Surface { friction: 0.5, rolling_friction: 0.0, stiffness: 1e6, damping: 500.0 },
        }
    }
}

impl Icub {
    /// The trunk with the shoulders' bases.
    pub const CHEST: BodyId = BodyId(2);
    /// The head.
    pub const HEAD: BodyId = BodyId(5);
    /// The left and the right eye's center in the head's frame [m], 68 mm apart. They do not turn.
    ///
    /// From neck yaw to eyes as in [Pattacini2011], whose neck is of another version than the file's.
    pub const EYES: [[f64; 3]; 2] = [[0.054, 0.034, 0.0825], [0.054, -0.034, 0.0825]];
    /// The outward normal of a palm's inner face, in the palm's frame.
    pub const PALM_NORMAL: [f64; 3] = Hand::PALM_NORMAL;

    /// The palm of a side, the last segment of its arm.
    pub fn palm(side: Side) -> BodyId {
        BodyId(side.arm().bodies().end as u16 - 1)
    }

    /// The point on a palm's inner face that counts as its center, in the palm's frame [m].
    pub fn palm_centre(&self, side: Side) -> [f64; 3] {
        on_side(side, self.hand.palm_centre)
    }

    /// The three phalanges of a finger, from the palm outwards.
    pub fn phalanges(side: Side, finger: Finger) -> [BodyId; 3] {
        [1, 2, 3].map(|i| BodyId((side.hand().bodies().start + 4 * finger as usize + i) as u16))
    }

    /// The distal phalange of a finger and its tip in that frame [m]: the end of the capsule's axis.
    pub fn fingertip(&self, side: Side, finger: Finger) -> (BodyId, [f64; 3]) {
        (Self::phalanges(side, finger)[2], on_side(side, self.hand.fingertip(finger)))
    }

    /// The joint with this name, whose chain is actuated.
    ///
    /// # Errors
    /// [`IcubError::Joint`] if there is no such joint, [`IcubError::Locked`] if it is rigid.
    pub fn joint(&self, name: &str) -> Result<JointId, IcubError> {
        let (chain, i) = find(name)?;
        self.unlocked(chain, name)?;
        Ok(JointId((chain.bodies().start + i) as u16))
    }

    /// The actuator on the joint with this name, which is also its own.
    ///
    /// # Errors
    /// As [`Icub::joint`].
    pub fn actuator(&self, name: &str) -> Result<ActuatorId, IcubError> {
        let (chain, i) = find(name)?;
        let first = self.unlocked(chain, name)?;
        Ok(ActuatorId(first + i as u16))
    }

    /// The limits of the joint with this name, rigid or not [rad].
    ///
    /// # Errors
    /// [`IcubError::Joint`] if there is no such joint.
    pub fn range(&self, name: &str) -> Result<[f64; 2], IcubError> {
        let (chain, i) = find(name)?;
        Ok(self.ranges(chain)[i])
    }

    /// The limits of a chain's joints [rad].
    pub fn ranges(&self, chain: Chain) -> Vec<[f64; 2]> {
        match chain.parts() {
            [] => self.hand.ranges().to_vec(),
            parts => parts.iter().map(|part| part.range).collect(),
        }
    }

    /// The posture's angles of the joints that are actuated, in the order of [`Robot::joints`] [rad].
    pub fn start(&self) -> Vec<f64> {
        let actuated = Chain::ALL.into_iter().filter(|chain| self.actuated.contains(chain));
        actuated.flat_map(|chain| self.posture.chain(chain)).copied().collect()
    }

    /// The nine groups of servos of a hand that each follow one output, as [`Hand::servo_groups`] describes them.
    ///
    /// # Errors
    /// [`IcubError::Locked`] if the hand is rigid.
    pub fn servo_groups(&self, side: Side) -> Result<[Vec<ServoRange>; 9], IcubError> {
        let first = self.actuator(&format!("{}J{}", side.prefix(), Finger::Thumb.first_joint()))?;
        Ok(self.hand.servo_groups(first))
    }

    /// The robot: segments `torso_1`, `torso_2`, `chest`, `neck_1`, `neck_2`, `head`. `l_shoulder_1`, `l_shoulder_2`,
    /// `l_upper_arm`, `l_elbow_1`, `l_forearm`, `l_wrist_1`, `l_palm` and the same with `r_`. Then the fingers as those
    /// of [`crate::robots::ArmAndHand`] with `l_`, with `r_`.
    ///
    /// Colliders have the sizes of the file's collision meshes. Capsules are `waist` (of `torso_1`, the hip belt),
    /// `chest`, `head`, upper arms, forearms and phalanges, and the palms are boxes. The meshes of forearms and hands
    /// are 20 mm away from their links, and those of the hands are turned by 90 degrees. Here the forearms' capsules
    /// are on their axes, and the palms are those of [`Hand`].
    ///
    /// Views draw visuals instead, sized by eye: covers, and a face with two eyes at [`Icub::EYES`].
    ///
    /// Pairs that may touch: forearms and palms with waist, chest and head. Upper arms with the head. Every part of one
    /// arm with every one of the other but their upper arms, which cannot reach each other. Within each hand, as in
    /// [`crate::robots::ArmAndHand`]. Fingers with the trunk and the other arm, its hand included. Upper arms have no
    /// pair with the chest, into which the shoulders are built, nor neighbors along an arm with each other. No hand
    /// comes near its own forearm or upper arm. Pairs whose colliders cannot move relative to each other, because the
    /// joints between are rigid, are left out.
    ///
    /// # Errors
    /// [`IcubError::Twice`], [`IcubError::Posture`] and [`IcubError::Value`] for fields, [`IcubError::Robot`] for what
    /// [`Robot::validate`] finds.
    pub fn robot(&self) -> Result<Robot, IcubError> {
        self.validate()?;
        let mut robot = Robot::new("icub");
        self.add_chain(&mut robot, Chain::Torso, None);
        self.add_chain(&mut robot, Chain::Neck, Some(Self::CHEST));
        robot.colliders.extend(colliders::trunk());
        for side in Side::ALL {
            self.add_chain(&mut robot, side.arm(), Some(Self::CHEST));
            robot.colliders.extend(colliders::limbs(side));
            robot.add_collider(self.hand.palm_collider(&wrist(side)));
        }
        for side in Side::ALL {
            self.hand.add_fingers(&mut robot, &wrist(side));
        }
        for chain in Chain::ALL {
            if self.actuated.contains(&chain) {
                self.add_actuators(&mut robot, chain);
            } else {
                let segments = robot.segments[chain.bodies()].iter_mut();
                for (segment, angle) in segments.zip(self.posture.chain(chain)) {
                    segment.joint = segment.joint.locked(*angle);
                }
            }
        }
        colliders::add_pairs(&mut robot, &self.hand, self.skin);
        look::dress(&mut robot, Self::EYES);
        robot.validate()?;
        Ok(robot)
    }

    fn validate(&self) -> Result<(), IcubError> {
        for (i, chain) in self.actuated.iter().enumerate() {
            if self.actuated[..i].contains(chain) {
                return Err(IcubError::Twice { chain: chain.name() });
            }
        }
        for chain in Chain::ALL {
            let angles = self.posture.chain(chain).iter().zip(self.ranges(chain));
            for (i, (angle, [low, high])) in angles.enumerate() {
                if !(low <= *angle && *angle <= high) {
                    let joint = chain.joint_names().swap_remove(i);
                    return Err(IcubError::Posture { joint, angle: *angle, range: [low, high] });
                }
            }
        }
        let positive = [("saturation_angle", self.saturation_angle), ("saturation_speed", self.saturation_speed)];
        let others = [
            ("servo_time", self.servo_time),
            ("damping_per_effort", self.damping_per_effort),
            ("armature", self.armature),
        ];
        let wrong = |(_, value): &(&str, f64)| !value.is_finite() || *value < 0.0;
        let fault = positive.into_iter().find(|field| wrong(field) || field.1 == 0.0);
        match fault.or_else(|| others.into_iter().find(wrong)) {
            Some((field, value)) => Err(IcubError::Value { field, value }),
            None => Ok(()),
        }
    }

    /// Number of the first actuator of a chain that is actuated.
    fn unlocked(&self, chain: Chain, joint: &str) -> Result<u16, IcubError> {
        if !self.actuated.contains(&chain) {
            return Err(IcubError::Locked { joint: joint.into(), chain: chain.name() });
        }
        let before = Chain::ALL.into_iter().filter(|other| *other < chain && self.actuated.contains(other));
        Ok(before.map(|other| other.bodies().len() as u16).sum())
    }

    fn add_chain(&self, robot: &mut Robot, chain: Chain, mut parent: Option<BodyId>) {
        let prefix = chain.side().map_or("", Side::prefix);
        let left = chain.side() == Some(Side::Left);
        for (part, body) in chain.parts().iter().zip(chain.bodies()) {
            let palm = chain.side().filter(|side| body == Self::palm(*side).index());
            let rotation = if palm.is_some() { RIGHT_PALM } else { Pose::<f64>::identity().rotation };
            let mut placement = Pose { position: part.at, rotation };
            let mut axis = placement.rotate_back(part.axis);
            let mut mass = part.body();
            if left {
                (placement, axis, mass) = (mirror::pose(placement), mirror::axis(axis), mirror::body(mass));
            }
            if let Some(side) = palm {
                mass = self.hand.palm_collider(&wrist(side)).mass_properties(self.hand.palm_mass);
            }
            if parent.is_none() {
                placement.position = [0, 1, 2].map(|i| placement.position[i] + self.root[i]);
            }
            let joint = Joint::revolute(&format!("{prefix}{}", part.joint), axis, placement, part.range)
                .with_armature(self.armature)
                .with_damping(self.damping_per_effort * part.effort);
            let name = format!("{prefix}{}", part.segment);
            parent = Some(robot.add_segment(Segment::new(&name, parent, joint, mass)));
        }
    }

    fn add_actuators(&self, robot: &mut Robot, chain: Chain) {
        let first = JointId(chain.bodies().start as u16);
        match (chain.parts(), chain.side()) {
            ([], Some(side)) => self.hand.add_servos(robot, side.prefix(), first),
            (parts, _) => {
                for (i, (part, name)) in parts.iter().zip(chain.joint_names()).enumerate() {
                    robot.add_actuator(&name, JointId(first.0 + i as u16), self.law(part));
                }
            }
        }
    }

    fn law(&self, part: &Part) -> Law<f64> {
        let limit = part.effort;
        match self.control {
            JointControl::Velocity => Law::Velocity(Velocity { gain: limit / self.saturation_speed, limit }),
            JointControl::Position => {
                let stiffness = limit / self.saturation_angle;
                Law::Servo(Servo { stiffness, damping: self.servo_time * stiffness, limit })
            }
        }
    }
}

/// A point of the right side, or its image.
fn on_side(side: Side, right: [f64; 3]) -> [f64; 3] {
    if side == Side::Left { mirror::point(right) } else { right }
}

fn wrist(side: Side) -> Wrist<'static> {
    Wrist { palm: Icub::palm(side), prefix: side.prefix(), mirrored: side == Side::Left }
}

/// The chain of a joint, and its place in it.
fn find(name: &str) -> Result<(Chain, usize), IcubError> {
    let place = |chain: Chain| chain.joint_names().iter().position(|other| other == name).map(|i| (chain, i));
    Chain::ALL.into_iter().find_map(place).ok_or_else(|| IcubError::Joint { name: name.into() })
}
