//! Kinematic planar worlds of wheeled robots.
//!
//! From a description to a step, and out again:
//!
//! - `description`: walls, obstacles, cylinders, areas and robots, as data
//! - `convex`: convex obstacles as data
//! - `error`: what no planar world can be built from
//! - `outline`: outlines of convex obstacles in `f64`: hulls, checks, distances
//! - `facets`: faces of a convex hull in space; the one file that knows parry
//! - `model`: the constant part, checked
//! - `slab`: a wall as the step has it
//! - `solid`: convex obstacles as the step has them, and where discs and rays meet them
//! - `surface`: nearest points and overlaps of discs with walls and with each other
//! - `step`: one step, of one world or of lanes
//! - `crowd`: a step of one world with many robots or attachments
//! - `grid`: a uniform grid: which bodies may be near
//! - `infrared`: the ring of analytic infrared sensors
//! - `view`: answers of the ports, from the words of a state
//! - `world`: one world behind the ports
//! - `place`: a free place that keeps its distances
//! - `lockstep`: the compiled steps of batches
//! - `batch`: many worlds in SIMD lanes

#[cfg(all(feature = "lanes", not(test)))]
mod batch;
pub(crate) mod convex;
pub(crate) mod crowd;
pub(crate) mod description;
pub(crate) mod error;
#[cfg(feature = "parry")]
mod facets;
mod grid;
mod infrared;
#[cfg(all(feature = "lanes", not(test)))]
mod lockstep;
pub(crate) mod model;
mod outline;
mod place;
pub(crate) mod slab;
mod solid;
pub(crate) mod step;
pub(crate) mod surface;
pub(crate) mod view;
mod world;

#[cfg(all(feature = "lanes", not(test)))]
pub use batch::{Batch, Lane};
pub use convex::{Convex, ConvexForm};
pub use description::{Area, AreaShape, Arena, CollisionRule, Cylinder, RobotPlacement, Search, Wall};
pub use error::{ArenaError, Part};
pub use place::FreePlace;
pub use world::World;
