//! Networks through which a cost can be propagated back.

use alloc::vec::Vec;

use farsa_num::Real;

use crate::error::Error;
use crate::learning::loss::Loss;
use crate::network::Model;

/// An example from which a network learns. It contains sensor values and target motor values for each tick, and the
/// network starts at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demonstration<'a> {
    /// Sensor values `[ticks x sensors]`.
    pub x: &'a [f32],
    /// Target motor values `[ticks x outputs]`, in [0, 1].
    pub wanted: &'a [f32],
}

impl Demonstration<'_> {
    /// Counts the ticks. Either number of channels may be 0, but not both.
    pub(crate) fn ticks(&self, sensors: usize, outputs: usize) -> usize {
        self.wanted.len().checked_div(outputs).or(self.x.len().checked_div(sensors)).unwrap_or(0)
    }
}

/// Values that a parameter may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// Any number, within the limit of a learner.
    Any,
    /// From 0 to 1, for leaks.
    Share,
    /// At least a thousandth of a second, for time constants.
    Positive,
}

/// A kind of network that learns by back-propagation through time.
pub trait Differentiable: Model + Clone {
    /// Returns the number of parameters.
    fn parameter_count(&self) -> usize;

    /// Checks that the network has this loss.
    ///
    /// # Errors
    /// Returns [`Error::Layout`].
    fn check(&self, loss: Loss) -> Result<(), Error>;

    /// Returns the domain of a parameter.
    fn domain(&self, index: usize) -> Domain;

    /// Runs the network over a demonstration of the right size, stores its trace and returns the cost.
    fn run<R: Real>(&self, loss: Loss, parameters: &[R], of: Demonstration<'_>, trace: &mut Vec<R>) -> R;

    /// Adds the gradient of a demonstration to `sum`, from the trace of its run.
    fn follow_back<R: Real>(&self, loss: Loss, parameters: &[R], of: Demonstration<'_>, trace: &[R], sum: &mut [R]);
}
