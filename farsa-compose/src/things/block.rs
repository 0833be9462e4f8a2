//! Blocks.

use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::{Object, Shape};
use crate::part::ThingPart;
use crate::things::{grey, half};

/// A movable box, not in the engine `arena`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Block {
    /// Length, breadth and height [m].
    #[schemars(inner(range(min = 0.001, max = 100.0)))]
    size: [f64; 3],
    /// Mass [kg].
    #[schemars(range(min = 0.0001, max = 10000.0))]
    mass: f64,
    /// Coefficient of friction with the ground and with smoother things.
    #[serde(default = "half")]
    #[schemars(range(min = 0.0, max = 10.0))]
    friction: f64,
    /// Red, green and blue.
    #[serde(default = "grey")]
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    color: [f64; 3],
}

impl ThingPart for Block {
    fn things(&self, object: &Object) -> Result<Vec<Object>, Error> {
        let Self { size, mass, friction, color } = *self;
        Ok(vec![Object { shape: Some(Shape::Block { size, mass, friction, color }), ..object.clone() }])
    }
}
