//! A single layer of logistic units, for reflexes.

use farsa_num::Instructions;
use farsa_num::fearless_simd::Level;

use crate::controller::Controller;
use crate::error::Error;
use crate::kernel::{Layer, level};
use crate::lesion::{Ablatable, Lesion, hold};

/// One layer of logistic units without memory: `O_i = sigma( beta_i + sum_j w_ji I_j )`,
/// `sigma(x) = 1/(1 + exp(-slope*x))`.
///
/// The parameters, source-major like those of a [`LeakyLayout`](crate::LeakyLayout): `w_ji` at `j*outputs + i`
/// `[inputs x outputs]`, then `beta_i` `[outputs]`. Sums start at the bias and add the inputs in their order.
///
/// Enough for wall following, phototaxis and the discrimination of cylinders by a wheeled robot.
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
#[derive(Clone, Debug)]
pub struct Perceptron<P> {
    inputs: usize,
    outputs: usize,
    slope: f32,
    parameters: P,
    level: Level,
}

impl Perceptron<()> {
    /// Number of parameters of so many inputs and outputs, `inputs*outputs + outputs`; saturates.
    ///
    /// ```
    /// assert_eq!(farsa_nn::Perceptron::parameter_count(6, 2), 14);
    /// ```
    pub const fn parameter_count(inputs: usize, outputs: usize) -> usize {
        inputs.saturating_mul(outputs).saturating_add(outputs)
    }
}

impl<P: AsRef<[f32]>> Perceptron<P> {
    /// A layer over these parameters [[`parameter_count`](Perceptron::parameter_count)].
    ///
    /// # Errors
    /// [`Error::Slope`], [`Error::ParameterCount`] or [`Error::NotFinite`]: the first that applies.
    pub fn new(inputs: usize, outputs: usize, slope: f32, parameters: P) -> Result<Self, Error> {
        check(inputs, outputs, slope, parameters.as_ref().iter().copied())?;
        Ok(Self { inputs, outputs, slope, parameters, level: level() })
    }

    /// The parameters.
    pub fn parameters(&self) -> &[f32] {
        self.parameters.as_ref()
    }
}

impl<P> Perceptron<P> {
    /// The slope of the logistic function.
    pub const fn slope(&self) -> f32 {
        self.slope
    }

    /// The same layer over these instructions, as
    /// [`LeakyNetwork::with_instructions`](crate::LeakyNetwork::with_instructions).
    pub fn with_instructions(self, instructions: Instructions) -> Self {
        Self { level: instructions.level(), ..self }
    }
}

impl<P: AsRef<[f32]>> Controller for Perceptron<P> {
    fn inputs(&self) -> usize {
        self.inputs
    }

    fn outputs(&self) -> usize {
        self.outputs
    }

    /// Does nothing: there is no memory.
    fn reset(&mut self) {}

    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        debug_assert_eq!(x.len(), self.inputs, "sensor values and the layer's inputs");
        debug_assert_eq!(y.len(), self.outputs, "motor values and the layer's outputs");
        let parameters = self.parameters.as_ref();
        let (weights, biases) = parameters.split_at((self.inputs * self.outputs).min(parameters.len()));
        let sources = [(x, weights), (&[][..], &[][..])];
        Layer { targets: self.outputs, slope: self.slope, biases, sources }.forward(self.level, y);
    }
}

/// The neurons are the outputs.
impl<P: AsRef<[f32]>> Ablatable for Perceptron<P> {
    fn neurons(&self) -> usize {
        self.outputs
    }

    fn step_ablated(&mut self, lesions: &[Lesion], x: &[f32], y: &mut [f32]) {
        self.step(x, y);
        hold(lesions, 0, y);
    }
}

/// Whether these are the numbers of such a layer.
pub(crate) fn check(
    inputs: usize,
    outputs: usize,
    slope: f32,
    mut parameters: impl ExactSizeIterator<Item = f32>,
) -> Result<(), Error> {
    if !slope.is_finite() {
        return Err(Error::Slope { value: slope });
    }
    let (expected, found) = (Perceptron::parameter_count(inputs, outputs), parameters.len());
    if expected != found {
        return Err(Error::ParameterCount { expected, found });
    }
    match parameters.position(|p| !p.is_finite()) {
        Some(index) => Err(Error::NotFinite { index }),
        None => Ok(()),
    }
}
