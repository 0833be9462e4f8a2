//! The continuous-time recurrent network.

use farsa_num::Instructions;
use farsa_num::fearless_simd::Level;

use crate::controller::Controller;
use crate::ctrnn::dynamics::{Dynamics, rate};
use crate::ctrnn::integrator::Integrator;
use crate::ctrnn::layout::{CtrnnLayout, CtrnnParameter};
use crate::error::Error;
use crate::kernel::{self, level};
use crate::lesion::{Ablatable, Lesion};

/// A continuous-time recurrent neural network, over parameters and state that are the caller's.
///
/// Each neuron has a state `y_i`, an output `o_i`, a time constant `tau_i`, a bias `theta_i` and a gain `g_i`; with
/// `sigma(x) = 1/(1 + exp(-x))`, or what [`CtrnnLayout::with_activation`] says, and external inputs `I_i`:
///
/// ```text
/// tau_i dy_i/dt = -y_i + sum_j w_ji o_j + I_i          o_j = sigma( g_j (y_j + theta_j) )
/// ```
///
/// `I_i` is `sum_k s_ki x_k`, or the input itself where inputs are direct. [`step`](Controller::step) goes one time step
/// further with the inputs held and gives the outputs at its end. Sums start at the external input and add the neurons in
/// their order.
///
/// A state of NaN, which only an overflow of the sums can make, puts out 0 and so does not spread; it stays until
/// [`reset`](Controller::reset). Inputs beyond [`INPUT_LIMIT`](Ctrnn::INPUT_LIMIT) count as the limit, NaN as 0.
///
/// Source: `[Beer1995]` eq. 1, with the gains of `[Beer1996]`. Deviations: the start is `y = 0` wherever the source draws it;
/// there is more than one integrator.
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
#[derive(Clone, Debug)]
pub struct Ctrnn<P, S> {
    layout: CtrnnLayout,
    time_step: f32,
    parameters: P,
    state: S,
    level: Level,
}

impl Ctrnn<(), ()> {
    /// The largest magnitude of an input that acts as it is.
    pub const INPUT_LIMIT: f32 = 1e6;
}

impl<P: AsRef<[f32]>, S: AsMut<[f32]>> Ctrnn<P, S> {
    /// A network at rest (`y = 0`): checks the parameters [[`parameter_count`](CtrnnLayout::parameter_count)] and overwrites
    /// the state [[`state_len`](CtrnnLayout::state_len)]. The time step is in the unit of the time constants [s].
    ///
    /// # Errors
    /// [`Error::TimeStep`], [`Error::Neurons`], [`Error::ParameterCount`], [`Error::NotFinite`], [`Error::TimeConstant`] or
    /// [`Error::StateLen`]: the first that applies, and of the parameters the first that is wrong.
    pub fn new(layout: CtrnnLayout, time_step: f32, parameters: P, mut state: S) -> Result<Self, Error> {
        check_layout(&layout, time_step)?;
        check(&layout, time_step, parameters.as_ref())?;
        let (expected, found) = (layout.state_len(), state.as_mut().len());
        if expected != found {
            return Err(Error::StateLen { expected, found });
        }
        let mut network = Self { layout, time_step, parameters, state, level: level() };
        network.reset();
        Ok(network)
    }

    /// Points the network at other parameters [[`parameter_count`](CtrnnLayout::parameter_count)] and returns the old ones;
    /// the states stay as they are.
    ///
    /// # Errors
    /// [`Error::ParameterCount`], [`Error::NotFinite`] or [`Error::TimeConstant`]; then the network is unchanged.
    pub fn set_parameters(&mut self, parameters: P) -> Result<P, Error> {
        check(&self.layout, self.time_step, parameters.as_ref())?;
        let old = core::mem::replace(&mut self.parameters, parameters);
        self.prepare();
        Ok(old)
    }

    /// Copies other parameters [[`parameter_count`](CtrnnLayout::parameter_count)] over the network's own; the states stay
    /// as they are.
    ///
    /// # Errors
    /// [`Error::ParameterCount`], [`Error::NotFinite`] or [`Error::TimeConstant`]; then the network is unchanged.
    pub fn copy_parameters(&mut self, parameters: &[f32]) -> Result<(), Error>
    where
        P: AsMut<[f32]>,
    {
        check(&self.layout, self.time_step, parameters)?;
        for (own, new) in self.parameters.as_mut().iter_mut().zip(parameters) {
            *own = *new;
        }
        self.prepare();
        Ok(())
    }

    /// Sets the states `y` `[neurons]`, and the outputs with them.
    ///
    /// # Errors
    /// [`Error::StateLen`] or [`Error::StateNotFinite`]; then the network is unchanged.
    pub fn set_states(&mut self, states: &[f32]) -> Result<(), Error> {
        let (expected, found) = (self.layout.neurons(), states.len());
        if expected != found {
            return Err(Error::StateLen { expected, found });
        }
        if let Some(index) = states.iter().position(|y| !y.is_finite()) {
            return Err(Error::StateNotFinite { index });
        }
        self.state.as_mut().iter_mut().zip(states).for_each(|(own, new)| *own = *new);
        self.prepare();
        Ok(())
    }

    /// The parameters [[`parameter_count`](CtrnnLayout::parameter_count)].
    pub fn parameters(&self) -> &[f32] {
        self.parameters.as_ref()
    }

    /// Brings what follows from states and parameters up to date.
    fn prepare(&mut self) {
        let Self { layout, time_step, parameters, state, .. } = self;
        let (integrator, neurons) = (layout.integrator(), layout.neurons());
        let time_constants = layout.split(parameters.as_ref()).time_constants;
        let rates = state.as_mut().iter_mut().skip(2 * neurons).take(neurons);
        for (to, tau) in rates.zip(time_constants) {
            *to = rate(integrator, f64::from(*time_step), f64::from(*tau)) as f32;
        }
        if let Some(mut dynamics) = dynamics(layout, parameters.as_ref(), state.as_mut(), &[], &[]) {
            dynamics.refresh();
        }
    }
}

impl<P, S> Ctrnn<P, S> {
    /// The same network over these instructions, as
    /// [`LeakyNetwork::with_instructions`](crate::LeakyNetwork::with_instructions).
    pub fn with_instructions(self, instructions: Instructions) -> Self {
        Self { level: instructions.level(), ..self }
    }

    /// The layout.
    pub const fn layout(&self) -> CtrnnLayout {
        self.layout
    }

    /// The time step [s].
    pub const fn time_step(&self) -> f32 {
        self.time_step
    }

    /// Gives parameters and state back.
    pub fn into_parts(self) -> (P, S) {
        (self.parameters, self.state)
    }

    /// The states `y` `[neurons]`.
    pub fn states(&self) -> &[f32]
    where
        S: AsRef<[f32]>,
    {
        let state = self.state.as_ref();
        state.get(..self.layout.neurons()).unwrap_or(state)
    }

    /// The outputs `o` of all neurons `[neurons]`.
    pub fn neuron_outputs(&self) -> &[f32]
    where
        S: AsRef<[f32]>,
    {
        let neurons = self.layout.neurons();
        self.state.as_ref().get(neurons..neurons.saturating_mul(2)).unwrap_or(&[])
    }
}

impl<P: AsRef<[f32]>, S: AsMut<[f32]>> Controller for Ctrnn<P, S> {
    fn inputs(&self) -> usize {
        self.layout.inputs()
    }

    fn outputs(&self) -> usize {
        self.layout.outputs()
    }

    fn reset(&mut self) {
        self.state.as_mut().fill(0.0);
        self.prepare();
    }

    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        self.step_ablated(&[], x, y);
    }
}

/// Neurons have their numbers in the layout; one that is held has its output held, its state goes on.
impl<P: AsRef<[f32]>, S: AsMut<[f32]>> Ablatable for Ctrnn<P, S> {
    fn neurons(&self) -> usize {
        self.layout.neurons()
    }

    fn step_ablated(&mut self, lesions: &[Lesion], x: &[f32], y: &mut [f32]) {
        let Self { layout, parameters, state, level, .. } = self;
        debug_assert_eq!(x.len(), layout.inputs(), "sensor values and the layout's inputs");
        debug_assert_eq!(y.len(), layout.outputs(), "motor values and the layout's outputs");
        let Some(mut dynamics) = dynamics(layout, parameters.as_ref(), state.as_mut(), lesions, x) else { return };
        kernel::step(&mut dynamics, *level);
        let outputs = dynamics.o.get(layout.output_neurons()).unwrap_or(&[]);
        y.iter_mut().zip(outputs).for_each(|(y, o)| *y = *o);
    }
}

/// Cuts parameters and state as a step wants them and takes these inputs; `None` where one of them is too short.
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
    let kept = if layout.direct_inputs().is_some() { neurons } else { inputs };
    let (kept, state) = state.split_at_mut_checked(kept)?;
    let workspace = if layout.integrator() == Integrator::RungeKutta4 { neurons } else { 0 };
    let (sum, state) = state.split_at_mut_checked(workspace)?;
    let (point, _) = state.split_at_mut_checked(workspace)?;
    // A missing input is zero.
    kept.fill(0.0);
    let first = layout.direct_inputs().map_or(0, |neurons| neurons.start);
    for (to, x) in kept.iter_mut().skip(first).zip(x.get(..inputs).unwrap_or(x)) {
        let limit = Ctrnn::INPUT_LIMIT;
        *to = if x.is_nan() { 0.0 } else { x.clamp(-limit, limit) };
    }
    let (external, inputs) = match layout.direct_inputs() {
        Some(_) => (&*kept, (&[][..], &[][..])),
        None => (&[][..], (&*kept, parts.input_weights)),
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

pub(crate) fn check_layout(layout: &CtrnnLayout, time_step: f32) -> Result<(), Error> {
    if !(time_step.is_finite() && time_step > 0.0) {
        return Err(Error::TimeStep { value: time_step });
    }
    let neurons = layout.neurons();
    for range in [Some(layout.output_neurons()), layout.direct_inputs()].into_iter().flatten() {
        if range.end > neurons {
            return Err(Error::Neurons { first: range.start, count: range.len(), neurons });
        }
    }
    Ok(())
}

pub(crate) fn check(layout: &CtrnnLayout, time_step: f32, parameters: &[f32]) -> Result<(), Error> {
    check_values(layout, time_step, parameters.iter().copied())
}

/// The same for parameters that are no slice of numbers.
pub(crate) fn check_values(
    layout: &CtrnnLayout,
    time_step: f32,
    parameters: impl ExactSizeIterator<Item = f32> + Clone,
) -> Result<(), Error> {
    let (expected, found) = (layout.parameter_count(), parameters.len());
    if expected != found {
        return Err(Error::ParameterCount { expected, found });
    }
    if let Some(index) = parameters.clone().position(|p| !p.is_finite()) {
        return Err(Error::NotFinite { index });
    }
    let least = layout.integrator().least_time_constant(time_step);
    let time_constants = parameters.enumerate().skip(layout.range(CtrnnParameter::TimeConstant).start);
    match time_constants.into_iter().find(|(_, tau)| !(*tau > 0.0 && *tau >= least)) {
        Some((index, value)) => Err(Error::TimeConstant { index, value, least }),
        None => Ok(()),
    }
}
