//! The joint angles of all chains of the iCub.

use crate::robots::hand::deg;
use crate::robots::icub::chain::Chain;

/// The joint angles of all chains in radians. Each chain is ordered like [`Chain::joint_names`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct IcubPosture {
    /// Pitch, roll and yaw of the trunk (in radians).
    pub torso: [f64; 3],
    /// Pitch, roll and yaw of the head (in radians).
    pub neck: [f64; 3],
    /// Angles of the left arm.
    pub left_arm: [f64; 7],
    /// Angles of the right arm.
    pub right_arm: [f64; 7],
    /// Angles of J8 to J27 of the left hand.
    pub left_hand: [f64; 20],
    /// Angles of J8 to J27 of the right hand.
    pub right_hand: [f64; 20],
}

impl IcubPosture {
    /// Returns the joint angles of a chain in radians.
    pub fn chain(&self, chain: Chain) -> &[f64] {
        match chain {
            Chain::Torso => &self.torso,
            Chain::Neck => &self.neck,
            Chain::LeftArm => &self.left_arm,
            Chain::RightArm => &self.right_arm,
            Chain::LeftHand => &self.left_hand,
            Chain::RightHand => &self.right_hand,
        }
    }

    /// Returns a mutable reference to the joint angles of a chain (in radians).
    pub fn chain_mut(&mut self, chain: Chain) -> &mut [f64] {
        match chain {
            Chain::Torso => &mut self.torso,
            Chain::Neck => &mut self.neck,
            Chain::LeftArm => &mut self.left_arm,
            Chain::RightArm => &mut self.right_arm,
            Chain::LeftHand => &mut self.left_hand,
            Chain::RightHand => &mut self.right_hand,
        }
    }
}

impl Default for IcubPosture {
    /// Returns an upright posture with both forearms in front of the trunk and open hands. The angles were chosen.
    fn default() -> Self {
        let arm = [deg(-30.0), deg(30.0), 0.0, deg(60.0), 0.0, 0.0, 0.0];
        Self {
            torso: [0.0; 3],
            neck: [0.0; 3],
            left_arm: arm,
            right_arm: arm,
            left_hand: [0.0; 20],
            right_hand: [0.0; 20],
        }
    }
}
