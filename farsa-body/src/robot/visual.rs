//! Shapes that views draw instead of colliders.

use crate::ports::BodyId;
use crate::pose::Pose;
use crate::robot::shape::Shape;

/// A shape that is drawn, fixed to a segment or to the world. Nothing touches it, and no sensor sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Visual {
    /// The segment it moves with, or `None` for the world.
    pub body: Option<BodyId>,
    /// Its form.
    pub shape: Shape,
    /// Its frame in the segment's frame.
    pub placement: Pose<f64>,
    /// Its color, red, green and blue [0..1]. Without one views choose it.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub color: Option<[f64; 3]>,
}

impl Visual {
    /// A shape on `body` (`None` for the world) at `placement` in its frame.
    pub fn new(body: Option<BodyId>, shape: Shape, placement: Pose<f64>) -> Self {
        Self { body, shape, placement, color: None }
    }

    /// Returns the shape in a color, red, green and blue [0..1].
    #[must_use]
    pub fn with_color(self, color: [f64; 3]) -> Self {
        Self { color: Some(color), ..self }
    }
}
