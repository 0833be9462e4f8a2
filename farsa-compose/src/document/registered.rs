//! Registered parts with their keys.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

macro_rules! registered {
    ($name:ident, $tag:ident, $about:literal) => {
        #[doc = $about]
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub struct $name {
            /// Registered name.
            pub $tag: String,
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
registered!(Wrapper, kind, "A change of values on their way from a sensor or to a motor.");
registered!(SensorKind, kind, "A kind of sensor.");
registered!(MotorKind, kind, "A kind of motor.");
registered!(NetworkKind, kind, "A kind of network. Neurons are logistic with slope 1 unless a key changes it.");
registered!(ObjectKind, kind, "A kind of thing.");
registered!(Placing, at, "A kind of placement. The heading of a robot is drawn uniformly after its place.");
