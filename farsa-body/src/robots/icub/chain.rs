//! The six kinematic chains of the iCub, and the joints and bodies that belong to them.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::ops::Range;

use crate::ports::BodyId;
use crate::robots::hand::Finger;
use crate::robots::icub::error::IcubError;
use crate::robots::icub::table::{ARM, NECK, Part, TORSO};

/// A group of joints that are either all actuated or all rigid. Chains are ordered like the bodies of the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Chain {
    /// Pitch, roll and yaw of the trunk (in radians).
    Torso,
    /// Pitch, roll and yaw of the head (in radians).
    Neck,
    /// Seven joints of the left arm, from the shoulder to the wrist.
    LeftArm,
    /// Seven joints of the right arm, from the shoulder to the wrist.
    RightArm,
    /// Twenty joints of the left hand. They are J8 to J27 of [`crate::robots::Hand`].
    LeftHand,
    /// Twenty joints of the right hand.
    RightHand,
}

/// The left or the right side, as seen from the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Side {
    /// Left side, where y > 0.
    Left,
    /// Right side, where y < 0.
    Right,
}

impl Side {
    /// Both sides. The left side comes first.
    pub const ALL: [Self; 2] = [Self::Left, Self::Right];

    /// Returns the prefix used in the names of joints, segments and colliders.
    pub fn prefix(self) -> &'static str {
        ["l_", "r_"][self as usize]
    }

    /// Returns the arm on this side.
    pub fn arm(self) -> Chain {
        [Chain::LeftArm, Chain::RightArm][self as usize]
    }

    /// Returns the hand on this side. The palm is not included, because it is the last segment of the arm.
    pub fn hand(self) -> Chain {
        [Chain::LeftHand, Chain::RightHand][self as usize]
    }
}

impl Chain {
    /// All chains in the order of their bodies.
    pub const ALL: [Self; 6] =
        [Self::Torso, Self::Neck, Self::LeftArm, Self::RightArm, Self::LeftHand, Self::RightHand];

    /// Returns the name of the chain. This is `torso`, `neck`, `left-arm`, `right-arm`, `left-hand` or `right-hand`.
    pub fn name(self) -> &'static str {
        ["torso", "neck", "left-arm", "right-arm", "left-hand", "right-hand"][self as usize]
    }

    /// Returns the chain with the given name.
    ///
    /// # Errors
    /// Returns [`IcubError::Chain`] if the name is unknown. The error lists all chains.
    pub fn from_name(name: &str) -> Result<Self, IcubError> {
        let found = Self::ALL.into_iter().find(|chain| chain.name() == name);
        found.ok_or_else(|| IcubError::Chain { name: name.into() })
    }

    /// Returns the side of an arm or a hand, and `None` for the other chains.
    pub fn side(self) -> Option<Side> {
        match self {
            Self::Torso | Self::Neck => None,
            Self::LeftArm | Self::LeftHand => Some(Side::Left),
            Self::RightArm | Self::RightHand => Some(Side::Right),
        }
    }

    /// Returns the indices of the bodies. The joints have the same indices.
    pub fn bodies(self) -> Range<usize> {
        [0..3, 3..6, 6..13, 13..20, 20..40, 40..60][self as usize].clone()
    }

    /// Returns the names of the joints in the order of the bodies.
    pub fn joint_names(self) -> Vec<String> {
        let prefix = self.side().map_or("", Side::prefix);
        match self.parts() {
            [] => {
                let first = Finger::Thumb.first_joint();
                self.bodies().zip(first..).map(|(_, n)| format!("{prefix}J{n}")).collect()
            }
            parts => parts.iter().map(|part| format!("{prefix}{}", part.joint)).collect(),
        }
    }

    /// Returns the chain to which a body belongs.
    pub fn of_body(body: BodyId) -> Option<Self> {
        Self::ALL.into_iter().find(|chain| chain.bodies().contains(&body.index()))
    }

    /// Returns the rows of the table for its parts, those of a left arm as of a right one, without hands.
    pub(super) fn parts(self) -> &'static [Part] {
        match self {
            Self::Torso => &TORSO,
            Self::Neck => &NECK,
            Self::LeftArm | Self::RightArm => &ARM,
            Self::LeftHand | Self::RightHand => &[],
        }
    }
}
