//! Inputs and outputs between which a network is built.

/// Names of inputs and outputs, and of the sensors and motors that they belong to.
#[derive(Clone, Copy)]
pub(crate) struct Ends<'n> {
    pub(crate) inputs: &'n [String],
    pub(crate) outputs: &'n [String],
    /// Sensors, with the first channel of each and the one after the last.
    pub(crate) sensors: &'n [(String, [usize; 2])],
    /// Motors, with the first channel of each and the one after the last.
    pub(crate) motors: &'n [(String, [usize; 2])],
    /// Disabled sensors and motors.
    pub(crate) absent: &'n [String],
}
