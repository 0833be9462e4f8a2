//! The six chains, the two sides, and which joints and bodies are theirs.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::ops::Range;

use crate::ports::BodyId;
use crate::robots::hand::Finger;
use crate::robots::icub::error::IcubError;
use crate::robots::icub::table::{ARM, NECK, Part, TORSO};

/// The joints of the robot that are actuated or rigid together, in the order of the robot's bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Chain {
    /// Pitch, roll and yaw of the trunk.
    Torso,
    /// Pitch, roll and yaw of the head.
    Neck,
    /// The left arm's seven joints, from the shoulder to the wrist.
    LeftArm,
    /// The right arm's seven joints.
    RightArm,
    /// The left hand's twenty joints, J8 to J27 of [`crate::robots::Hand`].
    LeftHand,
    /// The right hand's twenty joints.
    RightHand,
}

/// One side of the robot, its own left or right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Side {
    /// The left side, y > 0.
    Left,
    /// The right side, y < 0.
    Right,
}

impl Side {
    /// Both sides, the left one first.
    pub const ALL: [Self; 2] = [Self::Left, Self::Right];

    /// Returns the prefix of the names of its joints, segments and colliders.
    pub fn prefix(self) -> &'static str {
        ["l_", "r_"][self as usize]
    }

    /// Its arm.
    pub fn arm(self) -> Chain {
        [Chain::LeftArm, Chain::RightArm][self as usize]
    }

    /// Its hand, without the palm, which is the arm's last segment.
    pub fn hand(self) -> Chain {
        [Chain::LeftHand, Chain::RightHand][self as usize]
    }
}

impl Chain {
    /// All chains, in the order of their bodies.
    pub const ALL: [Self; 6] =
        [Self::Torso, Self::Neck, Self::LeftArm, Self::RightArm, Self::LeftHand, Self::RightHand];

    /// Its name: `torso`, `neck`, `left-arm`, `right-arm`, `left-hand` or `right-hand`.
    pub fn name(self) -> &'static str {
        ["torso", "neck", "left-arm", "right-arm", "left-hand", "right-hand"][self as usize]
    }

    /// The chain of this name.
    ///
    /// # Errors
    /// [`IcubError::Chain`] for an unknown name, with the list of chains.
    pub fn from_name(name: &str) -> Result<Self, IcubError> {
        let found = Self::ALL.into_iter().find(|chain| chain.name() == name);
        found.ok_or_else(|| IcubError::Chain { name: name.into() })
    }

    /// The side of an arm or a hand.
    pub fn side(self) -> Option<Side> {
        match self {
            Self::Torso | Self::Neck => None,
            Self::LeftArm | Self::LeftHand => Some(Side::Left),
            Self::RightArm | Self::RightHand => Some(Side::Right),
        }
    }

    /// The indices of its bodies, and so of its joints.
    pub fn bodies(self) -> Range<usize> {
        [0..3, 3..6, 6..13, 13..20, 20..40, 40..60][self as usize].clone()
    }

    /// The names of its joints, in the order of its bodies.
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

    /// The chain that a body belongs to.
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
