//! Abilities that a world must have for a robot with joints.

use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Joints, Kinematics, Sensor as _, Vision,
};
use farsa_physics::articulated::{Lane, World};

use crate::parts::eye::Eye;

/// A world of bodies with joints, in space.
pub(crate) trait SpatialWorld:
    Kinematics
    + Joints
    + Actuated
    + Contacts
    + Arrange
    + Vision
    + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
{
    /// Draws the view of a camera.
    fn show(&self, eye: &mut Eye, out: &mut [f32]);
}

impl SpatialWorld for World<f32> {
    fn show(&self, eye: &mut Eye, out: &mut [f32]) {
        eye.read(self, out);
    }
}

impl SpatialWorld for Lane<'_> {
    fn show(&self, eye: &mut Eye, out: &mut [f32]) {
        eye.read(self, out);
    }
}

#[cfg(feature = "rapier")]
impl SpatialWorld for farsa_physics::rapier::World {
    /// Draws nothing, because files with a camera are rejected for this engine.
    fn show(&self, _: &mut Eye, out: &mut [f32]) {
        out.fill(0.0);
    }
}
