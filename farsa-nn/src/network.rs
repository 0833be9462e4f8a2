//! Networks whose parameters and state are provided by the caller.

use farsa_num::Instructions;
use farsa_num::fearless_simd::Level;

use crate::controller::Controller;
use crate::error::Error;
use crate::fault::{ParameterFault, Slice};
use crate::kernel::level;
use crate::lesion::{Ablatable, Lesion};

/// A kind of network. It consists of a layout and settings but does not contain parameters or a state.
pub trait Model {
    /// Returns the number of inputs.
    fn inputs(&self) -> usize;
    /// Returns the number of outputs.
    fn outputs(&self) -> usize;
    /// Returns the number of neurons that can be lesioned.
    fn neurons(&self) -> usize;
    /// Returns the length of the state.
    fn state_len(&self) -> usize;
    /// Checks the layout and the parameters. The closure `value` decodes a stored parameter.
    ///
    /// # Errors
    /// Returns the first error that is found.
    fn check_model<T: Copy>(&self, parameters: &[T], value: impl Fn(T) -> f32 + Copy) -> Result<(), Error>;
    /// Updates the part of the state that is computed from the parameters.
    fn prepare(&self, _parameters: &[f32], _state: &mut [f32]) {}
    /// Advances the network by one tick while some neurons are lesioned.
    fn step(&self, data: Data<'_>, lesions: &[Lesion], x: &[f32], y: &mut [f32]);
}

/// The data of a step, in addition to the inputs and outputs.
#[derive(Debug)]
pub struct Data<'a> {
    pub(crate) parameters: &'a [f32],
    pub(crate) state: &'a mut [f32],
    pub(crate) level: Level,
}

/// A network of the kind `M` with parameters `P` and a state `S`.
///
/// The parameters can be a `static` array, a borrowed slice or a `Vec`. The state can be an array, a mutable slice or a
/// `Vec`. Usually you use its aliases [`LeakyNetwork`](crate::LeakyNetwork), [`Perceptron`](crate::Perceptron),
/// [`Ctrnn`](crate::Ctrnn) and [`BlockNetwork`](crate::block::BlockNetwork).
#[derive(Clone, Debug)]
pub struct Network<M, P, S> {
    pub(crate) model: M,
    pub(crate) parameters: P,
    pub(crate) state: S,
    level: Level,
}

impl<M: Model, P: AsRef<[f32]>, S: AsMut<[f32]>> Network<M, P, S> {
    /// Checks layout, parameters and the length of the state, and builds a network at rest.
    pub(crate) fn at_rest(model: M, parameters: P, mut state: S) -> Result<Self, Error> {
        // The checks see no copy of the network, so it moves once. More copies would take stack on boards.
        match rest(&model, parameters.as_ref(), state.as_mut()) {
            Ok(()) => Ok(Self { model, parameters, state, level: level() }),
            Err(error) => Err(error),
        }
    }

    /// Replaces the parameters and returns the previous ones. The state is not changed.
    ///
    /// # Errors
    /// Returns [`Error::Length`] or [`Error::Parameter`]. In this case the network is unchanged.
    pub fn set_parameters(&mut self, parameters: P) -> Result<P, Error> {
        self.model.check_model(parameters.as_ref(), |p| p)?;
        let old = core::mem::replace(&mut self.parameters, parameters);
        self.prepare();
        Ok(old)
    }

    /// Copies new parameters into the network. The state is not changed.
    ///
    /// # Errors
    /// Returns [`Error::Length`] or [`Error::Parameter`]. In this case the network is unchanged.
    pub fn copy_parameters(&mut self, parameters: &[f32]) -> Result<(), Error>
    where
        P: AsMut<[f32]>,
    {
        self.model.check_model(parameters, |p| p)?;
        self.parameters.as_mut().iter_mut().zip(parameters).for_each(|(to, p)| *to = *p);
        self.prepare();
        Ok(())
    }

    /// Gets the parameters of the network.
    pub fn parameters(&self) -> &[f32] {
        self.parameters.as_ref()
    }

    /// Updates the part of the state that follows from the parameters.
    pub(crate) fn prepare(&mut self) {
        self.model.prepare(self.parameters.as_ref(), self.state.as_mut());
    }
}

impl<M, P, S> Network<M, P, S> {
    /// Selects the instructions of the processor used. The results do not change.
    ///
    /// The default is [`Instructions::detect`]. If the processor does not support the selected instructions, the best
    /// available ones are used.
    pub fn with_instructions(self, instructions: Instructions) -> Self {
        Self { level: instructions.level(), ..self }
    }

    /// Returns the parameters and the state of the network.
    pub fn into_parts(self) -> (P, S) {
        (self.parameters, self.state)
    }
}

impl<M: Model, P: AsRef<[f32]>, S: AsMut<[f32]>> Controller for Network<M, P, S> {
    fn inputs(&self) -> usize {
        self.model.inputs()
    }

    fn outputs(&self) -> usize {
        self.model.outputs()
    }

    fn reset(&mut self) {
        self.state.as_mut().fill(0.0);
        self.prepare();
    }

    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        self.step_ablated(&[], x, y);
    }
}

/// The kind of network defines the numbers of its neurons.
impl<M: Model, P: AsRef<[f32]>, S: AsMut<[f32]>> Ablatable for Network<M, P, S> {
    fn neurons(&self) -> usize {
        self.model.neurons()
    }

    fn step_ablated(&mut self, lesions: &[Lesion], x: &[f32], y: &mut [f32]) {
        let Self { model, parameters, state, level } = self;
        debug_assert_eq!(x.len(), model.inputs(), "sensor values and the layout's inputs");
        debug_assert_eq!(y.len(), model.outputs(), "motor values and the layout's outputs");
        let data = Data { parameters: parameters.as_ref(), state: state.as_mut(), level: *level };
        model.step(data, lesions, x, y);
    }
}

/// Checks layout, parameters and the length of the state, and resets the state.
fn rest<M: Model>(model: &M, parameters: &[f32], state: &mut [f32]) -> Result<(), Error> {
    model.check_model(parameters, |p| p)?;
    Slice::State.check(model.state_len(), state.len())?;
    state.fill(0.0);
    model.prepare(parameters, state);
    Ok(())
}

/// Checks the number of parameters, their finiteness, and the leaks, which begin at an index and end with the
/// parameters.
pub(crate) fn check_parameters<T: Copy>(
    count: usize,
    leaks: usize,
    parameters: &[T],
    value: impl Fn(T) -> f32,
) -> Result<(), Error> {
    Slice::Parameters.check(count, parameters.len())?;
    if let Some(index) = parameters.iter().position(|p| !value(*p).is_finite()) {
        return Err(ParameterFault::NotFinite.at(index));
    }
    let mut leaks = parameters.iter().map(|p| value(*p)).enumerate().skip(leaks);
    match leaks.find(|(_, leak)| !(0.0..=1.0).contains(leak)) {
        Some((index, leak)) => Err(ParameterFault::Leak(leak).at(index)),
        None => Ok(()),
    }
}
