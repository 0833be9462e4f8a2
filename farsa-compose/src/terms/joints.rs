//! Positions and speeds of joints.

use farsa_body::ports::{Handles, JointId, Joints};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{Moment, PartScene, Term, TermPart};

/// Mean speed of joints [rad/s or m/s].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct JointSpeed {
    /// Names of joints of a robot with joints, by default all.
    #[serde(default)]
    joints: Vec<String>,
}

/// Position of a joint [rad or m].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct JointPosition {
    /// Name of a joint of a robot with joints.
    joint: String,
}

/// Speed of a joint with its sign [rad/s or m/s].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct JointVelocity {
    /// Name of a joint of a robot with joints.
    joint: String,
}

/// The mean speed of joints.
#[derive(Clone, Debug)]
pub(super) struct SpeedOfJoints(Vec<JointId>);

impl<W: Joints + Handles<Joint = JointId>> Term<W> for SpeedOfJoints {
    fn value(&self, world: &W, _: &Moment<'_>) -> f64 {
        let sum: f64 = self.0.iter().map(|joint| f64::from(world.speed(*joint)).abs()).sum();
        sum / self.0.len().max(1) as f64
    }

    fn has_state(&self) -> bool {
        false
    }
}

/// The position of a joint.
#[derive(Clone, Debug)]
pub(super) struct PositionOfJoint(JointId);

impl<W: Joints + Handles<Joint = JointId>> Term<W> for PositionOfJoint {
    fn value(&self, world: &W, _: &Moment<'_>) -> f64 {
        f64::from(world.position(self.0))
    }

    fn has_state(&self) -> bool {
        false
    }
}

/// The speed of a joint with its sign.
#[derive(Clone, Debug)]
pub(super) struct VelocityOfJoint(JointId);

impl<W: Joints + Handles<Joint = JointId>> Term<W> for VelocityOfJoint {
    fn value(&self, world: &W, _: &Moment<'_>) -> f64 {
        f64::from(world.speed(self.0))
    }

    fn has_state(&self) -> bool {
        false
    }
}

impl TermPart for JointSpeed {
    type Term = SpeedOfJoints;

    fn term(&self, scene: &PartScene<'_>) -> Result<SpeedOfJoints, Error> {
        Ok(SpeedOfJoints(scene.0.joints(&self.joints)?))
    }

    fn joints(&self) -> Option<&[String]> {
        Some(&self.joints)
    }
}

impl TermPart for JointPosition {
    type Term = PositionOfJoint;

    fn term(&self, scene: &PartScene<'_>) -> Result<PositionOfJoint, Error> {
        Ok(PositionOfJoint(scene.0.one_joint(&self.joint)?))
    }

    fn joints(&self) -> Option<&[String]> {
        Some(std::slice::from_ref(&self.joint))
    }
}

impl TermPart for JointVelocity {
    type Term = VelocityOfJoint;

    fn term(&self, scene: &PartScene<'_>) -> Result<VelocityOfJoint, Error> {
        Ok(VelocityOfJoint(scene.0.one_joint(&self.joint)?))
    }

    fn joints(&self) -> Option<&[String]> {
        Some(std::slice::from_ref(&self.joint))
    }
}
