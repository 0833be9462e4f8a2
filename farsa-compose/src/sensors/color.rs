//! Colors.

use farsa_body::sensors::ColorBand;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::name::NAME;

/// A range of colors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub(super) struct ColorRange {
    /// Name of the color.
    #[schemars(regex(pattern = NAME))]
    pub(super) name: String,
    /// Least red, green and blue.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    low: [f64; 3],
    /// Greatest red, green and blue.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    high: [f64; 3],
}

impl ColorRange {
    /// Rounds the range to single precision.
    pub(super) fn band(&self) -> ColorBand {
        let [low, high] = [self.low, self.high].map(|ends| ends.map(|x| x as f32));
        ColorBand { low, high }
    }
}
