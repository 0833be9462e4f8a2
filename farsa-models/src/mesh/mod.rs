//! Meshes, and the shapes that stand for them.

/// Principal moments and axes of an inertia, and rotations from axes.
pub(crate) mod principal_axes;
/// Solids that a file can name, the shapes that stand for them, and their masses.
pub(crate) mod solid;
/// Triangles from STL and OBJ, and what fits around them.
pub(crate) mod triangles;
