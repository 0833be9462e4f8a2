#![doc = include_str!("../README.md")]
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

mod actuator;
mod pose;
mod ports;
#[cfg(feature = "alloc")]
mod robot;

pub use actuator::{Effort, Held, Law, MusclePair, MuscleVariant, Servo, Torque};
pub use pose::{Pose, Twist};
pub use ports::{
    ActuatorId, Actuated, BodyId, Channels, Contacts, Handles, Hit, JointId, Joints, Kinematics, Motor, PairContact,
    PairId, Rays, Sensor, Snapshot, World,
};
#[cfg(feature = "alloc")]
pub use robot::{Actuator, Collider, Joint, JointKind, Pair, Robot, RobotError, Segment, Shape, Surface};
