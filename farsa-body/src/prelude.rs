//! The most common names for a first program. Import them with `use farsa_body::prelude::*;`.
//!
//! The trait [`World`](crate::ports::World) is imported without a name, because each world of `farsa-physics` has the
//! same name.

pub use crate::motors::{Muscles, ServoGroup, SpeedAndTurn, TorqueMotor, WheelVelocity};
pub use crate::ports::World as _;
pub use crate::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Channels, Contacts, JointId, Joints, Kinematics, Motor, PairId, Planar,
    Rays, Sensor, Snapshot,
};
pub use crate::sensors::{
    BodyPose, Height, JointPosition, JointSpeed, LightSensors, LinearCamera, Signal, TargetPosition, Touch, WheelSpeed,
};
pub use crate::wrappers::{Delayed, Noise, Noisy, Scaled};
pub use crate::{Pose, Recorder, Twist};
#[cfg(feature = "alloc")]
pub use crate::{
    actuators::{Law, Servo},
    robot::{Collider, Joint, MassProperties, Robot, Segment, Shape},
    robots::{ArmAndHand, MobileParts, MobileRobot, Tabletop},
    sensors::GroundColor,
    sensors::infrared::{InfraredFormula, InfraredRays},
};
