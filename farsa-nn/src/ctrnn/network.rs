//! The continuous-time recurrent network.

use crate::ctrnn::dynamics::{Dynamics, rate};
use crate::ctrnn::integrator::Integrator;
use crate::ctrnn::layout::{CtrnnLayout, CtrnnParameter};
use crate::error::Error;
use crate::fault::{LayoutFault, ParameterFault, Slice};
use crate::kernel;
use crate::lesion::Lesion;
use crate::network::{Data, Model, Network, check_parameters};

/// A continuous-time recurrent neural network.
///
/// Each neuron has a state `y_i`, an output `o_i`, a time constant `tau_i`, a bias `theta_i` and a gain `g_i`. With
/// external inputs `I_i` and `sigma(x) = 1/(1 + exp(-x))`, or the function set by [`CtrnnLayout::with_activation`]:
///
/// ```text
/// tau_i dy_i/dt = -y_i + sum_j w_ji o_j + I_i          o_j = sigma( g_j (y_j + theta_j) )
/// ```
///
/// The external input `I_i` is `sum_k s_ki x_k` for weighted inputs and the input itself for direct ones. Each call of
/// [`step`](crate::Controller::step) advances the network by one time step with constant inputs and writes the outputs
/// at its end. Sums start with the external input, and the neurons are added in their order.
///
/// A state can become NaN only if a sum overflows. In this case its output is 0, so the NaN does not spread, and it
/// remains until [`reset`](crate::Controller::reset) is called. Inputs are clamped to
/// [`INPUT_LIMIT`](Ctrnn::INPUT_LIMIT), and NaN is treated as 0.
///
/// For lesions, neurons are numbered as in the layout. The output of a lesioned neuron is constant, but its state
/// continues to change.
///
/// Source: `[Beer1995]` eq. 1, with the gains of `[Beer1996]`. Deviations: the initial state is `y = 0`, whereas the
/// source draws it. Several integrators are available.
///
/// ```
/// use farsa_nn::{Controller, Ctrnn, CtrnnLayout};
///
/// // Two neurons that oscillate: weights, then biases, gains and time constants.
/// const LAYOUT: CtrnnLayout = CtrnnLayout::new(0, 2, 2);
/// static PARAMETERS: [f32; LAYOUT.parameter_count()] = [4.5, -1.0, 1.0, 4.5, -2.75, -1.75, 1.0, 1.0, 1.0, 1.0];
/// # fn main() -> Result<(), farsa_nn::Error> {
/// let mut network = Ctrnn::new(LAYOUT, 0.05, &PARAMETERS, [0.0; LAYOUT.state_len()])?;
/// let (mut y, mut low, mut high) = ([0.0; 2], 1.0_f32, 0.0_f32);
/// for step in 0..4000 {
///     network.step(&[], &mut y);
///     if step > 2000 {
///         (low, high) = (low.min(y[0]), high.max(y[0]));
///     }
/// }
/// assert!(high - low > 0.3);
/// # Ok(())
/// # }
/// ```
pub type Ctrnn<P, S> = Network<CtrnnModel, P, S>;

/// The layout of a [`Ctrnn`], together with its time step in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CtrnnModel {
    pub(crate) layout: CtrnnLayout,
    pub(crate) time_step: f32,
}

impl Ctrnn<(), ()> {
    /// Largest magnitude of an input. Larger inputs are clamped.
    pub const INPUT_LIMIT: f32 = 1e6;
}

impl<P: AsRef<[f32]>, S: AsMut<[f32]>> Network<CtrnnModel, P, S> {
    /// Creates a network with the given parameters and resets its state to `y = 0`. The slices must have the lengths
    /// [`parameter_count`](CtrnnLayout::parameter_count) and [`state_len`](CtrnnLayout::state_len). The time step has
    /// the same unit as the time constants (in seconds).
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if the time step or the neurons are invalid, [`Error::Length`] or
    /// [`Error::Parameter`].
    pub fn new(layout: CtrnnLayout, time_step: f32, parameters: P, state: S) -> Result<Self, Error> {
        Self::at_rest(CtrnnModel { layout, time_step }, parameters, state)
    }

    /// Sets the states `y` of all neurons and computes the resulting outputs.
    ///
    /// # Errors
    /// Returns [`Error::Length`] or [`Error::State`]. In this case the network is unchanged.
    pub fn set_states(&mut self, states: &[f32]) -> Result<(), Error> {
        Slice::State.check(self.model.layout.neurons(), states.len())?;
        if let Some(index) = states.iter().position(|y| !y.is_finite()) {
            return Err(Error::State { index });
        }
        self.state.as_mut().iter_mut().zip(states).for_each(|(to, y)| *to = *y);
        self.prepare();
        Ok(())
    }
}

impl<P, S> Network<CtrnnModel, P, S> {
    /// Gets the layout of the network.
    pub const fn layout(&self) -> CtrnnLayout {
        self.model.layout
    }

    /// Gets the time step in seconds.
    pub const fn time_step(&self) -> f32 {
        self.model.time_step
    }

    /// Returns the states `y` of all neurons.
    pub fn states(&self) -> &[f32]
    where
        S: AsRef<[f32]>,
    {
        let state = self.state.as_ref();
        state.get(..self.model.layout.neurons()).unwrap_or(state)
    }

    /// Returns the outputs `o` of all neurons.
    pub fn neuron_outputs(&self) -> &[f32]
    where
        S: AsRef<[f32]>,
    {
        let neurons = self.model.layout.neurons();
        self.state.as_ref().get(neurons..neurons.saturating_mul(2)).unwrap_or(&[])
    }
}

impl Model for CtrnnModel {
    fn inputs(&self) -> usize {
        self.layout.inputs()
    }

    fn outputs(&self) -> usize {
        self.layout.outputs()
    }

    fn neurons(&self) -> usize {
        self.layout.neurons()
    }

    fn state_len(&self) -> usize {
        self.layout.state_len()
    }

    fn check_model<T: Copy>(&self, parameters: &[T], value: impl Fn(T) -> f32 + Copy) -> Result<(), Error> {
        self.check_layout()?;
        let constants = self.layout.range(CtrnnParameter::TimeConstant);
        check_parameters(constants.end, constants.end, parameters, value)?;
        let least = self.layout.integrator().least_time_constant(self.time_step);
        let mut constants = parameters.iter().map(|p| value(*p)).enumerate().skip(constants.start);
        match constants.find(|(_, tau)| !(*tau > 0.0 && *tau >= least)) {
            Some((index, value)) => Err(ParameterFault::TimeConstant { value, least }.at(index)),
            None => Ok(()),
        }
    }

    fn prepare(&self, parameters: &[f32], state: &mut [f32]) {
        let (integrator, neurons) = (self.layout.integrator(), self.layout.neurons());
        let time_constants = self.layout.split(parameters).time_constants;
        let rates = state.iter_mut().skip(2 * neurons).take(neurons);
        for (to, tau) in rates.zip(time_constants) {
            *to = rate(integrator, f64::from(self.time_step), f64::from(*tau)) as f32;
        }
        if let Some(mut dynamics) = dynamics(&self.layout, parameters, state, &[], &[]) {
            dynamics.refresh();
        }
    }

    fn step(&self, data: Data<'_>, lesions: &[Lesion], x: &[f32], y: &mut [f32]) {
        let Data { parameters, state, level } = data;
        let Some(mut dynamics) = dynamics(&self.layout, parameters, state, lesions, x) else { return };
        kernel::step(&mut dynamics, level);
        let outputs = dynamics.o.get(self.layout.output_neurons()).unwrap_or(&[]);
        y.iter_mut().zip(outputs).for_each(|(y, o)| *y = *o);
    }
}

impl CtrnnModel {
    /// Checks the time step, and that the neurons of inputs and outputs exist.
    pub(crate) fn check_layout(&self) -> Result<(), Error> {
        if !(self.time_step.is_finite() && self.time_step > 0.0) {
            return Err(LayoutFault::TimeStep(self.time_step).into());
        }
        let neurons = self.layout.neurons();
        for range in [Some(self.layout.output_neurons()), self.layout.direct_inputs()].into_iter().flatten() {
            if range.end > neurons {
                return Err(LayoutFault::Neurons { first: range.start, count: range.len(), neurons }.into());
            }
        }
        Ok(())
    }
}

/// Splits parameters and state for a step and stores the inputs. Returns `None` if a slice is too short.
fn dynamics<'a>(
    layout: &CtrnnLayout,
    parameters: &'a [f32],
    state: &'a mut [f32],
    lesions: &'a [Lesion],
    x: &[f32],
) -> Option<Dynamics<'a>> {
    let (neurons, inputs) = (layout.neurons(), layout.inputs());
    let parts = layout.split(parameters);
    let (y, state) = state.split_at_mut_checked(neurons)?;
    let (o, state) = state.split_at_mut_checked(neurons)?;
    let (rates, state) = state.split_at_mut_checked(neurons)?;
    let (net, state) = state.split_at_mut_checked(neurons)?;
    let stored = if layout.direct_inputs().is_some() { neurons } else { inputs };
    let (stored, state) = state.split_at_mut_checked(stored)?;
    let workspace = if layout.integrator() == Integrator::RungeKutta4 { neurons } else { 0 };
    let (sum, state) = state.split_at_mut_checked(workspace)?;
    let (point, _) = state.split_at_mut_checked(workspace)?;
    // A missing input is zero.
    stored.fill(0.0);
    let first = layout.direct_inputs().map_or(0, |neurons| neurons.start);
    for (to, x) in stored.iter_mut().skip(first).zip(x.get(..inputs).unwrap_or(x)) {
        let limit = Ctrnn::INPUT_LIMIT;
        *to = if x.is_nan() { 0.0 } else { x.clamp(-limit, limit) };
    }
    let (external, inputs) = match layout.direct_inputs() {
        Some(_) => (&*stored, (&[][..], &[][..])),
        None => (&[][..], (&*stored, parts.input_weights)),
    };
    (parts.time_constants.len() == neurons).then_some(Dynamics {
        integrator: layout.integrator(),
        activation: layout.activation(),
        y,
        o,
        rates,
        biases: parts.biases,
        gains: parts.gains,
        external,
        inputs,
        weights: parts.weights,
        lesions,
        net,
        sum,
        point,
    })
}
