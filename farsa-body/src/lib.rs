// The examples of the README build descriptions, which need `alloc`.
#![cfg_attr(feature = "alloc", doc = include_str!("../README.md"))]
#![cfg_attr(
    not(feature = "alloc"),
    doc = "Actuators, ports, sensors and motors of robots; the feature `alloc` adds descriptions."
)]
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(feature = "files")]
extern crate std;

mod actuator;
#[cfg(feature = "alloc")]
mod arm_and_hand;
mod attachment;
mod beam;
mod channel;
#[cfg(feature = "alloc")]
mod check_arrange;
#[cfg(feature = "alloc")]
mod check_channels;
#[cfg(feature = "alloc")]
mod check_planar;
#[cfg(feature = "alloc")]
mod check_rays;
#[cfg(feature = "alloc")]
mod check_world;
mod compose;
mod delayed;
mod faulty;
#[cfg(feature = "alloc")]
mod goal;
mod ground_color;
mod infrared_analytic;
mod infrared_model;
mod infrared_rays;
#[cfg(feature = "alloc")]
mod infrared_table;
#[cfg(feature = "alloc")]
mod inverse_kinematics;
#[cfg(feature = "alloc")]
mod inverse_weight;
#[cfg(feature = "alloc")]
mod kinematics;
mod laser_distance;
mod leds;
mod light_sensors;
mod linear_camera;
#[cfg(feature = "alloc")]
mod markup;
#[cfg(feature = "files")]
mod markup_check;
#[cfg(feature = "files")]
mod markup_tree;
#[cfg(feature = "alloc")]
mod mass_properties;
#[cfg(feature = "files")]
mod mesh;
#[cfg(feature = "alloc")]
mod mjcf;
#[cfg(feature = "alloc")]
mod mobile;
#[cfg(feature = "files")]
mod model_files;
mod motor;
mod muscle;
mod noisy;
mod place;
#[cfg(feature = "alloc")]
mod plane_world;
#[cfg(feature = "alloc")]
mod point_world;
mod ports;
mod pose;
#[cfg(feature = "files")]
mod principal_axes;
mod proprioception;
#[cfg(feature = "files")]
mod read_error;
#[cfg(feature = "files")]
mod read_mjcf;
#[cfg(feature = "files")]
mod read_mjcf_actuators;
#[cfg(feature = "files")]
mod read_mjcf_bodies;
#[cfg(feature = "files")]
mod read_mjcf_classes;
#[cfg(feature = "files")]
mod read_mjcf_contacts;
#[cfg(feature = "files")]
mod read_mjcf_geoms;
#[cfg(feature = "files")]
mod read_mjcf_joints;
#[cfg(feature = "files")]
mod read_urdf;
#[cfg(feature = "files")]
mod reading;
mod recorder;
#[cfg(feature = "files")]
mod repair;
#[cfg(feature = "alloc")]
mod robot;
#[cfg(feature = "alloc")]
mod sampled_infrared;
mod scaled;
mod signal;
mod signal_sensor;
#[cfg(feature = "files")]
mod solid;
mod stance;
#[cfg(feature = "alloc")]
mod tabletop;
#[cfg(feature = "alloc")]
pub mod testing;
mod touch;
#[cfg(feature = "alloc")]
mod trace;
#[cfg(feature = "alloc")]
mod urdf;
#[cfg(feature = "alloc")]
mod validation;
mod wheel_speed;
mod wheels;
mod wrap;

pub use actuator::{Effort, Held, Law, Servo, Torque};
#[cfg(feature = "alloc")]
pub use arm_and_hand::{ArmAndHand, Finger};
pub use attachment::{AttachmentMotor, AttachmentSensor};
pub use beam::Beam;
pub use channel::ChannelError;
pub use delayed::Delayed;
pub use faulty::{Lesioned, Stuck, StuckAt};
#[cfg(feature = "alloc")]
pub use goal::{Goal, Orientation};
pub use ground_color::GroundColor;
pub use infrared_analytic::InfraredAnalytic;
pub use infrared_model::AnalyticInfrared;
pub use infrared_rays::InfraredRays;
#[cfg(feature = "alloc")]
pub use infrared_table::{InfraredTable, InfraredTableError};
#[cfg(feature = "alloc")]
pub use inverse_kinematics::{InverseKinematics, InverseKinematicsError, Solution};
#[cfg(feature = "alloc")]
pub use kinematics::KinematicTree;
pub use laser_distance::LaserDistance;
pub use leds::{Leds, SignalMotor};
pub use light_sensors::LightSensors;
pub use linear_camera::{ColorBand, LinearCamera};
#[cfg(feature = "alloc")]
pub use mass_properties::MassProperties;
#[cfg(feature = "alloc")]
pub use mjcf::{Keyframe, MjcfOptions};
#[cfg(feature = "alloc")]
pub use mobile::{InfraredRing, MobileParts, MobileRobot};
pub use motor::{Muscles, ServoGroup, ServoRange, TorqueMotor};
pub use muscle::{MusclePair, MuscleVariant, Tension};
pub use noisy::{Noise, Noisy};
pub use place::{Axes, BodyPose, BodyVelocity, Height, Point, TargetPosition};
pub use ports::{
    Actuated, ActuatorId, Arrange, BodyId, Channels, Contacts, Handles, Hit, JointId, Joints, Kinematics, Lamp, Motor,
    Near, PairContact, PairId, Planar, Rays, Sensor, Sight, Snapshot, World,
};
pub use pose::{Pose, Twist};
pub use proprioception::{JointPosition, JointSpeed};
#[cfg(feature = "files")]
pub use read_error::{Place, ReadError};
#[cfg(feature = "files")]
pub use reading::{Frame, Limits, Meshes, Note, ReadOptions, Reading, Repair};
pub use recorder::{Recorder, record_world};
#[cfg(feature = "alloc")]
pub use robot::{Actuator, Collider, Joint, JointKind, Offsets, Pair, Robot, Segment, Shape, Surface};
#[cfg(feature = "alloc")]
pub use sampled_infrared::{InfraredTables, SampledInfrared};
pub use scaled::{Recorded, Saturated, Scaled};
pub use signal::Signal;
pub use signal_sensor::SignalSensor;
#[cfg(feature = "alloc")]
pub use tabletop::Tabletop;
pub use touch::{ContactForce, Touch};
#[cfg(feature = "alloc")]
pub use validation::RobotError;
pub use wheel_speed::{Traction, WheelSpeed};
pub use wheels::{SpeedAndTurn, WheelVelocity};
