//! Shapes in space.
//!
//! - `vector`: three numbers, and what is computed with them
//! - `form`: spheres, capsules, boxes and others, how rays meet them and what outlines them
//! - `appearance`: a form in its place, with role and colour
//! - `prop`: a shape that no robot's description holds

pub(crate) mod appearance;
pub(crate) mod form;
pub(crate) mod prop;
pub(crate) mod vector;

pub use appearance::{Color, OKABE_ITO, Placed, Role};
pub use form::Form;
pub use prop::{Prop, screen_color};
