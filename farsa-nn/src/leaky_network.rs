//! The leaky recurrent network of the manipulation experiment.

use farsa_num::Instructions;
use farsa_num::fearless_simd::Level;

use crate::controller::Controller;
use crate::error::Error;
use crate::kernel::{Layer, level, prefix};
use crate::leak::Leak;
use crate::leaky_layout::{LeakyLayout, LeakyParameter};
use crate::lesion::{Ablatable, Lesion, hold};

/// A network of one recurrent hidden layer with leaks, over parameters and state that are the caller's.
///
/// With sensors `I`, `sigma(x) = 1/(1 + exp(-slope*x))` and the reading of the leak that [`Leak`] names:
///
/// ```text
/// y_i(t) = sigma( beta_i + sum_j w_ji I_j(t) + sum_k r_ki H_k(t-1) )
/// H_i(t) = d_i*y_i(t) + (1-d_i)*(H_i(t-1) or y_i(t-1)), or as Evonet
/// O_i(t) = sigma( sum_j w_ji H_j(t) )
/// ```
///
/// The parameters `P` may be a `static` array, a borrowed slice or a `Vec`; the state `S` an array, a mutable slice or a
/// `Vec`. `H(0)` and `y(0)` are zero, in every reading.
///
/// A NaN or infinite input is the caller's mistake; what it leaves in the state stays there until
/// [`reset`](Controller::reset).
///
/// Source: `[Ferrauto2010]` chapter 2. Deviations: the bias is the first summand, not the last (the order of rounding
/// only); the recurrent sum, which the source states in words and proves by its parameter counts, is written out and
/// reads `H(t-1)`; the initial state, which the source does not give, is zero.
///
/// ```
/// use farsa_nn::{Controller, Leak, LeakyLayout, LeakyNetwork};
///
/// const LAYOUT: LeakyLayout = LeakyLayout::new(1, 1, 1);
/// static PARAMETERS: [f32; LAYOUT.parameter_count()] = [6.0, 0.0, -6.0, 0.0, 0.5];
/// # fn main() -> Result<(), farsa_nn::Error> {
/// let mut network = LeakyNetwork::new(LAYOUT, Leak::Filter, &PARAMETERS, [0.0; LAYOUT.state_len()])?;
/// let mut y = [0.0];
/// network.step(&[0.0], &mut y);
/// assert_eq!(network.hidden(), [0.25]);
/// network.step(&[0.0], &mut y);
/// assert_eq!(network.hidden(), [0.375]);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct LeakyNetwork<P, S> {
    layout: LeakyLayout,
    leak: Leak,
    parameters: P,
    state: S,
    level: Level,
}

impl<P: AsRef<[f32]>, S: AsMut<[f32]>> LeakyNetwork<P, S> {
    /// A network at rest: checks the parameters [[`parameter_count`](LeakyLayout::parameter_count)] and zeroes the
    /// state [[`state_len`](LeakyLayout::state_len)].
    ///
    /// # Errors
    /// [`Error::Slope`], [`Error::ParameterCount`], [`Error::NotFinite`], [`Error::LeakRange`] or [`Error::StateLen`]:
    /// the first that applies, and of the parameters the first that is wrong.
    pub fn new(layout: LeakyLayout, leak: Leak, parameters: P, mut state: S) -> Result<Self, Error> {
        if !layout.slope().is_finite() {
            return Err(Error::Slope { value: layout.slope() });
        }
        check(&layout, parameters.as_ref())?;
        let (expected, found) = (layout.state_len(), state.as_mut().len());
        if expected != found {
            return Err(Error::StateLen { expected, found });
        }
        state.as_mut().fill(0.0);
        Ok(Self { layout, leak, parameters, state, level: level() })
    }

    /// Points the network at other parameters [[`parameter_count`](LeakyLayout::parameter_count)] and returns the old
    /// ones; the state stays as it is.
    ///
    /// # Errors
    /// [`Error::ParameterCount`], [`Error::NotFinite`] or [`Error::LeakRange`]; then the network is unchanged.
    pub fn set_parameters(&mut self, parameters: P) -> Result<P, Error> {
        check(&self.layout, parameters.as_ref())?;
        Ok(core::mem::replace(&mut self.parameters, parameters))
    }

    /// Copies other parameters [[`parameter_count`](LeakyLayout::parameter_count)] over the network's own; the state
    /// stays as it is.
    ///
    /// # Errors
    /// [`Error::ParameterCount`], [`Error::NotFinite`] or [`Error::LeakRange`]; then the network is unchanged.
    pub fn copy_parameters(&mut self, parameters: &[f32]) -> Result<(), Error>
    where
        P: AsMut<[f32]>,
    {
        check(&self.layout, parameters)?;
        for (own, new) in self.parameters.as_mut().iter_mut().zip(parameters) {
            *own = *new;
        }
        Ok(())
    }

    /// The parameters [[`parameter_count`](LeakyLayout::parameter_count)].
    pub fn parameters(&self) -> &[f32] {
        self.parameters.as_ref()
    }
}

impl<P, S> LeakyNetwork<P, S> {
    /// The same network over these instructions, with the same bits.
    ///
    /// By default those of [`Instructions::detect`]; of what the processor lacks, the best that it has.
    pub fn with_instructions(self, instructions: Instructions) -> Self {
        Self { level: instructions.level(), ..self }
    }

    /// The layout.
    pub const fn layout(&self) -> LeakyLayout {
        self.layout
    }

    /// The reading of the leak.
    pub const fn leak(&self) -> Leak {
        self.leak
    }

    /// Gives parameters and state back.
    pub fn into_parts(self) -> (P, S) {
        (self.parameters, self.state)
    }

    /// The activations `H(t)` `[hidden]` in [0, 1].
    pub fn hidden(&self) -> &[f32]
    where
        S: AsRef<[f32]>,
    {
        let state = self.state.as_ref();
        state.get(..self.layout.hidden()).unwrap_or(state)
    }
}

impl<P: AsRef<[f32]>, S: AsMut<[f32]>> Controller for LeakyNetwork<P, S> {
    fn inputs(&self) -> usize {
        self.layout.sensors()
    }

    fn outputs(&self) -> usize {
        self.layout.outputs()
    }

    fn reset(&mut self) {
        self.state.as_mut().fill(0.0);
    }

    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        self.step_ablated(&[], x, y);
    }
}

/// The hidden neurons come first, the outputs after them. A hidden neuron that is held is so before and after the step: what
/// it sends back to the others is held, too.
impl<P: AsRef<[f32]>, S: AsMut<[f32]>> Ablatable for LeakyNetwork<P, S> {
    fn neurons(&self) -> usize {
        self.layout.hidden().saturating_add(self.layout.outputs())
    }

    fn step_ablated(&mut self, lesions: &[Lesion], x: &[f32], y: &mut [f32]) {
        let Self { layout, leak, parameters, state, level } = self;
        debug_assert_eq!(x.len(), layout.sensors(), "sensor values and the layout's sensors");
        debug_assert_eq!(y.len(), layout.outputs(), "motor values and the layout's outputs");
        let parts = layout.split(parameters.as_ref());
        let (count, slope) = (layout.hidden(), layout.slope());

        let state = state.as_mut();
        let (hidden, state) = state.split_at_mut(count.min(state.len()));
        let (previous, state) = state.split_at_mut(count.min(state.len()));
        let response = prefix(state, count);
        hold(lesions, 0, hidden);

        let sources = [(x, parts.sensor_weights), (&*hidden, parts.recurrent_weights)];
        Layer { targets: count, slope, biases: parts.biases, sources }.forward(*level, response);

        leak.apply(response, parts.leaks, hidden, previous);
        hold(lesions, 0, hidden);

        let sources = [(&*hidden, parts.output_weights), (&[], &[])];
        Layer { targets: layout.outputs(), slope, biases: &[], sources }.forward(*level, y);
        hold(lesions, count, prefix(y, layout.outputs()));
    }
}

pub(crate) fn check(layout: &LeakyLayout, parameters: &[f32]) -> Result<(), Error> {
    check_values(layout, parameters.iter().copied())
}

/// The same for parameters that are no slice of numbers.
pub(crate) fn check_values(
    layout: &LeakyLayout,
    parameters: impl ExactSizeIterator<Item = f32> + Clone,
) -> Result<(), Error> {
    let (expected, found) = (layout.parameter_count(), parameters.len());
    if expected != found {
        return Err(Error::ParameterCount { expected, found });
    }
    if let Some(index) = parameters.clone().position(|p| !p.is_finite()) {
        return Err(Error::NotFinite { index });
    }
    let leaks = parameters.enumerate().skip(layout.range(LeakyParameter::Leak).start);
    match leaks.into_iter().find(|(_, leak)| !(0.0..=1.0).contains(leak)) {
        Some((index, value)) => Err(Error::LeakRange { index, value }),
        None => Ok(()),
    }
}
