//! A single layer of logistic units. This is sufficient for reflexes.

use crate::error::Error;
use crate::fault::LayoutFault;
use crate::kernel::Layer;
use crate::lesion::{Lesion, hold};
use crate::network::{Data, Model, Network, check_parameters};

/// A layer of logistic units without memory. The outputs are `O_i = sigma( beta_i + sum_j w_ji I_j )` with `sigma(x) =
/// 1/(1 + exp(-slope*x))`.
///
/// As in a [`LeakyLayout`](crate::LeakyLayout), the parameters are ordered by source. The weight `w_ji` has the index
/// `j*outputs + i`, and the biases `beta_i` follow after all weights. Sums start with the bias, and the inputs are
/// added in their order.
///
/// Such a layer is sufficient for wall following, phototaxis and the discrimination of cylinders by a wheeled robot.
/// For lesions, the neurons are the outputs.
///
/// ```
/// use farsa_nn::{Controller, Perceptron};
///
/// // Light on the left drives the right wheel, and the reverse: aggression.
/// let mut vehicle = Perceptron::new(2, 2, 1.0, [0.0, 4.0, 4.0, 0.0, -2.0, -2.0])?;
/// let mut wheels = [0.0; 2];
/// vehicle.step(&[1.0, 0.5], &mut wheels);
/// assert_eq!(wheels[0], 0.5);
/// assert!(wheels[1] > 0.8);
/// # Ok::<(), farsa_nn::Error>(())
/// ```
pub type Perceptron<P> = Network<PerceptronModel, P, [f32; 0]>;

/// The shape of a [`Perceptron`], together with its slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerceptronModel {
    pub(crate) inputs: usize,
    pub(crate) outputs: usize,
    pub(crate) slope: f32,
}

impl Perceptron<()> {
    /// Returns the number of parameters. This is `inputs*outputs + outputs`. The count saturates.
    ///
    /// ```
    /// assert_eq!(farsa_nn::Perceptron::parameter_count(6, 2), 14);
    /// ```
    pub const fn parameter_count(inputs: usize, outputs: usize) -> usize {
        inputs.saturating_mul(outputs).saturating_add(outputs)
    }
}

impl<P: AsRef<[f32]>> Perceptron<P> {
    /// Creates a layer with the given parameters. Their number must be
    /// [`parameter_count`](Perceptron::parameter_count).
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if the slope is invalid, [`Error::Length`] or [`Error::Parameter`].
    pub fn new(inputs: usize, outputs: usize, slope: f32, parameters: P) -> Result<Self, Error> {
        Self::at_rest(PerceptronModel { inputs, outputs, slope }, parameters, [])
    }
}

impl<P> Perceptron<P> {
    /// Gets the slope of the logistic function.
    pub const fn slope(&self) -> f32 {
        self.model.slope
    }
}

impl Model for PerceptronModel {
    fn inputs(&self) -> usize {
        self.inputs
    }

    fn outputs(&self) -> usize {
        self.outputs
    }

    fn neurons(&self) -> usize {
        self.outputs
    }

    fn state_len(&self) -> usize {
        0
    }

    fn check_model<T: Copy>(&self, parameters: &[T], value: impl Fn(T) -> f32 + Copy) -> Result<(), Error> {
        LayoutFault::check_slope(self.slope)?;
        let count = Perceptron::parameter_count(self.inputs, self.outputs);
        check_parameters(count, count, parameters, value)
    }

    #[inline]
    fn step(&self, data: Data<'_>, lesions: &[Lesion], x: &[f32], y: &mut [f32]) {
        let Data { parameters, level, .. } = data;
        let (weights, biases) = parameters.split_at((self.inputs * self.outputs).min(parameters.len()));
        let sources = [(x, weights), (&[][..], &[][..])];
        Layer { targets: self.outputs, slope: self.slope, biases, sources }.forward(level, y);
        hold(lesions, 0, y);
    }
}
