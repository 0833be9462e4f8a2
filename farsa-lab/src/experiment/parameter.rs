//! A number that evolution finds.

/// A number that an experiment wants, such as a weight of a network or the length of a leg.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// What it is called.
    pub name: String,
    /// Its range, from the end that a gene of 0 stands for to the other; it may fall.
    pub ends: [f64; 2],
}

impl Parameter {
    /// A parameter between two ends.
    pub fn new(name: impl Into<String>, ends: [f64; 2]) -> Self {
        Self { name: name.into(), ends }
    }
}
