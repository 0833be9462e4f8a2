#![doc = include_str!("../README.md")]
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

#[cfg(all(feature = "lanes", not(test)))]
mod arena_batch;
#[cfg(feature = "alloc")]
mod arena_convex;
#[cfg(feature = "alloc")]
mod arena_crowd;
#[cfg(feature = "alloc")]
mod arena_description;
#[cfg(feature = "alloc")]
mod arena_error;
#[cfg(feature = "parry")]
mod arena_facets;
#[cfg(feature = "alloc")]
mod arena_grid;
#[cfg(feature = "alloc")]
mod arena_infrared;
#[cfg(all(feature = "lanes", not(test)))]
mod arena_lockstep;
#[cfg(feature = "alloc")]
mod arena_model;
#[cfg(feature = "alloc")]
mod arena_outline;
#[cfg(feature = "alloc")]
mod arena_place;
#[cfg(feature = "alloc")]
mod arena_solid;
#[cfg(feature = "alloc")]
mod arena_step;
#[cfg(feature = "alloc")]
mod arena_surface;
#[cfg(feature = "alloc")]
mod arena_view;
#[cfg(feature = "alloc")]
mod arena_world;
#[cfg(all(feature = "lanes", not(test)))]
mod batch;
#[cfg(feature = "alloc")]
mod collision;
#[cfg(feature = "alloc")]
mod contact;
#[cfg(all(feature = "lanes", not(test)))]
mod lane;
#[cfg(feature = "alloc")]
mod links;
#[cfg(all(feature = "lanes", not(test)))]
mod lockstep;
#[cfg(feature = "alloc")]
mod model;
#[cfg(feature = "alloc")]
mod model_builder;
#[cfg(feature = "rapier")]
mod rapier_arena_model;
#[cfg(feature = "rapier")]
mod rapier_arena_options;
#[cfg(feature = "rapier")]
mod rapier_arena_ports;
#[cfg(feature = "rapier")]
mod rapier_arena_scene;
#[cfg(feature = "rapier")]
mod rapier_arena_world;
#[cfg(feature = "rapier")]
mod rapier_contact;
#[cfg(feature = "rapier")]
mod rapier_error;
#[cfg(feature = "rapier")]
mod rapier_model;
#[cfg(feature = "rapier")]
mod rapier_options;
#[cfg(feature = "rapier")]
mod rapier_ports;
#[cfg(feature = "rapier")]
mod rapier_rules;
#[cfg(feature = "rapier")]
mod rapier_scene;
#[cfg(feature = "rapier")]
mod rapier_snapshot;
#[cfg(feature = "rapier")]
mod rapier_world;
#[cfg(feature = "alloc")]
mod ray;
#[cfg(feature = "alloc")]
mod rows;
#[cfg(feature = "alloc")]
mod solver;
#[cfg_attr(not(feature = "alloc"), allow(dead_code, reason = "contacts need models, which own vectors"))]
mod spatial;
#[cfg(feature = "alloc")]
mod step;
#[cfg(feature = "alloc")]
mod stop;
#[cfg_attr(not(feature = "alloc"), allow(dead_code, reason = "links are made by models, which own vectors"))]
mod tree;
#[cfg(feature = "alloc")]
mod view;
#[cfg(feature = "alloc")]
mod world;

/// Articulated rigid bodies in reduced coordinates with compliant contacts.
pub mod articulated {
    #[cfg(all(feature = "lanes", not(test)))]
    pub use crate::batch::{Batch, LANES};
    #[cfg(all(feature = "lanes", not(test)))]
    pub use crate::lane::Lane;
    #[cfg(feature = "alloc")]
    pub use crate::model::{Model, ModelError, Options};
    pub use crate::spatial::Spatial;
    #[cfg(feature = "alloc")]
    pub use crate::step::{Precision, Scratch, step};
    pub use crate::tree::{
        Link, LinkWork, Root, accelerations, centre_of_mass, inverse_dynamics, jacobian, kinetic_energy, mass_matrix,
        place, potential_energy,
    };
    #[cfg(feature = "alloc")]
    pub use crate::world::World;
}

/// Kinematic planar worlds of wheeled robots.
#[cfg(feature = "alloc")]
pub mod arena {
    #[cfg(all(feature = "lanes", not(test)))]
    pub use crate::arena_batch::{Batch, Lane};
    pub use crate::arena_convex::{Convex, ConvexForm};
    pub use crate::arena_description::{Area, AreaShape, Arena, CollisionRule, Cylinder, Placed, Search, Wall};
    pub use crate::arena_error::{ArenaError, Part};
    pub use crate::arena_place::FreePlace;
    pub use crate::arena_world::World;
}

/// The same robots, and general scenes, in rapier.
///
/// A block on a slide pushes a crate over the ground:
///
/// ```
/// use farsa_body::{
///     Actuated, Collider, Joint, JointId, Kinematics, Law, MassProperties, Pose, Robot, Segment, Servo, Shape, World as _,
/// };
/// use farsa_physics::rapier::{Form, Options, RapierError, Scene, Thing, World};
///
/// fn main() -> Result<(), RapierError> {
///     let half = [0.02, 0.05, 0.02];
///     let mut robot = Robot::new("pusher");
///     let slide = Joint::prismatic("slide", [1.0, 0.0, 0.0], Pose::at([0.0, 0.0, 0.03]), [-1.0, 1.0]);
///     let block = robot.add_segment(Segment::new("block", None, slide, MassProperties::cuboid(1.0, half)));
///     robot.add_collider(Collider::new("front", Some(block), Shape::Box { half }, Pose::identity()));
///     let servo = Servo { stiffness: 2000.0, damping: 200.0, limit: 50.0 };
///     let motor = robot.add_actuator("slide", JointId(block.0), Law::Servo(servo));
///
///     let mut scene = Scene::new(robot);
///     scene.add(Thing::fixed("ground", Form::Simple(Shape::Plane), Pose::identity()));
///     let form = Form::Simple(Shape::Box { half: [0.04; 3] });
///     let goods = scene.add(Thing::movable("crate", form, Pose::at([0.1, 0.0, 0.04]), 0.5));
///
///     let mut world = World::of_scene(&scene, &Options::default())?;
///     for step in 1..=200 {
///         world.command(motor, [0.001 * step as f32, 0.0]);
///         world.step();
///     }
///     // 0.26 m, less what the servo's damping lags behind at 0.1 m/s.
///     let place = world.pose(goods).position[0];
///     assert!((place - 0.25).abs() < 0.005, "{place} m");
///     Ok(())
/// }
/// ```
#[cfg(feature = "rapier")]
pub mod rapier {
    pub use crate::rapier_arena_options::ArenaOptions;
    pub use crate::rapier_arena_scene::{ArenaScene, Block, Chassis};
    pub use crate::rapier_arena_world::ArenaWorld;
    pub use crate::rapier_error::RapierError;
    pub use crate::rapier_options::Options;
    pub use crate::rapier_scene::{Form, Scene, Thing};
    pub use crate::rapier_world::World;
}
