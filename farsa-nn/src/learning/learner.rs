//! A network that learns from demonstrations.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use farsa_num::Real;

use crate::error::Error;
use crate::fault::{ParameterFault, Slice};
use crate::leak::Leak;
use crate::leaky_layout::LeakyLayout;
use crate::leaky_network::LeakyModel;
use crate::learning::differentiable::{Demonstration, Differentiable, Domain};
use crate::learning::gradient::Gradient;
use crate::learning::loss::Loss;
use crate::learning::optimizer::Optimizer;
use crate::network::Network;

/// Smallest time constant of a learned CTRNN [s].
const LEAST_TIME_CONSTANT: f64 = 1e-3;

/// Trains the parameters of a network with the [`Gradient`] of the cost of demonstrations.
///
/// After each step, leaks are clamped to [0, 1], and time constants to at least a thousandth of a second. The absolute values of weights and biases are limited by
/// [`limit`](Self::with_limit).
///
/// ```
/// use farsa_nn::learning::{Adam, Demonstration, Learner, Loss};
/// use farsa_nn::{Leak, LeakyLayout};
///
/// // One output learns the exclusive or of two inputs, by examples of one tick each.
/// const LAYOUT: LeakyLayout = LeakyLayout::new(2, 4, 1).with_slope(1.0);
/// let start = (0..LAYOUT.parameter_count()).map(|i| (i * 29 % 17) as f64 / 4.0 - 2.0);
/// let start = start.zip(LAYOUT.kinds()).map(|(p, kind)| if kind == farsa_nn::LeakyParameter::Leak { 1.0 } else { p });
/// let mut learner = Learner::new(LAYOUT, Leak::Filter, Loss::CrossEntropy, start.collect(), Adam::new(0.1))?;
/// let examples = [([0.0, 0.0], [0.0]), ([0.0, 1.0], [1.0]), ([1.0, 0.0], [1.0]), ([1.0, 1.0], [0.0])];
/// let all = || examples.iter().map(|(x, wanted)| Demonstration { x, wanted });
/// let first = learner.learn(all())?;
/// for _ in 0..300 {
///     learner.learn(all())?;
/// }
/// assert!(first > 0.1 && learner.learn(all())? < 0.01);
/// # Ok::<(), farsa_nn::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Learner<R, O, M = LeakyModel> {
    gradient: Gradient<R, M>,
    optimizer: O,
    parameters: Vec<R>,
    memory: Vec<R>,
    limit: Option<R>,
    /// Parameters that never change.
    frozen: Range<usize>,
    /// Largest norm of a gradient.
    longest: Option<R>,
    mean: Option<Mean<R>>,
}

/// The mean of parameters over steps.
#[derive(Clone, Debug)]
struct Mean<R> {
    /// Weight of each new step.
    share: R,
    /// Total weight so far (between 0 and 1), followed by the mean \[parameters\].
    state: Vec<R>,
}

impl<R: Real> Mean<R> {
    fn add(&mut self, parameters: &[R]) {
        let Some((begun, mean)) = self.state.split_first_mut() else { return };
        *begun += (R::from_f64(1.0) - *begun) * self.share;
        let share = self.share / *begun;
        for (m, p) in mean.iter_mut().zip(parameters) {
            *m += (*p - *m) * share;
        }
    }
}

impl<R: Real, O: Optimizer<R>> Learner<R, O> {
    /// Creates a learner of a [`LeakyNetwork`](crate::LeakyNetwork) that starts with the given parameters. Their number
    /// must be [`parameter_count`](LeakyLayout::parameter_count).
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if the slope is invalid, [`Error::Length`] or [`Error::Parameter`].
    pub fn new(layout: LeakyLayout, leak: Leak, loss: Loss, parameters: Vec<R>, optimizer: O) -> Result<Self, Error> {
        Self::with(Gradient::new(layout, leak, loss)?, parameters, optimizer)
    }
}

impl<R: Real, O: Optimizer<R>, M: Differentiable> Learner<R, O, M> {
    /// Creates a learner of a network that starts with the network's parameters.
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if the outputs of the network do not fit the loss.
    pub fn of<P: AsRef<[f32]>, S>(network: &Network<M, P, S>, loss: Loss, optimizer: O) -> Result<Self, Error> {
        let parameters = network.parameters.as_ref().iter().map(|p| R::from_f64(f64::from(*p))).collect();
        Self::with(Gradient::of(network, loss)?, parameters, optimizer)
    }

    fn with(gradient: Gradient<R, M>, parameters: Vec<R>, optimizer: O) -> Result<Self, Error> {
        let single: Vec<f32> = parameters.iter().map(|p| p.to_f64() as f32).collect();
        gradient.model().check_model(&single, |p| p)?;
        let memory = vec![R::default(); optimizer.memory_len(parameters.len())];
        Ok(Self { gradient, optimizer, parameters, memory, limit: None, frozen: 0..0, longest: None, mean: None })
    }

    /// Limits the absolute value of all weights and biases.
    pub fn with_limit(self, limit: R) -> Self {
        Self { limit: Some(limit), ..self }
    }

    /// Keeps consecutive parameters at their first values, such as the gains of a CTRNN.
    pub fn with_frozen(self, parameters: Range<usize>) -> Self {
        Self { frozen: parameters, ..self }
    }

    /// Limits the norm of the gradient. Longer gradients are scaled to this norm. This is useful for recurrent
    /// networks, where the norm can become very large if small changes have large effects.
    pub fn with_max_gradient_norm(self, longest: R) -> Self {
        Self { longest: Some(longest), ..self }
    }

    /// Enables a running [`mean`](Self::mean) of the parameters over approximately the given number of steps. Since
    /// steps of constant size oscillate around a minimum, the mean is closer to it.
    ///
    /// Source: \[Polyak1992\]. Deviation: only the first steps have equal weights. Later, each step reduces the weight
    /// of the previous ones by a factor of `1 - 1/steps`.
    pub fn with_averaging(self, steps: u32) -> Self {
        let state = core::iter::once(R::default()).chain(self.parameters.iter().copied()).collect();
        Self { mean: Some(Mean { share: R::from_f64(1.0 / f64::from(steps.max(1))), state }), ..self }
    }

    /// Performs one step along the mean gradient of the demonstrations. Returns their cost per motor value before the
    /// step.
    ///
    /// If there are no demonstrations, the parameters are not changed.
    ///
    /// # Errors
    /// Returns [`Error::Demonstration`]. In this case nothing is changed.
    pub fn learn<'d>(&mut self, demonstrations: impl IntoIterator<Item = Demonstration<'d>>) -> Result<R, Error> {
        self.gradient.clear();
        for demonstration in demonstrations {
            self.gradient.add(&self.parameters, demonstration)?;
        }
        let ticks = self.gradient.ticks();
        if ticks == 0 {
            return Ok(R::default());
        }
        for frozen in self.gradient.sum_mut().get_mut(self.frozen.clone()).into_iter().flatten() {
            *frozen = R::default();
        }
        // The mean over ticks and motor values, as of the cost.
        let values = R::from_f64((ticks * self.gradient.model().outputs().max(1)) as f64);
        let mut squares = R::default();
        for g in self.gradient.sum_mut() {
            *g = *g / values;
            squares += *g * *g;
        }
        let length = squares.sqrt();
        if let Some(longest) = self.longest.filter(|longest| length > *longest) {
            let factor = longest / length;
            self.gradient.sum_mut().iter_mut().for_each(|g| *g *= factor);
        }
        self.optimizer.step(self.gradient.sum(), &mut self.parameters, &mut self.memory);
        for (index, p) in self.parameters.iter_mut().enumerate() {
            match (self.gradient.model().domain(index), self.limit) {
                (Domain::Share, _) => *p = farsa_num::Scalar::clamp(*p, R::default(), R::from_f64(1.0)),
                (Domain::Positive, _) => *p = farsa_num::Scalar::max(*p, R::from_f64(LEAST_TIME_CONSTANT)),
                (Domain::Any, Some(limit)) => *p = farsa_num::Scalar::clamp(*p, -limit, limit),
                (Domain::Any, None) => {}
            }
        }
        if let Some(mean) = &mut self.mean {
            mean.add(&self.parameters);
        }
        Ok(self.gradient.mean_cost())
    }

    /// Computes the cost of the demonstrations per motor value without learning.
    ///
    /// # Errors
    /// Returns [`Error::Demonstration`].
    pub fn cost<'d>(&mut self, demonstrations: impl IntoIterator<Item = Demonstration<'d>>) -> Result<R, Error> {
        let (mut sum, mut values) = (R::default(), 0);
        for demonstration in demonstrations {
            sum += self.gradient.cost(&self.parameters, demonstration)?;
            values += demonstration.wanted.len();
        }
        Ok(if values == 0 { sum } else { sum / R::from_f64(values as f64) })
    }

    /// Returns a mutable reference to the optimizer, for example to change its learning rate.
    pub fn optimizer_mut(&mut self) -> &mut O {
        &mut self.optimizer
    }

    /// Gets the current parameters.
    pub fn parameters(&self) -> &[R] {
        &self.parameters
    }

    /// Returns the mean of the parameters over the latest steps. Without [`with_averaging`](Self::with_averaging) it
    /// returns the current parameters.
    pub fn mean(&self) -> &[R] {
        self.mean.as_ref().and_then(|mean| mean.state.get(1..)).unwrap_or(&self.parameters)
    }

    /// Returns the state needed to resume the training. It contains the parameters and the memory of the optimizer.
    /// With averaging, it also contains the total weight and the mean.
    pub fn state(&self) -> impl Iterator<Item = R> + '_ {
        let mean = self.mean.iter().flat_map(|mean| &mean.state);
        self.parameters.iter().chain(&self.memory).chain(mean).copied()
    }

    /// Restores a state that was returned by a learner with the same settings.
    ///
    /// # Errors
    /// Returns [`Error::Length`] or [`Error::Parameter`]. In this case nothing is changed.
    pub fn set_state(&mut self, state: &[R]) -> Result<(), Error> {
        Slice::State.check(self.state().count(), state.len())?;
        if let Some(index) = state.iter().position(|value| !value.to_f64().is_finite()) {
            return Err(ParameterFault::NotFinite.at(index));
        }
        let (parameters, rest) = state.split_at(self.parameters.len());
        let (memory, mean) = rest.split_at(self.memory.len());
        self.parameters.copy_from_slice(parameters);
        self.memory.copy_from_slice(memory);
        if let Some(Mean { state, .. }) = &mut self.mean {
            state.copy_from_slice(mean);
        }
        Ok(())
    }
}
