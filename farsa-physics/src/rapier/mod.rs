//! Robots of this crate, and general scenes, in rapier.
//!
//! A block on a slide pushes a crate over the ground:
//!
//! ```
//! use farsa_body::Pose;
//! use farsa_body::actuators::{Law, Servo};
//! use farsa_body::ports::{Actuated, JointId, Kinematics, World as _};
//! use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape};
//! use farsa_physics::rapier::{Geometry, Options, RapierError, Scene, SceneObject, World};
//!
//! fn main() -> Result<(), RapierError> {
//!     let half = [0.02, 0.05, 0.02];
//!     let mut robot = Robot::new("pusher");
//!     let slide = Joint::prismatic("slide", [1.0, 0.0, 0.0], Pose::at([0.0, 0.0, 0.03]), [-1.0, 1.0]);
//!     let block = robot.add_segment(Segment::new("block", None, slide, MassProperties::cuboid(1.0, half)));
//!     robot.add_collider(Collider::new("front", Some(block), Shape::Box { half }, Pose::identity()));
//!     let servo = Servo { stiffness: 2000.0, damping: 200.0, limit: 50.0 };
//!     let motor = robot.add_actuator("slide", JointId(block.0), Law::Servo(servo));
//!
//!     let mut scene = Scene::new(robot);
//!     scene.add(SceneObject::fixed("ground", Geometry::Simple(Shape::Plane), Pose::identity()));
//!     let geometry = Geometry::Simple(Shape::Box { half: [0.04; 3] });
//!     let parcel = scene.add(SceneObject::movable("crate", geometry, Pose::at([0.1, 0.0, 0.04]), 0.5));
//!
//!     let mut world = World::from_scene(&scene, &Options::default())?;
//!     for step in 1..=200 {
//!         world.command(motor, [0.001 * step as f32, 0.0]);
//!         world.step();
//!     }
//!     // 0.26 m, less what the servo's damping lags behind at 0.1 m/s.
//!     let place = world.pose(parcel).position[0];
//!     assert!((place - 0.25).abs() < 0.005, "{place} m");
//!     Ok(())
//! }
//! ```
//!
//! The files without a prefix are of articulated robots and general scenes, those with `arena_` of wheeled robots:

/// From an arena to rapier's bodies, joints and colliders.
mod arena_model;
/// The options of a world of wheeled robots.
mod arena_options;
/// The ports of a world of wheeled robots.
mod arena_ports;
/// Wheeled robots as rigid bodies, and what they can push, as data.
mod arena_scene;
/// One world of wheeled robots.
mod arena_world;
/// Readings of rapier's contacts.
mod contact;
/// Vectors, frames and shapes as rapier has them.
mod convert;
/// The error of worlds.
mod error;
/// From a description to rapier's bodies, joints and colliders.
mod model;
/// The options of a world.
mod options;
/// The ports of a world.
mod ports;
/// Forces from outside.
mod pushes;
/// Which colliders may touch, and with what friction.
mod rules;
/// A robot with objects around it, as data.
mod scene;
/// Rapier's whole state as numbers.
mod snapshot;
/// One world of rapier.
mod world;

pub use arena_options::ArenaOptions;
pub use arena_scene::{ArenaScene, Block, Chassis};
pub use arena_world::ArenaWorld;
pub use error::RapierError;
pub use options::Options;
pub use scene::{Geometry, Scene, SceneObject};
pub use world::World;
