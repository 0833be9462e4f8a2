//! Shapes in space.
//!
//! - `vector`: three numbers, and what is computed with them
//! - `geometry`: spheres, capsules, boxes and others, how rays meet them and what outlines them
//! - `appearance`: a geometry in its place, with role and colour
//! - `scene_object`: a shape that no robot's description holds

pub(crate) mod appearance;
pub(crate) mod geometry;
pub(crate) mod scene_object;
pub(crate) mod vector;

pub use appearance::{Color, Instance, OKABE_ITO, Role};
pub use geometry::Geometry;
pub use scene_object::{SceneObject, ShownWhile, screen_color};
