//! Wrappers of sensors and motors.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// A change of values on their way from a sensor or to a motor, which is a registered part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wrapper {
    /// Registered name.
    pub kind: String,
    /// Keys.
    #[serde(flatten)]
    pub keys: Map<String, Value>,
}

impl JsonSchema for Wrapper {
    fn schema_name() -> Cow<'static, str> {
        "Wrapper".into()
    }

    /// The registry adds the kinds.
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A change of values on their way from a sensor or to a motor.",
            "oneOf": [],
        })
    }
}
