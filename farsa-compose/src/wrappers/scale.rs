//! Factors.

use farsa_body::wrappers::Scaled;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::WrapperPart;
use crate::wrappers::{Around, Values, wrong};

/// Multiplies by a number and adds another.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Scale {
    /// The factor.
    #[schemars(range(min = -1e6, max = 1e6))]
    gain: f64,
    /// Added number.
    #[serde(default)]
    #[schemars(range(min = -1e6, max = 1e6))]
    offset: f64,
}

impl WrapperPart for Scale {
    type Filter = Around<Scaled<Values, Vec<f32>>>;

    fn filter(&self, channels: usize) -> Result<Self::Filter, Error> {
        Scaled::new(Values(channels), self.gain as f32, self.offset as f32).map(Around::new).map_err(wrong)
    }

    fn about(&self) -> Option<String> {
        let Self { gain, offset } = self;
        Some(if *offset == 0.0 {
            format!("a factor of {gain}")
        } else {
            format!("a factor of {gain} and {offset} added")
        })
    }
}
