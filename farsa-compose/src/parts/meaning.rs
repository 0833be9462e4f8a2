//! What a channel stands for.

use crate::document::Wrapper;

/// A quantity, its unit, its values that are 0 and 1, and whether it is in proportion between.
pub(crate) struct Meaning {
    pub(crate) quantity: String,
    pub(crate) unit: &'static str,
    pub(crate) ends: [f64; 2],
    pub(crate) linear: bool,
}

impl Meaning {
    pub(crate) fn new(quantity: impl Into<String>, unit: &'static str, ends: [f64; 2]) -> Self {
        Self { quantity: quantity.into(), unit, ends, linear: true }
    }

    /// The same with what changes its values on their way.
    pub(crate) fn with_wrappers(self, wrappers: &[Wrapper]) -> Self {
        let words = wrappers.iter().map(|wrapper| match wrapper {
            Wrapper::UniformNoise { .. } | Wrapper::NormalNoise { .. } => "noise",
            Wrapper::Delay { .. } => "a delay",
            Wrapper::Scale { .. } => "a scale",
            Wrapper::Saturate { .. } => "two ends",
            Wrapper::Threshold { .. } => "a threshold",
            Wrapper::Lesion { .. } => "a lesion",
            Wrapper::Stuck { .. } => "a fault",
        });
        let words: Vec<&str> = words.collect();
        if words.is_empty() {
            return self;
        }
        Self { quantity: format!("{}, with {}", self.quantity, words.join(", ")), ..self }
    }
}
