//! Predefined robots. All values are public fields, except for those of the iCub's links.
//!
//! | robot | what it is | its world |
//! |---|---|---|
//! | [`ArmAndHand`] | an arm of seven joints driven by muscle pairs, and a hand of twenty joints driven by servos | articulated |
//! | [`Icub`] | the upper body of the iCub: torso, neck, two arms, two hands, each of which may be rigid | articulated |
//! | [`Tabletop`] | a table with a sphere, the scene of the arm in `reach-grasp-lift` | articulated |
//! | [`MobileRobot`] | a round robot on two wheels: [`khepera`](MobileRobot::khepera), [`e_puck`](MobileRobot::e_puck), [`marxbot`](MobileRobot::marxbot) | planar |
//!
//! To customize a robot, change its fields before you build it, for example `ArmAndHand { moment_arm: 0.02,
//! ..ArmAndHand::default() }`.

/// The arm and hand of `reach-grasp-lift`.
pub(crate) mod arm_and_hand;
/// The hand of twenty joints, right or left.
pub(crate) mod hand;
/// The upper body of the iCub.
pub(crate) mod icub;
/// The mirror image of a right side.
pub(crate) mod mirror;
/// Wheeled robots, and the numbers of their parts in a planar world.
pub(crate) mod mobile;
/// The table and the sphere of `reach-grasp-lift`.
pub(crate) mod tabletop;
/// Wheeled robots as bodies with joints.
mod vehicle;

pub use arm_and_hand::ArmAndHand;
pub use hand::{Finger, Hand};
pub use icub::{Chain, Icub, IcubError, IcubPosture, IcubTabletop, JointControl, Side};
pub use mobile::{InfraredRing, MobileParts, MobileRobot};
pub use tabletop::Tabletop;
