//! Registered parts with their keys.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

macro_rules! registered {
    ($name:ident, $about:literal) => {
        #[doc = $about]
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub struct $name {
            /// Registered name.
            pub kind: String,
            /// Keys.
            #[serde(flatten)]
            pub keys: Map<String, Value>,
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            /// The registry adds the kinds.
            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                json_schema!({ "description": $about, "oneOf": [] })
            }
        }
    };
}
registered!(Wrapper, "A change of values on their way from a sensor or to a motor.");
registered!(SensorKind, "A kind of sensor.");
registered!(MotorKind, "A kind of motor.");
