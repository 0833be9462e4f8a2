//! A number that evolution finds.

/// A number that evolution sets, such as a weight of a network or the length of a leg.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name of the parameter.
    pub name: String,
    /// Range, from the end of gene 0 to the other. It may fall.
    pub ends: [f64; 2],
}

impl Parameter {
    /// A parameter between two ends.
    pub fn new(name: impl Into<String>, ends: [f64; 2]) -> Self {
        Self { name: name.into(), ends }
    }
}
