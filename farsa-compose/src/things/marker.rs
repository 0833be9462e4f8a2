//! Markers.

use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::{Object, Shape};
use crate::part::ThingPart;
use crate::things::grey;

/// A visible place without contacts, for experiments with joints.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Marker {
    /// Radius of the drawn ball [m].
    #[serde(default = "small")]
    #[schemars(range(min = 0.0001, max = 100.0))]
    radius: f64,
    /// Red, green and blue.
    #[serde(default = "grey")]
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    color: [f64; 3],
}

fn small() -> f64 {
    0.02
}

impl ThingPart for Marker {
    fn things(&self, object: &Object) -> Result<Vec<Object>, Error> {
        let Self { radius, color } = *self;
        Ok(vec![Object { shape: Some(Shape::Marker { radius, color }), ..object.clone() }])
    }
}
