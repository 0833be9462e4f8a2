//! The sensors of the format.

use farsa_body::ChannelError;
use farsa_lab::Error;
use farsa_lab::advanced::Part;

use crate::part::{planar_sensor, sensor, spatial_sensor};

/// Attachment devices.
mod attachment;
/// Axes of a vector.
mod axes;
/// Poses of bodies.
mod body_pose;
/// Velocities of bodies.
mod body_velocity;
/// Cameras with sectors.
mod camera;
/// Images.
mod camera_image;
/// Colors.
mod color;
/// Positions of colors in an image.
mod color_blobs;
/// Constants.
mod constant;
/// Contact forces.
mod contact_force;
/// Eyes of a robot with joints.
pub(crate) mod eye;
/// Energy and load of foragers.
pub(crate) mod forager;
/// Pose and velocity of frames of bodies.
mod frame;
/// Color of the ground.
mod ground_color;
/// Heights.
mod height;
/// Infrared sensors.
pub(crate) mod infrared;
/// Infrared tables from files.
pub(crate) mod infrared_tables;
/// Positions of joints.
mod joint_position;
/// Speeds of joints.
mod joint_speed;
/// Laser range finders.
mod laser_distance;
/// Light.
mod light;
/// Positions of markers relative to a body.
mod marker_position;
/// Orientations of bodies.
mod orientation;
/// Signals.
mod signal;
/// Positions of things.
pub(crate) mod target_position;
/// Contacts.
mod touch;
/// Traction.
mod traction;
/// Offsets between things in an image.
mod visual_offset;
/// Speeds of wheels.
mod wheel_speed;

/// Lists them under their names.
pub(crate) fn sensors() -> Vec<Part> {
    vec![
        planar_sensor::<infrared::Infrared>("infrared"),
        planar_sensor::<light::Light>("light"),
        planar_sensor::<ground_color::GroundColor>("ground-color"),
        planar_sensor::<laser_distance::LaserDistance>("laser-distance"),
        sensor::<camera::Camera>("camera"),
        spatial_sensor::<camera_image::CameraImage>("camera-image"),
        spatial_sensor::<color_blobs::ColorBlobs>("color-blobs"),
        spatial_sensor::<visual_offset::VisualOffset>("visual-offset"),
        planar_sensor::<wheel_speed::WheelSpeed>("wheel-speed"),
        planar_sensor::<traction::Traction>("traction"),
        planar_sensor::<signal::Signal>("signal"),
        planar_sensor::<attachment::Attachment>("attachment"),
        sensor::<touch::Touch>("touch"),
        sensor::<contact_force::ContactForce>("contact-force"),
        sensor::<target_position::TargetPosition>("target-position"),
        sensor::<body_pose::BodyPose>("body-pose"),
        sensor::<orientation::Orientation>("orientation"),
        sensor::<orientation::Up>("up"),
        sensor::<body_velocity::BodyVelocity>("body-velocity"),
        sensor::<height::Height>("height"),
        sensor::<joint_position::JointPosition>("joint-position"),
        sensor::<joint_speed::JointSpeed>("joint-speed"),
        planar_sensor::<forager::Energy>("energy"),
        planar_sensor::<forager::Carried>("carried"),
        sensor::<constant::Constant>("constant"),
    ]
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// Describes an error without its place.
fn wrong(error: ChannelError) -> Error {
    Error::Other(error.to_string())
}

/// Returns the first items of a list, or all of them for 0.
fn first<T: Clone>(list: &[T], count: u32) -> Result<Vec<T>, Error> {
    let end = if count == 0 { list.len() } else { count as usize };
    let found = list.get(..end).filter(|found| !found.is_empty());
    found.map(<[T]>::to_vec).ok_or_else(|| wrong(ChannelError::Selection { start: 0, end, channels: list.len() }))
}
