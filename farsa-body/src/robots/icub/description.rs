//! The parameters of the iCub, from which its description is built.

use alloc::format;
use alloc::vec::Vec;

use crate::actuators::law::{Law, Servo, Velocity};
use crate::motors::joints::ServoRange;
use crate::ports::{ActuatorId, BodyId, JointId};
use crate::pose::Pose;
use crate::robot::description::{Robot, Segment, Surface};
use crate::robot::joint::Joint;
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

/// Defines how the commands of the torso, the neck and the arms are interpreted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum JointControl {
    /// Commands are joint speeds [rad/s]. Motors follow them with [`Law::Velocity`].
    Velocity,
    /// Commands are joint positions [rad]. Servos follow them with [`Law::Servo`]. This is the default.
    #[default]
    Position,
}

/// The upper body of the iCub [Metta2010]. It consists of a torso, a neck, two arms and two hands on a fixed root, with
/// 60 joints in six chains.
///
/// X points forward, Y to the left and Z up. The origin is the root link. This is the root frame of the file
/// [Gepetto2025], rotated by pi about z. At joint position 0, which is outside the limits of the elbows, the robot is
/// upright and the arms hang down. All frames are then parallel to that of the world, except for those of the hands,
/// which are described at [`Hand`].
///
/// Joints have the names, signs and limits of the file. The joints of the hands are named `l_J8` to `l_J27` and `r_J8`
/// to `r_J27`. Segments and joints have the same numbers, in the order of [`Chain::ALL`]. These numbers do not depend
/// on the actuated chains. Actuators are numbered in the same order, but rigid chains are skipped. The left side is the
/// mirror image of the right side, so equal joint angles result in a symmetric posture.
///
/// Deviations from the file:
///
/// Since the file has no fingers, the hands are those of [`crate::robots::ArmAndHand`]. They are as light as the hands
/// of the file, which have 0.213 kg, but their center of mass differs by 7 mm.
///
/// In the file, the left side is not exactly the mirror image of the right side. Here the right side is used for
/// both. On the left side of the file, the inertia of the first shoulder segment is half as large, and the center of
/// mass of the second one differs by 0.18 mm.
///
/// The neck, the head and the wrist, for which the file has no inertia, have the inertia of spheres whose radius was
/// chosen. In the file, every joint has a damping of 1 N m s/rad. This is too large for the motors of the wrist. It
/// is replaced by a damping that is proportional to the effort. The armature, the gains and the surfaces were chosen.
/// There are no legs.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Icub {
    /// Position of the root link in the world (in meters).
    pub root: [f64; 3],
    /// Actuated chains, in any order. The joints of all other chains are fixed.
    pub actuated: Vec<Chain>,
    /// Joint angles of all chains. Rigid chains are fixed at these angles, and all other chains start at them.
    pub posture: IcubPosture,
    /// Interpretation of commands for the torso, the neck and the arms. The hands always use position servos.
    pub control: JointControl,
    /// Position error at which a servo reaches the maximum effort of its joint (in radians). The default is 0.1.
    pub saturation_angle: f64,
    /// Ratio of the damping and the stiffness of a servo (in seconds). The default is 0.05.
    pub servo_time: f64,
    /// Speed error at which a velocity motor reaches the maximum effort of its joint (in radians per second).
    pub saturation_speed: f64,
    /// Viscous damping of the joints of the torso, the neck and the arms, relative to their effort (in s/rad). Its
    /// inverse is the highest speed.
    pub damping_per_effort: f64,
    /// Armature of these joints (in kg m2).
    pub armature: f64,
    /// Parameters of both hands.
    pub hand: Hand,
    /// Properties of contacts of the arms and palms with the trunk, the head and the other arm.
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
    /// Body of the trunk, including the bases of the shoulders.
    pub const CHEST: BodyId = BodyId(2);
    /// Body of the head.
    pub const HEAD: BodyId = BodyId(5);
    /// Centers of the left and the right eye in the frame of the head (in meters). Their distance is 68 mm, and
    /// they cannot move.
    ///
    /// The transformation from the neck yaw to the eyes is taken from [Pattacini2011]. This source describes another
    /// version of the neck than the file.
    pub const EYES: [[f64; 3]; 2] = [[0.054, 0.034, 0.0825], [0.054, -0.034, 0.0825]];
    /// Outward normal of the inner side of the palm, in the frame of the palm.
    pub const PALM_NORMAL: [f64; 3] = Hand::PALM_NORMAL;

    /// Returns the palm on the given side. It is the last segment of the arm.
    pub fn palm(side: Side) -> BodyId {
        BodyId(side.arm().bodies().end as u16 - 1)
    }

    /// Returns the point on the inner side of a palm used as its center, in the frame of the palm (in meters).
    pub fn palm_centre(&self, side: Side) -> [f64; 3] {
        on_side(side, self.hand.palm_centre)
    }

    /// Returns the three phalanges of a finger, starting at the palm.
    pub fn phalanges(side: Side, finger: Finger) -> [BodyId; 3] {
        [1, 2, 3].map(|i| BodyId((side.hand().bodies().start + 4 * finger as usize + i) as u16))
    }

    /// Returns the distal phalange of a finger and the position of its tip in this frame (in meters). The tip is the
    /// end of the capsule's axis.
    pub fn fingertip(&self, side: Side, finger: Finger) -> (BodyId, [f64; 3]) {
        (Self::phalanges(side, finger)[2], on_side(side, self.hand.fingertip(finger)))
    }

    /// Returns the joint with the given name. Its chain must be actuated.
    ///
    /// # Errors
    /// Returns [`IcubError::Joint`] if there is no such joint, or [`IcubError::Locked`] if the joint is rigid.
    pub fn joint(&self, name: &str) -> Result<JointId, IcubError> {
        let (chain, i) = find(name)?;
        self.unlocked(chain, name)?;
        Ok(JointId((chain.bodies().start + i) as u16))
    }

    /// Returns the actuator of the joint with the given name. Actuators and joints have the same names.
    ///
    /// # Errors
    /// Returns the same errors as [`Icub::joint`].
    pub fn actuator(&self, name: &str) -> Result<ActuatorId, IcubError> {
        let (chain, i) = find(name)?;
        let first = self.unlocked(chain, name)?;
        Ok(ActuatorId(first + i as u16))
    }

    /// Returns the limits of the joint with the given name (in radians). Rigid joints are supported as well.
    ///
    /// # Errors
    /// Returns [`IcubError::Joint`] if there is no such joint.
    pub fn range(&self, name: &str) -> Result<[f64; 2], IcubError> {
        let (chain, i) = find(name)?;
        Ok(self.ranges(chain)[i])
    }

    /// Returns the limits of the joints of a chain (in radians).
    pub fn ranges(&self, chain: Chain) -> Vec<[f64; 2]> {
        match chain.parts() {
            [] => self.hand.ranges().to_vec(),
            parts => parts.iter().map(|part| part.range).collect(),
        }
    }

    /// Returns the initial angles of the actuated joints in the order of [`Robot::joints`] (in radians).
    pub fn start(&self) -> Vec<f64> {
        let actuated = Chain::ALL.into_iter().filter(|chain| self.actuated.contains(chain));
        actuated.flat_map(|chain| self.posture.chain(chain)).copied().collect()
    }

    /// Returns nine groups of servos of a hand, each of which is controlled by one output. See [`Hand::servo_groups`]
    /// for a list.
    ///
    /// # Errors
    /// Returns [`IcubError::Locked`] if the hand is rigid.
    pub fn servo_groups(&self, side: Side) -> Result<[Vec<ServoRange>; 9], IcubError> {
        let first = self.actuator(&format!("{}J{}", side.prefix(), Finger::Thumb.first_joint()))?;
        Ok(self.hand.servo_groups(first))
    }

    /// Builds the description of the robot.
    ///
    /// The first segments are `torso_1`, `torso_2`, `chest`, `neck_1`, `neck_2` and `head`. They are followed by
    /// `l_shoulder_1`, `l_shoulder_2`, `l_upper_arm`, `l_elbow_1`, `l_forearm`, `l_wrist_1` and `l_palm`, and by the
    /// same segments with the prefix `r_`. The last segments are those of the fingers, as in
    /// [`crate::robots::ArmAndHand`], first with `l_` and then with `r_`.
    ///
    /// Colliders have the sizes of the collision meshes of the file. The waist (the hip belt of `torso_1`), the chest,
    /// the head, the upper arms, the forearms and the phalanges are capsules, and the palms are boxes. In the file, the
    /// meshes of the forearms and hands are displaced by 20 mm from their links, and those of the hands are rotated by
    /// 90 degrees. Here the capsules of the forearms are on their axes, and the palms are those of [`Hand`]. Views draw
    /// covers and a face with two eyes at [`Icub::EYES`] instead of the colliders.
    ///
    /// The forearms and palms can touch the waist, the chest and the head. The upper arms can touch the head. All parts
    /// of one arm can touch those of the other arm, except that the upper arms cannot reach each other. The pairs
    /// within a hand are those of [`crate::robots::ArmAndHand`]. The fingers can touch the trunk and the other arm,
    /// including its hand. The upper arms cannot touch the chest, since it contains the shoulders. Neighbors along an
    /// arm have no contacts, and a hand cannot reach its forearm or upper arm. Pairs whose colliders cannot move
    /// relative to each other are omitted.
    ///
    /// # Errors
    /// Returns [`IcubError::Twice`], [`IcubError::Posture`] or [`IcubError::Value`] if a field is invalid, or
    /// [`IcubError::Robot`] if [`Robot::validate`] fails.
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
