// The example of the README needs `alloc`.
#![cfg_attr(feature = "alloc", doc = include_str!("../README.md"))]
#![cfg_attr(not(feature = "alloc"), doc = "FARSA without a heap: see the feature `alloc`.")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![no_std]

/// Bodies as data, actuators, sensors, motors and the ports of worlds.
pub use farsa_body as body;
/// Evolution by ask and tell.
#[cfg(feature = "alloc")]
pub use farsa_evo as evo;
/// Robots from URDF and MJCF files, and back. Needs std.
#[cfg(feature = "models")]
pub use farsa_models as models;
/// Recurrent networks over borrowed parameters.
pub use farsa_nn as nn;
/// Scalars, SIMD lanes, functions and random streams with the same bits everywhere.
pub use farsa_num as num;
/// Worlds: articulated bodies with contacts.
pub use farsa_physics as physics;

pub mod prelude;
