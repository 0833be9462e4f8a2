//! The forms of colliders.

/// The form of a collider, in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Shape {
    /// A ball about the origin.
    Sphere {
        /// Radius [m].
        radius: f64,
    },
    /// All points within `radius` of the piece of the z axis from `-half_length` to `half_length`.
    Capsule {
        /// Radius [m].
        radius: f64,
        /// Half the length of the axis [m].
        half_length: f64,
    },
    /// A box about the origin.
    Box {
        /// Half the edge lengths along x, y, z [m].
        half: [f64; 3],
    },
    /// The half space z <= 0.
    Plane,
}
