//! What a network is between.

/// The names of what is sensed and of what is driven, channel by channel and part by part.
#[derive(Clone, Copy)]
pub(crate) struct Ends<'n> {
    pub(crate) inputs: &'n [String],
    pub(crate) outputs: &'n [String],
    /// Names of sensors, with the first channel of each and the one after the last.
    pub(crate) sensors: &'n [(String, [usize; 2])],
    /// Names of motors, likewise.
    pub(crate) motors: &'n [(String, [usize; 2])],
    /// Names of sensors and motors that are switched off.
    pub(crate) absent: &'n [String],
}
