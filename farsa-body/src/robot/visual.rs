//! Shapes drawn instead of colliders.

use crate::ports::BodyId;
use crate::pose::Pose;
use crate::robot::shape::Shape;

/// A shape drawn at a segment or in the world. It has no contacts and is invisible for sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Visual {
    /// Segment to which the shape is attached, or `None` for the world.
    pub body: Option<BodyId>,
    /// Shape that is drawn.
    pub shape: Shape,
    /// Pose of the shape in the frame of the segment.
    pub placement: Pose<f64>,
    /// Red, green and blue components of the color (between 0 and 1). For `None`, views use a default color.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub color: Option<[f64; 3]>,
}

impl Visual {
    /// Creates a visual at the given pose in the frame of `body`, or in the world for `None`.
    pub fn new(body: Option<BodyId>, shape: Shape, placement: Pose<f64>) -> Self {
        Self { body, shape, placement, color: None }
    }

    /// Sets the color, with red, green and blue in [0..1].
    #[must_use]
    pub fn with_color(self, color: [f64; 3]) -> Self {
        Self { color: Some(color), ..self }
    }
}
