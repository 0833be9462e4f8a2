//! Discs.

use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::{Object, Shape};
use crate::part::ThingPart;

/// A disc of the ground with its own color.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Disc {
    /// Radius [m].
    #[schemars(range(min = 0.0001, max = 1000.0))]
    radius: f64,
    /// Red, green and blue.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    color: [f64; 3],
}

impl ThingPart for Disc {
    fn things(&self, object: &Object) -> Result<Vec<Object>, Error> {
        let Self { radius, color } = *self;
        Ok(vec![Object { shape: Some(Shape::Disc { radius, color }), ..object.clone() }])
    }
}
