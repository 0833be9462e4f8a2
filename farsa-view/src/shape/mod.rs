//! Shapes of pictures and pages: geometry, role and color.

/// Role, color and place of shapes.
pub(crate) mod appearance;
/// Spheres, capsules, boxes and others, with their rays and outlines.
pub(crate) mod geometry;
/// Triangle meshes of pages.
pub(crate) mod scene_mesh;
/// Shapes that no robot contains.
pub(crate) mod scene_object;
/// Vectors of three numbers.
pub(crate) mod vector;

pub use appearance::{Color, Instance, OKABE_ITO, Role};
pub use geometry::Geometry;
pub use scene_mesh::SceneMesh;
pub use scene_object::{SceneObject, ShownWhile, screen_color};
