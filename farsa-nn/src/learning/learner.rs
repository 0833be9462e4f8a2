//! A network that learns from demonstrations.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Real;

use crate::error::Error;
use crate::leak::Leak;
use crate::leaky_layout::{LeakyLayout, LeakyParameter};
use crate::leaky_network::check;
use crate::learning::gradient::{Demonstration, Gradient, Loss};
use crate::learning::optimizer::Optimizer;

/// Parameters of a [`LeakyNetwork`](crate::LeakyNetwork) that follow the [`Gradient`] of what demonstrations cost.
///
/// After each step leaks are brought back into [0, 1], and weights and biases into plus and minus
/// [`limit`](Self::with_limit): a leak at an end stays there until the gradient points inwards.
///
/// ```
/// use farsa_nn::learning::{Adam, Demonstration, Learner, Loss};
/// use farsa_nn::{Leak, LeakyLayout};
///
/// // One output that shall be the exclusive or of two inputs: examples of one tick each.
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
pub struct Learner<R, O> {
    gradient: Gradient<R>,
    optimizer: O,
    parameters: Vec<R>,
    memory: Vec<R>,
    limit: Option<R>,
    /// The largest length that a gradient may have.
    longest: Option<R>,
    mean: Option<Mean<R>>,
}

/// The mean of parameters over steps.
#[derive(Clone, Debug)]
struct Mean<R> {
    /// What each step's parameters are of it.
    share: R,
    /// How much of its steps there is yet, 0 before the first and 1 after many; and the mean itself \[parameters\].
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
    /// A learner at these parameters [[`parameter_count`](LeakyLayout::parameter_count)].
    ///
    /// # Errors
    /// [`Error::Slope`], [`Error::ParameterCount`], [`Error::NotFinite`] or [`Error::LeakRange`]: the first that applies.
    pub fn new(layout: LeakyLayout, leak: Leak, loss: Loss, parameters: Vec<R>, optimizer: O) -> Result<Self, Error> {
        let gradient = Gradient::new(layout, leak, loss)?;
        let single: Vec<f32> = parameters.iter().map(|p| p.to_f64() as f32).collect();
        check(&layout, &single)?;
        let memory = vec![R::default(); optimizer.memory_len(parameters.len())];
        Ok(Self { gradient, optimizer, parameters, memory, limit: None, longest: None, mean: None })
    }

    /// The same learner with weights and biases kept within plus and minus this.
    pub fn with_limit(self, limit: R) -> Self {
        Self { limit: Some(limit), ..self }
    }

    /// The same learner with gradients shortened to this length where they are longer: the long ones of a recurrent network
    /// come from where a small change decides much, and say little.
    pub fn with_max_gradient_norm(self, longest: R) -> Self {
        Self { longest: Some(longest), ..self }
    }

    /// The same learner with a [`mean`](Self::mean) of its parameters over about so many of the latest steps, at least one: it
    /// lies in the middle of where steps that do not grow smaller go to and fro.
    ///
    /// Source: \[Polyak1992\]. Deviation: the plain mean over the first steps only; then a step counts less by a factor of
    /// `1 - 1/steps` with each that follows.
    pub fn with_averaging(self, steps: u32) -> Self {
        let state = core::iter::once(R::default()).chain(self.parameters.iter().copied()).collect();
        Self { mean: Some(Mean { share: R::from_f64(1.0 / f64::from(steps.max(1))), state }), ..self }
    }

    /// One step along the mean gradient of these demonstrations; returns what they cost before it, per motor value.
    ///
    /// Without demonstrations there is no step.
    ///
    /// # Errors
    /// [`Error::Demonstration`]; then nothing has changed.
    pub fn learn<'d>(&mut self, demonstrations: impl IntoIterator<Item = Demonstration<'d>>) -> Result<R, Error> {
        self.gradient.clear();
        for demonstration in demonstrations {
            self.gradient.add(&self.parameters, demonstration)?;
        }
        let ticks = self.gradient.ticks();
        if ticks == 0 {
            return Ok(R::default());
        }
        // The mean over ticks and motor values, as of the cost.
        let values = R::from_f64((ticks * self.gradient.layout().outputs().max(1)) as f64);
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
        let leaks = self.gradient.layout().range(LeakyParameter::Leak).start;
        for (index, p) in self.parameters.iter_mut().enumerate() {
            if index >= leaks {
                *p = farsa_num::Scalar::clamp(*p, R::default(), R::from_f64(1.0));
            } else if let Some(limit) = self.limit {
                *p = farsa_num::Scalar::clamp(*p, -limit, limit);
            }
        }
        if let Some(mean) = &mut self.mean {
            mean.add(&self.parameters);
        }
        Ok(self.gradient.mean_cost())
    }

    /// What these demonstrations cost per motor value; nothing is learned.
    ///
    /// # Errors
    /// [`Error::Demonstration`].
    pub fn cost<'d>(&mut self, demonstrations: impl IntoIterator<Item = Demonstration<'d>>) -> Result<R, Error> {
        let (mut sum, mut values) = (R::default(), 0);
        for demonstration in demonstrations {
            sum += self.gradient.cost(&self.parameters, demonstration)?;
            values += demonstration.wanted.len();
        }
        Ok(if values == 0 { sum } else { sum / R::from_f64(values as f64) })
    }

    /// The optimizer, to change its rate.
    pub fn optimizer_mut(&mut self) -> &mut O {
        &mut self.optimizer
    }

    /// The parameters [[`parameter_count`](LeakyLayout::parameter_count)].
    pub fn parameters(&self) -> &[R] {
        &self.parameters
    }

    /// The mean of the parameters over the latest steps [[`parameter_count`](LeakyLayout::parameter_count)], and of a
    /// learner without [`with_averaging`](Self::with_averaging) the parameters.
    pub fn mean(&self) -> &[R] {
        self.mean.as_ref().and_then(|mean| mean.state.get(1..)).unwrap_or(&self.parameters)
    }

    /// All that learning goes on from, one after the other: the parameters, the optimizer's memory, and of a learner with a
    /// mean how much of its steps there is yet and the mean.
    pub fn state(&self) -> impl Iterator<Item = R> + '_ {
        let mean = self.mean.iter().flat_map(|mean| &mean.state);
        self.parameters.iter().chain(&self.memory).chain(mean).copied()
    }

    /// Goes on from where another learner of the same kind was.
    ///
    /// # Errors
    /// [`Error::StateLen`] for another number of state, [`Error::NotFinite`]; then nothing has changed.
    pub fn set_state(&mut self, state: &[R]) -> Result<(), Error> {
        let found = state.len();
        let expected = self.state().count();
        if expected != found {
            return Err(Error::StateLen { expected, found });
        }
        if let Some(index) = state.iter().position(|value| !value.to_f64().is_finite()) {
            return Err(Error::NotFinite { index });
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
