// The examples of the README build descriptions, which need `alloc`.
#![cfg_attr(feature = "alloc", doc = include_str!("../README.md"))]
#![cfg_attr(
    not(feature = "alloc"),
    doc = "Actuators, ports, sensors and motors of robots; the feature `alloc` adds descriptions."
)]
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

pub mod actuators;
/// The error of constructors of sensors, motors and wrappers, and writing to slices that may be short.
mod channel;
/// Sensors and motors made of sensors and motors.
mod compose;
#[cfg(feature = "alloc")]
pub mod kinematics;
pub mod motors;
/// The ports: what a world may offer, and the two sides that use it.
mod ports;
/// Positions, orientations and velocities.
mod pose;
/// What records an episode, tick by tick.
mod recorder;
#[cfg(feature = "alloc")]
pub mod robot;
#[cfg(feature = "alloc")]
pub mod robots;
pub mod sensors;
#[cfg(feature = "alloc")]
pub mod testing;
pub mod wrappers;

pub use actuators::{Effort, Held, Law, MusclePair, MuscleVariant, Servo, Tension, Torque, Velocity};
pub use channel::ChannelError;
#[cfg(feature = "alloc")]
pub use kinematics::{Goal, InverseKinematics, InverseKinematicsError, KinematicTree, Orientation, Solution};
pub use motors::{
    AttachmentMotor, HeadTracking, Leds, Muscles, ServoGroup, ServoRange, SignalMotor, SpeedAndTurn, TorqueMotor,
    VelocityMotor, WheelVelocity,
};
pub use ports::{
    Actuated, ActuatorId, Arrange, BodyId, Channels, Contacts, ExternalForces, Handles, Hit, JointId, Joints,
    Kinematics, Lamp, Motor, NearbySurface, PairContact, PairId, Planar, PlanarHit, Rays, Seen, Sensor, Sight,
    Snapshot, Vision, World,
};
pub use pose::{Pose, Twist};
pub use recorder::{Recorder, record_world};
#[cfg(feature = "alloc")]
pub use robot::{
    Actuator, Collider, Ground, Joint, JointKind, MassProperties, Offsets, Pair, Robot, RobotError, Segment, Shape,
    Surface, Visual,
};
#[cfg(feature = "alloc")]
pub use robots::{
    ArmAndHand, Chain, Finger, Hand, Icub, IcubError, IcubPosture, IcubTabletop, InfraredRing, JointControl,
    MobileParts, MobileRobot, Side, Tabletop,
};
pub use sensors::{
    AnalyticInfrared, AttachmentSensor, Axes, Beam, BodyPose, BodyVelocity, ColorBand, ContactForce, GroundColor,
    Height, InfraredAnalytic, InfraredRays, JointPosition, JointSpeed, LaserDistance, LightSensors, LinearCamera,
    Point, Signal, SignalSensor, TargetPosition, Touch, Traction, WheelSpeed,
};
#[cfg(feature = "alloc")]
pub use sensors::{
    Camera, CameraImage, ColorBlobs, InfraredDrawing, InfraredGroups, InfraredTable, InfraredTableError,
    InfraredTables, SampledInfrared, VisualOffset,
};
pub use wrappers::{Delayed, Lesioned, Noise, Noisy, Recorded, Saturated, Scaled, Stuck, StuckAt, Thresholded};
