//! Balls.

use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::{Object, Shape};
use crate::part::ThingPart;
use crate::things::{grey, half};

/// A movable ball, for experiments with joints.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Ball {
    /// Radius [m].
    #[schemars(range(min = 0.0001, max = 100.0))]
    radius: f64,
    /// Mass [kg].
    #[schemars(range(min = 0.0001, max = 10000.0))]
    mass: f64,
    /// Coefficient of friction with the floor and with other things.
    #[serde(default = "half")]
    #[schemars(range(min = 0.0, max = 10.0))]
    friction: f64,
    /// Red, green and blue.
    #[serde(default = "grey")]
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    color: [f64; 3],
}

impl ThingPart for Ball {
    fn things(&self, object: &Object) -> Result<Vec<Object>, Error> {
        let Self { radius, mass, friction, color } = *self;
        Ok(vec![Object { shape: Some(Shape::Ball { radius, mass, friction, color }), ..object.clone() }])
    }
}
