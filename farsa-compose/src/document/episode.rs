//! Start and end of a trial.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use crate::document::registered::Placing;

/// Steps and trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Episode {
    /// Most steps of a trial.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub steps: u32,
    /// Trials of an evaluation, each with its own start.
    #[schemars(range(min = 1, max = 100_000))]
    pub trials: u32,
    /// Events that end a trial before its last step.
    pub ends: Vec<Ending>,
}

impl Default for Episode {
    fn default() -> Self {
        Self { steps: 500, trials: 5, ends: Vec::new() }
    }
}

/// Name of a registered end.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Ending(pub String);

impl JsonSchema for Ending {
    fn schema_name() -> Cow<'static, str> {
        "Ending".into()
    }

    /// The registry adds the names.
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "description": "An event that ends a trial.", "oneOf": [] })
    }
}

/// A placement at the start of a trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Start {
    /// Name of a thing, a joint or a group of robots. `robot` places all robots in turn, and `robot-1` or `robot-2` a
    /// single one.
    pub place: String,
    /// The kind of placement.
    #[serde(flatten)]
    pub how: Placing,
}
