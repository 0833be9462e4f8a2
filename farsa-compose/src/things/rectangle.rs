//! Rectangles.

use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::{Object, Shape};
use crate::part::ThingPart;

/// A rectangle of the ground with its own color.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Rectangle {
    /// Length along the heading, and breadth [m].
    #[schemars(inner(range(min = 0.0001, max = 1000.0)))]
    size: [f64; 2],
    /// Red, green and blue.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    color: [f64; 3],
}

impl ThingPart for Rectangle {
    fn things(&self, object: &Object) -> Result<Vec<Object>, Error> {
        let Self { size, color } = *self;
        Ok(vec![Object { shape: Some(Shape::Rectangle { size, color }), ..object.clone() }])
    }
}
