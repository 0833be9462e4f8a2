//! Infrared sensors of mobile robots.
//!
//! | sensor | what a reading is | hidden things | needs |
//! |---|---|---|---|
//! | [`InfraredRays`] | how near the nearest hit of a few rays is | are not seen | `Rays`: any world |
//! | [`InfraredGroups`] | the largest of such readings in a group of neighbors | are not seen | `Rays`, `Sight` |
//! | [`InfraredFormula`] | a formula of distance, bearing and radius, [`InfraredModel`] | are felt, too | `Sight` |
//! | [`SampledInfrared`] | the readings of a real robot's sensors, from [`InfraredTables`] | are felt, too | `Sight`, measured tables |
//!
//! Use rays in custom worlds and if walls should hide each other. The formula is the fastest model, and tables
//! reproduce the measurements of a real robot.

/// Channels as rays to be drawn.
#[cfg(feature = "alloc")]
pub(crate) mod drawn;
/// The ring that answers by the formula.
pub(crate) mod formula;
/// The ring that casts rays, in groups.
#[cfg(feature = "alloc")]
pub(crate) mod groups;
/// The formula: how strongly a sensor answers one surface.
pub(crate) mod model;
/// The ring that casts rays.
pub(crate) mod rays;
/// The ring that looks its readings up in tables.
#[cfg(feature = "alloc")]
pub(crate) mod sampled;
/// Tables of readings by distance and angle, and their file format.
#[cfg(feature = "alloc")]
pub(crate) mod table;

#[cfg(feature = "alloc")]
pub use drawn::InfraredDrawing;
pub use formula::InfraredFormula;
#[cfg(feature = "alloc")]
pub use groups::InfraredGroups;
pub use model::InfraredModel;
pub use rays::InfraredRays;
#[cfg(feature = "alloc")]
pub use sampled::{InfraredTables, SampledInfrared};
#[cfg(feature = "alloc")]
pub use table::{InfraredTable, InfraredTableError};
