//! A conformance kit for custom worlds, sensors and motors. Each check returns the first promise violated.
//!
//! | you wrote | check it with |
//! |---|---|
//! | a world that steps | [`check_world`] |
//! | a world that can be set up again | [`check_arrange`] |
//! | a world whose bodies can be pushed | [`check_external_forces`] |
//! | a world that casts rays | [`check_rays`] |
//! | a world with cameras in a plane | [`check_sight`] |
//! | a world of the plane | [`check_planar`] |
//! | a sensor or a motor | [`check_sensor`], [`check_motor`], in a [`PointWorld`] or a [`PlaneWorld`] |
//!
//! ```
//! use farsa_body::testing::{PointWorld, Probe, check_world};
//!
//! let probe = Probe::numbered(3, [[-20.0, 0.0], [20.0, 0.0]]);
//! assert_eq!(check_world(|| PointWorld::new(3), &probe), Ok(()));
//! ```

/// The checks, a file for each part of the promises.
mod checks;
/// A small world of the plane with every port of mobile robots.
mod plane_world;
/// A small world with every other port.
mod point_world;
/// Which parts of a world the kit looks at and moves.
mod probe;
/// The promises, and the error that names a broken one.
mod promise;
/// Runs of a world as bits, and their comparison.
mod trace;

pub use checks::{
    check_arrange, check_external_forces, check_motor, check_planar, check_rays, check_sensor, check_sight,
    check_vision, check_world,
};
pub use plane_world::PlaneWorld;
pub use point_world::PointWorld;
pub use probe::Probe;
pub use promise::{ConformanceError, Promise};
