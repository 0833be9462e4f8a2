//! Walls.

use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::{Object, Shape};
use crate::part::ThingPart;
use crate::things::{grey, height};

/// A fixed box.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Wall {
    /// Length and thickness [m].
    #[schemars(inner(range(min = 0.0001, max = 1000.0)))]
    size: [f64; 2],
    /// Height [m].
    #[serde(default = "height")]
    #[schemars(range(min = 0.0001, max = 100.0))]
    height: f64,
    /// Red, green and blue.
    #[serde(default = "grey")]
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    color: [f64; 3],
}

impl ThingPart for Wall {
    fn things(&self, object: &Object) -> Result<Vec<Object>, Error> {
        let Self { size, height, color } = *self;
        Ok(vec![Object { shape: Some(Shape::Wall { size, height, color }), ..object.clone() }])
    }
}
