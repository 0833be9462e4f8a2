//! Meshes, and the shapes that replace them.

/// Principal moments and axes of an inertia, and rotations from axes.
pub(crate) mod principal_axes;
/// Solids of a file, the shapes that replace them, and their masses.
pub(crate) mod solid;
/// Triangles from STL and OBJ, and what fits around them.
pub(crate) mod triangles;
