//! Descriptions of robots and scenes. Worlds are built from them, and model files are converted to them.
//!
//! Start with [`Robot::new`] and add [`Segment`]s with their [`Joint`]s, [`Collider`]s and [`Actuator`]s. Add the
//! [`Pair`]s of colliders that may touch, and call [`Robot::validate`]. All numbers are `f64` and are rounded once when
//! a world is built.
//!
//! | you have | use |
//! |---|---|
//! | the size and mass of a solid part | [`MassProperties`]: `sphere`, `capsule`, `cylinder`, `cuboid`; `placed` and `with` move and join them |
//! | two points and a radius | [`Collider::capsule_between`] |
//! | a thing that is pushed over a table | [`Robot::add_sliding_body`], and [`Ground`] below it |
//! | a joint that shall not move | [`Joint::locked`] |
//! | two robots for one world | [`Robot::prefixed`], then [`Robot::merge`], which returns the [`Offsets`] of the parts |
//! | a different look | [`Visual`]s, which views draw instead of colliders |
//! | a file | the crate `farsa-models`, which reads and writes URDF and MJCF |

/// The robot, its segments, joints, colliders, pairs and actuators.
pub(crate) mod description;
/// Shapes that views draw: visuals, and colliders without a visual.
mod drawn;
/// Impedance of contacts and stops over their depth.
mod impedance;
/// Joints and their laws.
pub(crate) mod joint;
/// Joints that are held for good.
mod locked;
/// Mass, center of mass and inertia of solid bodies: computed, moved, joined.
pub(crate) mod mass_properties;
/// Pairs of colliders that may touch.
mod pairs;
/// The forms of colliders.
pub(crate) mod shape;
/// Bodies that slide in a plane, and the ground below them.
mod sliding;
/// Errors of a description, and their search.
pub(crate) mod validation;
/// A shape that is drawn.
pub(crate) mod visual;

pub use description::{Actuator, Collider, Ground, Offsets, Pair, Robot, Segment, SoftContact, Surface};
pub use impedance::Impedance;
pub use joint::{Joint, JointKind, Stop};
pub use mass_properties::MassProperties;
pub use shape::Shape;
pub use validation::{PairFault, RobotError};
pub use visual::Visual;
