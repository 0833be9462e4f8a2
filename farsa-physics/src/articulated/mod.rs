//! Articulated rigid bodies in reduced coordinates with compliant contacts.
//!
//! From a description to a step, and out again:
//!
//! - `model`: the constant part: links, colliders, pairs, actuators, options
//! - `model_builder`: makes a model from a description
//! - `link`: a moving link: its constants, and what the sweeps compute for it
//! - `links`: the moving links of a description, and their inertias
//! - `spatial`: spatial vectors and inertias [Featherstone2008]
//! - `sliding`: the same for links that only slide
//! - `tree`: forward kinematics, articulated bodies, Newton-Euler, composite bodies
//! - `collision`: gap, normal and point of two convex shapes
//! - `contact`: the contact points of each pair of colliders
//! - `rows`: what a unit force or moment at a contact does to the tree
//! - `stop`: joint stops as one-sided rows
//! - `solver`: the impulses of contacts and stops, solved together
//! - `step`: one control step, of one world or of lanes
//! - `external`: forces from outside
//! - `view`: answers of the ports, from the words of a state
//! - `ray`: ray casts
//! - `world`: one world behind the ports
//! - `lockstep`: the compiled steps of batches
//! - `sight`: what cameras see in a horizontal plane
//! - `vision`: what the eyes of a camera with an image see
//! - `group`: groups of pairs that are looked at together
//! - `ground`: friction below bodies that slide in a plane
//! - `batch`: many worlds in SIMD lanes
//! - `lane`: one world of a batch behind the ports

#[cfg(all(feature = "lanes", not(test)))]
mod batch;
#[cfg(feature = "alloc")]
mod collision;
#[cfg(feature = "alloc")]
mod contact;
#[cfg(feature = "alloc")]
mod external;
#[cfg(feature = "alloc")]
mod ground;
#[cfg(feature = "alloc")]
mod group;
#[cfg(all(feature = "lanes", not(test)))]
mod lane;
#[cfg_attr(not(feature = "alloc"), allow(dead_code, reason = "links are made by models, which own vectors"))]
pub(crate) mod link;
#[cfg(feature = "alloc")]
pub(crate) mod links;
#[cfg(all(feature = "lanes", not(test)))]
pub(crate) mod lockstep;
#[cfg(feature = "alloc")]
pub(crate) mod model;
#[cfg(feature = "alloc")]
mod model_builder;
#[cfg(feature = "alloc")]
pub(crate) mod ray;
#[cfg(feature = "alloc")]
mod rows;
#[cfg(feature = "alloc")]
mod sight;
#[cfg_attr(not(feature = "alloc"), allow(dead_code, reason = "links are made by models, which own vectors"))]
mod sliding;
#[cfg(feature = "alloc")]
mod solver;
#[cfg_attr(not(feature = "alloc"), allow(dead_code, reason = "contacts need models, which own vectors"))]
pub(crate) mod spatial;
#[cfg(feature = "alloc")]
mod step;
#[cfg(feature = "alloc")]
mod stop;
#[cfg_attr(not(feature = "alloc"), allow(dead_code, reason = "links are made by models, which own vectors"))]
pub(crate) mod tree;
#[cfg(feature = "alloc")]
pub(crate) mod view;
#[cfg(feature = "alloc")]
mod vision;
#[cfg(feature = "alloc")]
mod world;

#[cfg(all(feature = "lanes", not(test)))]
pub use batch::Batch;
#[cfg(feature = "alloc")]
pub use external::Wrenches;
#[cfg(all(feature = "lanes", not(test)))]
pub use lane::Lane;
pub use link::{Link, LinkData};
#[cfg(all(feature = "lanes", not(test)))]
pub use lockstep::LANES;
#[cfg(feature = "alloc")]
pub use model::{Model, ModelError, Options};
pub use spatial::Spatial;
#[cfg(feature = "alloc")]
pub use step::{Precision, Scratch, step};
pub use tree::{
    Root, accelerations, centre_of_mass, forward_kinematics, inverse_dynamics, jacobian, kinetic_energy, mass_matrix,
    potential_energy,
};
#[cfg(feature = "alloc")]
pub use world::World;
