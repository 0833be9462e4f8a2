//! Meshes, and the shapes that replace them.

/// Primitives that MuJoCo fits to a mesh.
pub(crate) mod fitted;
/// Convex hulls of points.
pub(crate) mod hull;
/// Masses of meshes by MuJoCo's rules.
pub(crate) mod mass;
/// Triangles of polygons.
pub(crate) mod polygon;
/// Principal moments and axes of an inertia, and rotations from axes.
pub(crate) mod principal_axes;
/// Meshes with fewer triangles for drawing.
pub(crate) mod simplified;
/// Solids of a file, the shapes that replace them, and their masses.
pub(crate) mod solid;
/// Triangles of primitives.
pub(crate) mod tessellated;
/// Triangles from STL and OBJ, and what fits around them.
pub(crate) mod triangles;
