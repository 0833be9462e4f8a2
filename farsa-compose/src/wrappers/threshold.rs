//! Zeros and ones.

use farsa_body::wrappers::Thresholded;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::WrapperPart;
use crate::wrappers::{Around, Values, wrong};

/// Passes on 1 for values above a number, and 0 for others.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Threshold {
    /// The number.
    #[schemars(range(min = -1e6, max = 1e6))]
    above: f64,
}

impl WrapperPart for Threshold {
    type Filter = Around<Thresholded<Values, Vec<f32>>>;

    fn filter(&self, channels: usize) -> Result<Self::Filter, Error> {
        Thresholded::new(Values(channels), self.above as f32).map(Around::new).map_err(wrong)
    }

    fn about(&self) -> Option<String> {
        Some(format!("1 above {} and 0 elsewhere", self.above))
    }
}
