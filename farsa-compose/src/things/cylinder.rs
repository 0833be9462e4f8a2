//! Cylinders.

use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::{Object, Shape};
use crate::part::ThingPart;
use crate::things::{grey, height};

/// An upright cylinder, optionally a lamp.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Cylinder {
    /// Radius [m].
    #[schemars(range(min = 0.0001, max = 100.0))]
    radius: f64,
    /// Height [m].
    #[serde(default = "height")]
    #[schemars(range(min = 0.0001, max = 100.0))]
    height: f64,
    /// Red, green and blue.
    #[serde(default = "grey")]
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    color: [f64; 3],
    /// Light intensity. 0 is no lamp.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    lamp: f64,
}

impl ThingPart for Cylinder {
    fn things(&self, object: &Object) -> Result<Vec<Object>, Error> {
        let Self { radius, height, color, lamp } = *self;
        Ok(vec![Object { shape: Some(Shape::Cylinder { radius, height, color, lamp }), ..object.clone() }])
    }
}
