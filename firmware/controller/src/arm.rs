//! The experiment's arm of seven joints.

use crate::{Chain, ChainLink};

/// The arm of `farsa_body::robots::ArmAndHand` without its fingers.
// A test compares every number with the description.
pub const ARM: Chain<7> = Chain {
    links: [
        link([0.0, 0.0, 1.0], [-0.025, -0.108, 0.21], 0.19, 0.0, [4.75e-5; 3]),
        link([0.0, -1.0, 0.0], [0.0; 3], 0.18, 0.0, [4.5e-5; 3]),
        link([-1.0, 0.0, 0.0], [0.0; 3], 0.884, 0.076, [0.0002663129, 0.002693818, 0.002693818]),
        link([0.0, 0.0, -1.0], [0.152, 0.0, 0.0], 0.074, 0.0, [1.184e-5; 3]),
        link([1.0, 0.0, 0.0], [0.0; 3], 0.525, 0.065, [0.0001014255, 0.001136066, 0.001136066]),
        link([0.0, 1.0, 0.0], [0.137, 0.0, 0.0], 0.036, 0.0, [5.76e-6; 3]),
        link([0.0, 0.0, 1.0], [0.0; 3], 0.15, 0.05, [5.305e-05, 5e-05, 9.305e-05]),
    ],
    gravity: [0.0, 0.0, -9.81],
};

/// The center of mass is on the x axis of the link.
const fn link(axis: [f32; 3], offset: [f32; 3], mass: f32, along: f32, inertia: [f32; 3]) -> ChainLink {
    ChainLink { axis, offset, mass, centre: [along, 0.0, 0.0], inertia, armature: 0.01 }
}
