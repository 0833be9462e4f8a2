//! What a robot with joints needs of a world.

use farsa_body::{Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Joints, Kinematics};

/// A world of bodies with joints, in space.
pub(crate) trait SpatialWorld:
    Kinematics + Joints + Actuated + Contacts + Arrange + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
{
}

impl<W> SpatialWorld for W where
    W: Kinematics
        + Joints
        + Actuated
        + Contacts
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
{
}
