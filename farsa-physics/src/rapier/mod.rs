//! The same robots, and general scenes, in rapier.
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
//!
//! - `options`: how a world is stepped
//! - `scene`: a robot with objects around it, as data
//! - `error`: why a world cannot be built
//! - `convert`: vectors, frames and shapes as rapier has them
//! - `model`: from a description to rapier's bodies, joints and colliders
//! - `rules`: which colliders may touch, and with what friction
//! - `world`: one world of rapier
//! - `ports`: its ports
//! - `contact`: what rapier's contacts say
//! - `pushes`: forces from outside
//! - `snapshot`: rapier's whole state as numbers
//! - `arena_options`: how a world of wheeled robots is stepped
//! - `arena_scene`: wheeled robots as rigid bodies, and what they can push, as data
//! - `arena_model`: from an arena to rapier's bodies, joints and colliders
//! - `arena_world`: one world of wheeled robots
//! - `arena_ports`: its ports

mod arena_model;
mod arena_options;
mod arena_ports;
mod arena_scene;
mod arena_world;
mod contact;
mod convert;
mod error;
mod model;
mod options;
mod ports;
mod pushes;
mod rules;
mod scene;
mod snapshot;
mod world;

pub use arena_options::ArenaOptions;
pub use arena_scene::{ArenaScene, Block, Chassis};
pub use arena_world::ArenaWorld;
pub use error::RapierError;
pub use options::Options;
pub use scene::{Geometry, Scene, SceneObject};
pub use world::World;
