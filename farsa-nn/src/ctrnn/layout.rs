//! The layout of a continuous-time recurrent network. It also defines the order of the parameters.

use core::ops::Range;

use crate::activation::Activation;
use crate::ctrnn::integrator::Integrator;

/// The kind of a parameter in a [`CtrnnLayout`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum CtrnnParameter {
    /// Weight `s_ki` from input `k` to neuron `i`.
    InputWeight,
    /// Weight `w_ji` from neuron `j` to neuron `i`.
    Weight,
    /// Bias `theta_i` added to the state of neuron `i`.
    Bias,
    /// Gain `g_i` of neuron `i`. It is 1 in experiments without gains.
    Gain,
    /// Time constant `tau_i` of neuron `i` [s].
    TimeConstant,
}

impl CtrnnParameter {
    /// All kinds in the order of the parameters.
    pub const ALL: [Self; 5] = [Self::InputWeight, Self::Weight, Self::Bias, Self::Gain, Self::TimeConstant];
}

/// The layout of a [`Ctrnn`](crate::Ctrnn). It defines the numbers of inputs `m`, neurons `n` and outputs, the neurons
/// to which inputs and outputs belong, and the integrator.
///
/// Weighted inputs are connected to all neurons. A direct input is the external input of a single neuron. The neurons
/// of direct inputs are consecutive, and so are those of the outputs.
///
/// All parameters are stored in one slice. Weights are ordered by source, so the weights to all targets of a source are
/// consecutive. If inputs are direct, `m` is 0 in the following table.
///
/// | kind | count | at |
/// |---|---|---|
/// | [`InputWeight`](CtrnnParameter::InputWeight) | `m*n` | `k*n + i`, input `k` to neuron `i` |
/// | [`Weight`](CtrnnParameter::Weight) | `n*n` | `m*n + j*n + i`, neuron `j` to neuron `i` |
/// | [`Bias`](CtrnnParameter::Bias) | `n` | `m*n + n*n + i` |
/// | [`Gain`](CtrnnParameter::Gain) | `n` | `m*n + n*n + n + i` |
/// | [`TimeConstant`](CtrnnParameter::TimeConstant) | `n` | `m*n + n*n + 2*n + i` |
///
/// All counts saturate, as in a [`LeakyLayout`](crate::LeakyLayout).
///
/// ```
/// use farsa_nn::{CtrnnLayout, Integrator};
///
/// // Seven sensory, five inner, two motor neurons. Each input has its own neuron.
/// const AGENT: CtrnnLayout = CtrnnLayout::new(7, 14, 2).with_direct_inputs(0).with_integrator(Integrator::RungeKutta4);
/// assert_eq!(AGENT.parameter_count(), 14 * 14 + 3 * 14);
/// assert_eq!(AGENT.output_neurons(), 12..14);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CtrnnLayout {
    inputs: usize,
    neurons: usize,
    outputs: usize,
    /// The first neuron of direct inputs, `None` if they are weighted.
    direct: Option<usize>,
    first_output: usize,
    integrator: Integrator,
    activation: Activation,
}

/// The parameters of a [`CtrnnLayout`], separated by kind. This is the result of [`CtrnnLayout::split`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CtrnnParts<'a> {
    /// Weights from the inputs `[inputs x neurons]`. The slice is empty if inputs are direct.
    pub input_weights: &'a [f32],
    /// Weights between neurons `[neurons x neurons]`.
    pub weights: &'a [f32],
    /// Biases of all neurons.
    pub biases: &'a [f32],
    /// Gains of all neurons.
    pub gains: &'a [f32],
    /// Time constants of all neurons in seconds.
    pub time_constants: &'a [f32],
}

impl CtrnnLayout {
    /// Creates a layout with weighted inputs. The last neurons are the outputs. By default, the integrator is
    /// [`Integrator::Euler`] and the activation function is [`Activation::Logistic`].
    pub const fn new(inputs: usize, neurons: usize, outputs: usize) -> Self {
        Self {
            inputs,
            neurons,
            outputs,
            direct: None,
            first_output: neurons.saturating_sub(outputs),
            integrator: Integrator::Euler,
            activation: Activation::Logistic,
        }
    }

    /// Changes input `k` to the external input of neuron `first + k`, without a weight.
    ///
    /// The neurons are checked by [`Ctrnn::new`](crate::Ctrnn::new).
    pub const fn with_direct_inputs(self, first: usize) -> Self {
        Self { direct: Some(first), ..self }
    }

    /// Selects the neurons that are outputs, starting at neuron `first`.
    ///
    /// The neurons are checked by [`Ctrnn::new`](crate::Ctrnn::new).
    pub const fn with_outputs_from(self, first: usize) -> Self {
        Self { first_output: first, ..self }
    }

    /// Sets the integrator.
    pub const fn with_integrator(self, integrator: Integrator) -> Self {
        Self { integrator, ..self }
    }

    /// Sets the activation function of all neurons.
    pub const fn with_activation(self, activation: Activation) -> Self {
        Self { activation, ..self }
    }

    /// Gets the number of inputs.
    pub const fn inputs(&self) -> usize {
        self.inputs
    }

    /// Gets the number of neurons.
    pub const fn neurons(&self) -> usize {
        self.neurons
    }

    /// Gets the number of outputs.
    pub const fn outputs(&self) -> usize {
        self.outputs
    }

    /// Returns the neurons that receive direct inputs, or `None` if inputs are weighted.
    pub const fn direct_inputs(&self) -> Option<Range<usize>> {
        match self.direct {
            Some(first) => Some(first..first.saturating_add(self.inputs)),
            None => None,
        }
    }

    /// Returns the neurons that are outputs.
    pub const fn output_neurons(&self) -> Range<usize> {
        self.first_output..self.first_output.saturating_add(self.outputs)
    }

    /// Gets the integrator.
    pub const fn integrator(&self) -> Integrator {
        self.integrator
    }

    /// Gets the activation function.
    pub const fn activation(&self) -> Activation {
        self.activation
    }

    /// Returns the number of parameters. This is `m*n + n*n + 3*n`.
    pub const fn parameter_count(&self) -> usize {
        self.range(CtrnnParameter::TimeConstant).end
    }

    /// Returns the length of the state. This is `5*n` for direct inputs and `4*n + m` for weighted ones. With
    /// [`Integrator::RungeKutta4`] it is larger by `2*n`.
    ///
    /// The state contains the states `y` `[neurons]`, the outputs `o` `[neurons]`, the coefficients of the time
    /// constants `[neurons]`, a workspace for sums `[neurons]`, the inputs, and the workspace of the integrator. Only
    /// `y` is memory. Everything else is computed from it and from the parameters.
    pub const fn state_len(&self) -> usize {
        let inputs = if self.direct.is_some() { self.neurons } else { self.inputs };
        let vectors = if matches!(self.integrator, Integrator::RungeKutta4) { 6 } else { 4 };
        self.neurons.saturating_mul(vectors).saturating_add(inputs)
    }

    /// Returns the indices of all parameters of a kind.
    pub const fn range(&self, kind: CtrnnParameter) -> Range<usize> {
        let n = self.neurons;
        let weights = if self.direct.is_some() { 0 } else { self.inputs.saturating_mul(n) };
        let biases = weights.saturating_add(n.saturating_mul(n));
        let gains = biases.saturating_add(n);
        let time_constants = gains.saturating_add(n);
        match kind {
            CtrnnParameter::InputWeight => 0..weights,
            CtrnnParameter::Weight => weights..biases,
            CtrnnParameter::Bias => biases..gains,
            CtrnnParameter::Gain => gains..time_constants,
            CtrnnParameter::TimeConstant => time_constants..time_constants.saturating_add(n),
        }
    }

    /// Returns the kind of the parameter at the given index, or `None` if there is no such parameter.
    pub fn kind(&self, index: usize) -> Option<CtrnnParameter> {
        CtrnnParameter::ALL.into_iter().find(|&kind| self.range(kind).contains(&index))
    }

    /// Returns an iterator over the kinds of all parameters. This is useful for decoding a genome.
    ///
    /// ```
    /// use farsa_nn::{CtrnnLayout, CtrnnParameter};
    ///
    /// let layout = CtrnnLayout::new(2, 3, 1);
    /// let genes = [0.5_f32; 24];
    /// let mut parameters = [0.0_f32; 24];
    /// for ((p, gene), kind) in parameters.iter_mut().zip(genes).zip(layout.kinds()) {
    ///     *p = match kind {
    ///         CtrnnParameter::Gain => 1.0,
    ///         CtrnnParameter::TimeConstant => 1.0 + gene,
    ///         _ => 32.0 * gene - 16.0,
    ///     };
    /// }
    /// assert_eq!(layout.split(&parameters).time_constants, [1.5; 3]);
    /// ```
    pub fn kinds(&self) -> impl Iterator<Item = CtrnnParameter> + use<> {
        let layout = *self;
        CtrnnParameter::ALL.into_iter().flat_map(move |kind| core::iter::repeat_n(kind, layout.range(kind).len()))
    }

    /// Separates parameters by kind. The length of the slice should be [`parameter_count`](Self::parameter_count).
    ///
    /// If the slice is too short, the last kinds are truncated. Additional parameters are ignored.
    pub fn split<'a>(&self, parameters: &'a [f32]) -> CtrnnParts<'a> {
        let part = |kind| {
            let Range { start, end } = self.range(kind);
            parameters.get(start..end.min(parameters.len())).unwrap_or(&[])
        };
        CtrnnParts {
            input_weights: part(CtrnnParameter::InputWeight),
            weights: part(CtrnnParameter::Weight),
            biases: part(CtrnnParameter::Bias),
            gains: part(CtrnnParameter::Gain),
            time_constants: part(CtrnnParameter::TimeConstant),
        }
    }
}
