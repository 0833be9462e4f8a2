//! The leaky recurrent network of the manipulation experiment.

use crate::error::Error;
use crate::fault::LayoutFault;
use crate::kernel::{Layer, prefix};
use crate::leak::Leak;
use crate::leaky_layout::{LeakyLayout, LeakyParameter};
use crate::lesion::{Lesion, hold};
use crate::network::{Data, Model, Network, check_parameters};

/// A network with one recurrent hidden layer of leaky neurons.
///
/// With sensors `I`, `sigma(x) = 1/(1 + exp(-slope*x))` and the selected [`Leak`]:
///
/// ```text
/// y_i(t) = sigma( beta_i + sum_j w_ji I_j(t) + sum_k r_ki H_k(t-1) )
/// H_i(t) = d_i*y_i(t) + (1-d_i)*(H_i(t-1) or y_i(t-1)), or as Evonet
/// O_i(t) = sigma( sum_j w_ji H_j(t) )
/// ```
///
/// The initial values `H(0)` and `y(0)` are zero. Inputs must not be NaN or infinite. Otherwise they influence the
/// state until [`reset`](crate::Controller::reset) is called.
///
/// For lesions, hidden neurons are numbered first, followed by outputs. The value of a lesioned hidden neuron is set
/// before and after the step, so its recurrent connections transmit this value, too.
///
/// Source: `[Ferrauto2010]` chapter 2. Deviations: the bias is added first and not last. This only affects rounding.
/// The recurrent sum, which the source describes in words and confirms by its parameter counts, is explicit and uses
/// `H(t-1)`. The initial state is zero, since the source does not specify it.
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
pub type LeakyNetwork<P, S> = Network<LeakyModel, P, S>;

/// The layout of a [`LeakyNetwork`], together with the interpretation of its leaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeakyModel {
    pub(crate) layout: LeakyLayout,
    pub(crate) leak: Leak,
}

impl<P: AsRef<[f32]>, S: AsMut<[f32]>> Network<LeakyModel, P, S> {
    /// Creates a network with the given parameters and resets its state to zero. The slices must have the lengths
    /// [`parameter_count`](LeakyLayout::parameter_count) and [`state_len`](LeakyLayout::state_len).
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if the slope is invalid, [`Error::Length`] or [`Error::Parameter`].
    pub fn new(layout: LeakyLayout, leak: Leak, parameters: P, state: S) -> Result<Self, Error> {
        Self::at_rest(LeakyModel { layout, leak }, parameters, state)
    }
}

impl<P, S> Network<LeakyModel, P, S> {
    /// Gets the layout of the network.
    pub const fn layout(&self) -> LeakyLayout {
        self.model.layout
    }

    /// Gets the interpretation of the leaks.
    pub const fn leak(&self) -> Leak {
        self.model.leak
    }

    /// Returns the activations `H(t)` of the hidden neurons. They are in [0, 1].
    pub fn hidden(&self) -> &[f32]
    where
        S: AsRef<[f32]>,
    {
        let state = self.state.as_ref();
        state.get(..self.model.layout.hidden()).unwrap_or(state)
    }
}

impl Model for LeakyModel {
    fn inputs(&self) -> usize {
        self.layout.sensors()
    }

    fn outputs(&self) -> usize {
        self.layout.outputs()
    }

    fn neurons(&self) -> usize {
        self.layout.hidden().saturating_add(self.layout.outputs())
    }

    fn state_len(&self) -> usize {
        self.layout.state_len()
    }

    fn check_model<T: Copy>(&self, parameters: &[T], value: impl Fn(T) -> f32 + Copy) -> Result<(), Error> {
        LayoutFault::check_slope(self.layout.slope())?;
        let leaks = self.layout.range(LeakyParameter::Leak);
        check_parameters(leaks.end, leaks.start, parameters, value)
    }

    #[inline]
    fn step(&self, data: Data<'_>, lesions: &[Lesion], x: &[f32], y: &mut [f32]) {
        let Self { layout, leak } = self;
        let Data { parameters, state, level } = data;
        let parts = layout.split(parameters);
        let (count, slope) = (layout.hidden(), layout.slope());

        let (hidden, state) = state.split_at_mut(count.min(state.len()));
        let (previous, state) = state.split_at_mut(count.min(state.len()));
        let response = prefix(state, count);
        hold(lesions, 0, hidden);

        let sources = [(x, parts.sensor_weights), (&*hidden, parts.recurrent_weights)];
        Layer { targets: count, slope, biases: parts.biases, sources }.forward(level, response);

        leak.apply(response, parts.leaks, hidden, previous);
        hold(lesions, 0, hidden);

        let sources = [(&*hidden, parts.output_weights), (&[], &[])];
        Layer { targets: layout.outputs(), slope, biases: &[], sources }.forward(level, y);
        hold(lesions, count, prefix(y, layout.outputs()));
    }
}
