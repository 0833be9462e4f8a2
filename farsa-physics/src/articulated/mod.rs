//! Articulated rigid bodies in reduced coordinates with compliant contacts.

/// Many worlds in SIMD lanes.
#[cfg(all(feature = "lanes", not(test)))]
mod batch;
/// Contact of two boxes.
#[cfg(feature = "alloc")]
mod boxes;
/// Gap, normal and point of two convex shapes.
#[cfg(feature = "alloc")]
mod collision;
/// The contact points of each pair of colliders.
#[cfg(feature = "alloc")]
mod contact;
/// Cylinders against balls, segments and planes.
#[cfg(feature = "alloc")]
mod cylinder;
/// Forces from outside.
#[cfg(feature = "alloc")]
mod external;
/// Friction below bodies that slide in a plane.
#[cfg(feature = "alloc")]
mod ground;
/// Groups of pairs that are tested together.
#[cfg(feature = "alloc")]
mod group;
/// Dynamics steps in halves.
#[cfg(feature = "alloc")]
mod halves;
/// Impedance over the depth of a contact or stop.
#[cfg(feature = "alloc")]
mod impedance;
/// Laws of joints that are rows.
#[cfg(feature = "alloc")]
mod joint_laws;
/// Bounded rows of joints.
#[cfg(feature = "alloc")]
mod joint_row;
/// One world of a batch behind the ports.
#[cfg(all(feature = "lanes", not(test)))]
mod lane;
/// A moving link: its constants, and the results of the sweeps.
#[cfg_attr(not(feature = "alloc"), allow(dead_code, reason = "links are made by models, which own vectors"))]
pub(crate) mod link;
/// The moving links of a description, and their inertias.
#[cfg(feature = "alloc")]
pub(crate) mod links;
/// The compiled steps of batches.
#[cfg(all(feature = "lanes", not(test)))]
pub(crate) mod lockstep;
/// The constant part: links, colliders, pairs, actuators, options.
#[cfg(feature = "alloc")]
pub(crate) mod model;
/// Makes a model from a description.
#[cfg(feature = "alloc")]
mod model_builder;
/// Friction as a pyramid.
#[cfg(feature = "alloc")]
mod pyramid;
/// Ray casts.
#[cfg(feature = "alloc")]
pub(crate) mod ray;
/// Restitution of contacts.
#[cfg(feature = "alloc")]
mod restitution;
/// Responses of the tree to a unit force or moment at a contact.
#[cfg(feature = "alloc")]
mod rows;
/// Sight in a horizontal plane.
#[cfg(feature = "alloc")]
mod sight;
/// Spatial vectors of links that only slide.
#[cfg_attr(not(feature = "alloc"), allow(dead_code, reason = "links are made by models, which own vectors"))]
mod sliding;
/// Contacts that stop motion gradually.
#[cfg(feature = "alloc")]
mod soft_contact;
/// The impulses of contacts and stops, solved together.
#[cfg(feature = "alloc")]
mod solver;
/// Spatial vectors and inertias [Featherstone2008].
#[cfg_attr(not(feature = "alloc"), allow(dead_code, reason = "contacts need models, which own vectors"))]
pub(crate) mod spatial;
/// One control step, of one world or of lanes.
#[cfg(feature = "alloc")]
mod step;
/// Joint stops as one-sided rows.
#[cfg(feature = "alloc")]
mod stop;
/// The sweeps over the rows.
#[cfg(feature = "alloc")]
mod sweep;
/// Forward kinematics, articulated bodies, Newton-Euler, composite bodies.
#[cfg_attr(not(feature = "alloc"), allow(dead_code, reason = "links are made by models, which own vectors"))]
pub(crate) mod tree;
/// The ports, read from the words of a state.
#[cfg(feature = "alloc")]
pub(crate) mod view;
/// Rays of cameras with an image.
#[cfg(feature = "alloc")]
mod vision;
/// One world behind the ports.
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
