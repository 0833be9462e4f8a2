//! Back-propagation through time.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Real;

use crate::error::Error;
use crate::fault::Slice;
use crate::leak::Leak;
use crate::leaky_layout::LeakyLayout;
use crate::leaky_network::LeakyModel;
use crate::learning::differentiable::{Demonstration, Differentiable};
use crate::learning::loss::Loss;
use crate::network::Network;

/// The gradient of the cost with respect to the parameters of a network, summed over demonstrations.
///
/// The network is run over each demonstration, starting at rest. Then the cost is propagated back through all ticks.
/// Demonstrations with a single tick are examples for a network without memory. In this case recurrent weights have no
/// effect, and with leaks of 1 ([`Leak::Filter`]) the algorithm is plain back-propagation.
///
/// The kind `M` is that of a [`LeakyNetwork`](crate::LeakyNetwork) by default. A [`Perceptron`](crate::Perceptron), a
/// [`Ctrnn`](crate::Ctrnn) and a [`BlockNetwork`](crate::block::BlockNetwork) have gradients, too ([`of`](Self::of)).
///
/// For learning, `f64` is recommended, although `f32` needs only half the memory. Since all sums have a fixed order,
/// the results are identical on every machine.
///
/// Source: `[Rumelhart1986]` for back-propagation, `[Werbos1990]` through time. The equations are those of the
/// networks, with the derivative of leaks and time constants. Deviation: inputs of a CTRNN are not clamped.
///
/// ```
/// use farsa_nn::learning::{Demonstration, Gradient, Loss};
/// use farsa_nn::{Leak, LeakyLayout};
///
/// const LAYOUT: LeakyLayout = LeakyLayout::new(1, 1, 1);
/// let mut gradient = Gradient::<f64>::new(LAYOUT, Leak::Filter, Loss::SquaredError)?;
/// let parameters = [1.0, 0.0, 0.0, 0.0, 1.0];
/// // The output is 0.5, its target 1: larger weights of the output help.
/// let cost = gradient.add(&parameters, Demonstration { x: &[0.0], wanted: &[1.0] })?;
/// assert_eq!(cost, 0.25);
/// // 2 * (0.5 - 1) * 0.2 * 0.5 * (1 - 0.5) * H with H = 0.5.
/// assert!((gradient.sum()[2] + 0.025).abs() < 1e-8);
/// # Ok::<(), farsa_nn::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Gradient<R, M = LeakyModel> {
    model: M,
    loss: Loss,
    sum: Vec<R>,
    cost: R,
    /// Ticks since the sum was cleared.
    ticks: usize,
    /// Values of the last run, as its model stores them.
    trace: Vec<R>,
}

impl<R: Real> Gradient<R> {
    /// Creates a gradient of a [`LeakyNetwork`](crate::LeakyNetwork) without any demonstrations.
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if the slope is invalid.
    pub fn new(layout: LeakyLayout, leak: Leak, loss: Loss) -> Result<Self, Error> {
        Self::of_model(LeakyModel { layout, leak }, loss)
    }
}

impl<R: Real, M: Differentiable> Gradient<R, M> {
    /// Creates a gradient of a network without any demonstrations.
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if the outputs of the network do not fit the loss.
    pub fn of<P, S>(network: &Network<M, P, S>, loss: Loss) -> Result<Self, Error> {
        Self::of_model(network.model.clone(), loss)
    }

    pub(crate) fn of_model(model: M, loss: Loss) -> Result<Self, Error> {
        model.check(loss)?;
        let sum = vec![R::default(); model.parameter_count()];
        Ok(Self { model, loss, sum, cost: R::default(), ticks: 0, trace: Vec::new() })
    }

    /// Gets the kind of network.
    pub(crate) fn model(&self) -> &M {
        &self.model
    }

    /// Gets the sum of the gradients since the last call of [`clear`](Self::clear). It has one element per
    /// parameter.
    pub fn sum(&self) -> &[R] {
        &self.sum
    }

    /// Returns a mutable reference to the sum. It can be used to compute the mean, to freeze parameters or to clip the
    /// gradient.
    pub fn sum_mut(&mut self) -> &mut [R] {
        &mut self.sum
    }

    /// Returns the mean cost per motor value since the last call of [`clear`](Self::clear).
    pub fn mean_cost(&self) -> R {
        let values = self.ticks.saturating_mul(self.model.outputs());
        if values == 0 { R::default() } else { self.cost / R::from_f64(values as f64) }
    }

    /// Gets the number of ticks since the last call of [`clear`](Self::clear).
    pub fn ticks(&self) -> usize {
        self.ticks
    }

    /// Removes all demonstrations.
    pub fn clear(&mut self) {
        self.sum.fill(R::default());
        (self.cost, self.ticks) = (R::default(), 0);
    }

    /// Computes the cost of a demonstration, summed over its ticks and motor values. The gradient is not
    /// changed.
    ///
    /// # Errors
    /// Returns [`Error::Length`] or [`Error::Demonstration`].
    pub fn cost(&mut self, parameters: &[R], demonstration: Demonstration<'_>) -> Result<R, Error> {
        self.check(parameters, demonstration)?;
        Ok(self.model.run(self.loss, parameters, demonstration, &mut self.trace))
    }

    /// Adds the gradient of a demonstration and returns its cost. The cost is the sum over ticks and motor values.
    ///
    /// # Errors
    /// Returns [`Error::Length`] or [`Error::Demonstration`]. In this case nothing is added.
    pub fn add(&mut self, parameters: &[R], demonstration: Demonstration<'_>) -> Result<R, Error> {
        let ticks = self.check(parameters, demonstration)?;
        let cost = self.model.run(self.loss, parameters, demonstration, &mut self.trace);
        self.model.follow_back(self.loss, parameters, demonstration, &self.trace, &mut self.sum);
        self.cost += cost;
        self.ticks += ticks;
        Ok(cost)
    }

    /// Checks a demonstration and returns its number of ticks.
    fn check(&self, parameters: &[R], of: Demonstration<'_>) -> Result<usize, Error> {
        Slice::Parameters.check(self.model.parameter_count(), parameters.len())?;
        let (sensors, outputs) = (self.model.inputs(), self.model.outputs());
        let (Demonstration { x, wanted }, ticks) = (of, of.ticks(sensors, outputs));
        if x.len() == ticks * sensors && wanted.len() == ticks * outputs {
            return Ok(ticks);
        }
        Err(Error::Demonstration { values: x.len(), sensors, wanted: wanted.len(), outputs })
    }
}
