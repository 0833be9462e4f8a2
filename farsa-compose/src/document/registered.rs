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
registered!(RewardKind, kind, "A kind of term. Terms of several robots are their mean.");

impl RewardKind {
    /// Takes the name of the measured body, if any.
    pub(crate) fn take_body(&mut self) -> Option<String> {
        if let Some(Value::String(body)) = self.keys.get_mut("body").map(Value::take) {
            return Some(body);
        }
        match self.keys.get_mut("bodies").and_then(Value::as_array_mut) {
            Some(bodies) if bodies.len() == 1 => bodies.pop().and_then(|body| body.as_str().map(str::to_owned)),
            _ => None,
        }
    }

    /// Returns the contact of a body for a collision with a thing.
    pub(crate) fn as_touch_of(&self, body: &str) -> Option<Self> {
        let (thing, within) = (self.keys.get("object")?, self.keys.get("within")?);
        if self.kind != "contact" || within.as_f64() != Some(0.0) {
            return None;
        }
        let keys = [("bodies".to_owned(), Value::from(vec![body])), ("with".to_owned(), thing.clone())];
        Some(Self { kind: "touch".into(), keys: keys.into_iter().collect() })
    }
}
