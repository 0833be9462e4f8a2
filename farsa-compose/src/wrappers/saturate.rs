//! Limits.

use farsa_body::wrappers::Saturated;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::WrapperPart;
use crate::wrappers::{Around, Values, wrong};

/// Clamps values.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Saturate {
    /// Lower limit.
    #[schemars(range(min = -1e6, max = 1e6))]
    low: f64,
    /// Upper limit.
    #[schemars(range(min = -1e6, max = 1e6))]
    high: f64,
}

impl WrapperPart for Saturate {
    type Filter = Around<Saturated<Values, Vec<f32>>>;

    fn filter(&self, channels: usize) -> Result<Self::Filter, Error> {
        Saturated::new(Values(channels), self.low as f32, self.high as f32).map(Around::new).map_err(wrong)
    }

    fn about(&self) -> Option<String> {
        Some(format!("ends at {} and {}", self.low, self.high))
    }
}
