//! Kinematic planar worlds of wheeled robots.

/// Many worlds in SIMD lanes.
#[cfg(all(feature = "lanes", not(test)))]
mod batch;
/// Convex obstacles as data.
pub(crate) mod convex;
/// A step of one world with many robots or attachments.
pub(crate) mod crowd;
/// Walls, obstacles, cylinders, areas and robots, as data.
pub(crate) mod description;
/// The error of planar worlds.
pub(crate) mod error;
/// Faces of a convex hull in space, the only file that depends on parry.
#[cfg(feature = "parry")]
mod facets;
/// A uniform grid that finds near bodies.
mod grid;
/// The ring of analytic infrared sensors.
mod infrared;
/// The compiled steps of batches.
#[cfg(all(feature = "lanes", not(test)))]
mod lockstep;
/// The constant part, checked.
pub(crate) mod model;
/// Outlines of convex obstacles in `f64`: hulls, checks, distances.
mod outline;
/// A free place that keeps its distances.
mod place;
/// A wall as the step has it.
pub(crate) mod slab;
/// Convex obstacles in the form of the step, with discs and rays that hit them.
mod solid;
/// One step, of one world or of lanes.
pub(crate) mod step;
/// Nearest points and overlaps of discs with walls and with each other.
pub(crate) mod surface;
/// Answers of the ports, from the words of a state.
pub(crate) mod view;
/// One world behind the ports.
mod world;

#[cfg(all(feature = "lanes", not(test)))]
pub use batch::{Batch, Lane};
pub use convex::{Convex, ConvexForm};
pub use description::{Area, AreaShape, Arena, CollisionRule, Cylinder, RobotPlacement, Search, Wall};
pub use error::{ArenaError, ConvexFault, Part};
pub use place::FreePlace;
pub use world::World;
