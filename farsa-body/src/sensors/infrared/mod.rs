//! Infrared rings of mobile robots. Which one do I need?
//!
//! | sensor | what a reading is | hidden things | needs |
//! |---|---|---|---|
//! | [`InfraredRays`] | how near the nearest hit of a few rays is | are not seen | `Rays`: any world |
//! | [`InfraredAnalytic`] | a formula of distance, bearing and radius, [`AnalyticInfrared`] | are felt, too | `Planar` |
//! | [`SampledInfrared`] | what a real robot's sensors read, from [`InfraredTables`] | are felt, too | `Planar`, measured tables |
//!
//! Take rays for a world of your own or walls that hide each other, the formula for speed, tables to come nearest to a
//! robot that was measured.

/// The ring that answers by the formula.
pub(crate) mod analytic;
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

pub use analytic::InfraredAnalytic;
pub use model::AnalyticInfrared;
pub use rays::InfraredRays;
#[cfg(feature = "alloc")]
pub use sampled::{InfraredTables, SampledInfrared};
#[cfg(feature = "alloc")]
pub use table::{InfraredTable, InfraredTableError};
