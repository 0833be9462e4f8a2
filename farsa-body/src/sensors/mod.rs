//! Sensors that convert the state of a world to values for a network.
//!
//! | to sense | use | channels | port |
//! |---|---|---|---|
//! | a joint's position, as a share of its range | [`JointPosition`] | 1 | `Joints` |
//! | a joint's speed | [`JointSpeed`] | 1 | `Joints` |
//! | contact, or its force | [`Touch`], [`ContactForce`] | 1 | `Contacts` |
//! | the position of a target, as seen from a body | [`TargetPosition`] | 3 | `Kinematics` |
//! | a body's height, pose, velocity | [`Height`], [`BodyPose`], [`BodyVelocity`] | 1, 7, 6 | `Kinematics` |
//! | the speeds of wheels | [`WheelSpeed`] | 1 per wheel | `Joints` |
//! | forces that push or pull a robot on wheels | [`Traction`] | 2 | `Kinematics`, `Joints` |
//! | objects near a wheeled robot | one of the [infrared rings](infrared) | 1 per sensor | `Rays` or `Sight` |
//! | distances along several beams | [`LaserDistance`] | 1 per beam | `Rays` |
//! | colors in the sectors of a view | [`LinearCamera`] | sectors x colors | `Sight` |
//! | an image, by a camera on any body | [`CameraImage`] | rows x columns x 3 | `Vision` |
//! | the position and size of a color in an image | [`ColorBlobs`] | 3 per color | `Vision` |
//! | the offset of two points in an image | [`VisualOffset`] | 2 | `Kinematics` |
//! | lamps | [`LightSensors`] | 1 per sensor | `Planar` |
//! | the ground's color | [`GroundColor`] | 1 or 3 per place | `Planar` |
//! | the signals of other robots | [`SignalSensor`] | sectors | `Sight` |
//! | the state of an attachment device | [`AttachmentSensor`] | 1 | `Planar` |
//! | a label, an instruction, a bias that the experiment sets | [`Signal`] | any | none |
//!
//! All sensors implement [`Sensor`](crate::ports::Sensor) for any world that supports the required port. Tuples, arrays
//! and `Vec`s of sensors are sensors, too. Use a [wrapper](crate::wrappers) to add noise, delay or damage, or to change
//! the scale.

/// Rays that leave a robot's hull, and fans of them.
pub(crate) mod beam;
/// Cameras with an image, on any body.
#[cfg(feature = "alloc")]
pub(crate) mod camera;
/// The color of the ground.
pub(crate) mod ground_color;
pub mod infrared;
/// A fan of laser range finders.
pub(crate) mod laser_distance;
/// Lamps, by a ring of sensors.
pub(crate) mod light_sensors;
/// A camera with one line of pixels.
pub(crate) mod linear_camera;
/// Where bodies are and how they move.
pub(crate) mod place;
/// Positions and speeds of the robot's own joints.
pub(crate) mod proprioception;
/// Channels that the experiment sets.
pub(crate) mod signal;
/// Signals of other robots.
pub(crate) mod signal_sensor;
/// The place and heading of a mobile robot, shared by the sensors of the plane.
pub(crate) mod stance;
/// Contacts and their forces.
pub(crate) mod touch;
/// Speeds of wheels and forces on them.
pub(crate) mod wheel_speed;

pub use crate::motors::attachment::AttachmentSensor;
pub use beam::Beam;
#[cfg(feature = "alloc")]
pub use camera::{Camera, CameraImage, ColorBlobs, VisualOffset};
pub use ground_color::GroundColor;
pub use laser_distance::LaserDistance;
pub use light_sensors::LightSensors;
pub use linear_camera::{ColorBand, LinearCamera};
pub use place::{Axes, BodyPose, BodyVelocity, Height, Point, TargetPosition};
pub use proprioception::{JointPosition, JointSpeed};
pub use signal::Signal;
pub use signal_sensor::SignalSensor;
pub use touch::{ContactForce, Touch};
pub use wheel_speed::{Traction, WheelSpeed};
