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
/// `sigma(x) = 1/(1 + exp(-x))`, or the function of [`CtrnnLayout::with_activation`], and external inputs `I_i`:
///
/// ```text
/// tau_i dy_i/dt = -y_i + sum_j w_ji o_j + I_i          o_j = sigma( g_j (y_j + theta_j) )
/// ```
///
/// `I_i` is `sum_k s_ki x_k`, or the input itself where inputs are direct. [`step`](crate::Controller::step) advances by one
/// time step with constant inputs and writes the outputs at its end. Sums start at the external input and add the neurons
/// in their order.
///
/// Only an overflow of the sums can make a state NaN. Its output is 0, so it does not spread, and it lasts until
/// [`reset`](crate::Controller::reset). Inputs beyond [`INPUT_LIMIT`](Ctrnn::INPUT_LIMIT) count as the limit, NaN as 0.
///
/// For lesions, neurons are numbered as in the layout. A held neuron has its output held, and its state continues.
///
/// Source: `[Beer1995]` eq. 1, with the gains of `[Beer1996]`. Deviations: the initial state is `y = 0` where the source draws
/// it, and there is more than one integrator.
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

/// The layout of a [`Ctrnn`] and its time step [s].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CtrnnModel {
    pub(crate) layout: CtrnnLayout,
    pub(crate) time_step: f32,
}

impl Ctrnn<(), ()> {
    /// The largest magnitude of an input. Larger inputs are clamped.
    pub const INPUT_LIMIT: f32 = 1e6;
}

impl<P: AsRef<[f32]>, S: AsMut<[f32]>> Network<CtrnnModel, P, S> {
    /// Builds a network at rest (`y = 0`) from parameters [[`parameter_count`](CtrnnLayout::parameter_count)] and a state
    /// [[`state_len`](CtrnnLayout::state_len)], which it overwrites. The time step has the unit of the time constants [s].
    ///
    /// # Errors
    /// [`Error::Layout`] for the time step or for neurons, [`Error::Length`] or [`Error::Parameter`].
    pub fn new(layout: CtrnnLayout, time_step: f32, parameters: P, state: S) -> Result<Self, Error> {
        Self::at_rest(CtrnnModel { layout, time_step }, parameters, state)
    }

    /// Sets the states `y` `[neurons]` and the outputs that follow from them.
    ///
    /// # Errors
    /// [`Error::Length`] or [`Error::State`]. Then the network is unchanged.
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
    /// The layout.
    pub const fn layout(&self) -> CtrnnLayout {
        self.model.layout
    }

    /// The time step [s].
    pub const fn time_step(&self) -> f32 {
        self.model.time_step
    }

    /// The states `y` `[neurons]`.
    pub fn states(&self) -> &[f32]
    where
        S: AsRef<[f32]>,
    {
        let state = self.state.as_ref();
        state.get(..self.model.layout.neurons()).unwrap_or(state)
    }

    /// The outputs `o` of all neurons `[neurons]`.
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
