//! A number that evolution finds.

/// A number that evolution sets, such as a weight of a network or the length of a leg.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name of the parameter.
    pub name: String,
    /// Range of the parameter, where gene 0 is the first end. The second end may be smaller than the first.
    pub ends: [f64; 2],
}

impl Parameter {
    /// Creates a parameter with both ends of its range.
    pub fn new(name: impl Into<String>, ends: [f64; 2]) -> Self {
        Self { name: name.into(), ends }
    }
}
