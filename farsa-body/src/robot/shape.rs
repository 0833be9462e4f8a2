//! The shapes of colliders.

/// The shape of a collider in its local frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Shape {
    /// A sphere with its center at the origin.
    Sphere {
        /// Radius of the sphere [m].
        radius: f64,
    },
    /// A capsule that contains all points with a distance of at most `radius` from the part of the z axis between
    /// `-half_length` and `half_length`.
    Capsule {
        /// Radius of the capsule [m].
        radius: f64,
        /// Half the length of its axis [m].
        half_length: f64,
    },
    /// A solid cylinder about the z axis, between `-half_length` and `half_length`. It can touch spheres, capsules and
    /// planes.
    Cylinder {
        /// Radius of the cylinder [m].
        radius: f64,
        /// Half its length [m].
        half_length: f64,
    },
    /// A box with its center at the origin.
    Box {
        /// Half the edge lengths along x, y and z [m].
        half: [f64; 3],
    },
    /// Half space z <= 0.
    Plane,
}
