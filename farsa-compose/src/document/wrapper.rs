//! Wrappers of sensors and motors.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// A change of values on their way from a sensor or to a motor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Wrapper {
    /// Adds to each value a number drawn uniformly between minus and plus this.
    UniformNoise {
        /// Largest added value.
        #[schemars(range(min = 0.0, max = 1e6))]
        amplitude: f64,
    },
    /// Adds to each value a number drawn from a normal distribution.
    NormalNoise {
        /// Its standard deviation.
        #[schemars(range(min = 0.0, max = 1e6))]
        deviation: f64,
    },
    /// Delays values.
    Delay {
        /// Delay [steps].
        #[schemars(range(min = 0, max = 10000))]
        steps: u32,
    },
    /// Multiplies by a number and adds another.
    Scale {
        /// The factor.
        #[schemars(range(min = -1e6, max = 1e6))]
        gain: f64,
        /// Added number.
        #[serde(default)]
        #[schemars(range(min = -1e6, max = 1e6))]
        offset: f64,
    },
    /// Clamps values.
    Saturate {
        /// Lower limit.
        #[schemars(range(min = -1e6, max = 1e6))]
        low: f64,
        /// Upper limit.
        #[schemars(range(min = -1e6, max = 1e6))]
        high: f64,
    },
    /// Passes on 1 for values above a number, and 0 for others.
    Threshold {
        /// The number.
        #[schemars(range(min = -1e6, max = 1e6))]
        above: f64,
    },
    /// Passes on 0 for some channels.
    Lesion {
        /// First and last channel, from 0, by default all.
        #[schemars(inner(range(min = 0, max = 65535)))]
        channels: Option<[u32; 2]>,
    },
    /// Holds some channels at a value after some steps.
    Stuck {
        /// First and last channel, from 0, by default all.
        #[schemars(inner(range(min = 0, max = 65535)))]
        channels: Option<[u32; 2]>,
        /// The held value, by default the last one.
        #[schemars(range(min = -1e6, max = 1e6))]
        value: Option<f64>,
        /// Number of steps before.
        #[serde(default)]
        #[schemars(range(min = 0, max = 4_294_967_295_u32))]
        after: u32,
    },
    /// A wrapper of the user's program, with its keys.
    #[serde(untagged)]
    #[schemars(skip)]
    Registered {
        /// Registered name.
        kind: String,
        /// Keys.
        #[serde(flatten)]
        keys: Map<String, Value>,
    },
}
