//! The shape of a continuous-time recurrent network and the order of its parameters.

use core::ops::Range;

use crate::activation::Activation;
use crate::ctrnn::integrator::Integrator;

/// The kind of a parameter of a [`CtrnnLayout`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum CtrnnParameter {
    /// `s_ki`: from input `k` to neuron `i`.
    InputWeight,
    /// `w_ji`: from neuron `j` to neuron `i`.
    Weight,
    /// `theta_i`: added to the state of neuron `i`.
    Bias,
    /// `g_i`: the gain of neuron `i`, 1 in an experiment without gains.
    Gain,
    /// `tau_i` [s]: the time constant of neuron `i`.
    TimeConstant,
}

impl CtrnnParameter {
    /// Every kind, in the order of the parameters.
    pub const ALL: [Self; 5] = [Self::InputWeight, Self::Weight, Self::Bias, Self::Gain, Self::TimeConstant];
}

/// The layout of a [`Ctrnn`](crate::Ctrnn): numbers of inputs `m`, neurons `n` and outputs, the neurons of inputs and outputs, and
/// the integrator.
///
/// Weighted inputs reach every neuron. A direct input `k` is the external input of one neuron. The neurons of direct inputs are
/// one range, and so are those of the outputs.
///
/// The parameters are one slice, source-major: all targets of one source together. `m` counts 0 if inputs are direct.
///
/// | kind | count | at |
/// |---|---|---|
/// | [`InputWeight`](CtrnnParameter::InputWeight) | `m*n` | `k*n + i`, input `k` to neuron `i` |
/// | [`Weight`](CtrnnParameter::Weight) | `n*n` | `m*n + j*n + i`, neuron `j` to neuron `i` |
/// | [`Bias`](CtrnnParameter::Bias) | `n` | `m*n + n*n + i` |
/// | [`Gain`](CtrnnParameter::Gain) | `n` | `m*n + n*n + n + i` |
/// | [`TimeConstant`](CtrnnParameter::TimeConstant) | `n` | `m*n + n*n + 2*n + i` |
///
/// Counts saturate, as those of a [`LeakyLayout`](crate::LeakyLayout).
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

/// The parameters of a [`CtrnnLayout`] by kind, as returned by [`CtrnnLayout::split`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CtrnnParts<'a> {
    /// Weights from the inputs `[inputs x neurons]`, empty if inputs are direct.
    pub input_weights: &'a [f32],
    /// Weights between neurons `[neurons x neurons]`.
    pub weights: &'a [f32],
    /// Biases `[neurons]`.
    pub biases: &'a [f32],
    /// Gains `[neurons]`.
    pub gains: &'a [f32],
    /// Time constants `[neurons]` [s].
    pub time_constants: &'a [f32],
}

impl CtrnnLayout {
    /// Builds a layout with weighted inputs and the outputs of the last neurons. The integrator is [`Integrator::Euler`], the
    /// activation [`Activation::Logistic`].
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

    /// Makes input `k` the external input of neuron `first + k`, without weights.
    ///
    /// [`Ctrnn::new`](crate::Ctrnn::new) checks that the neurons exist.
    pub const fn with_direct_inputs(self, first: usize) -> Self {
        Self { direct: Some(first), ..self }
    }

    /// Uses the outputs of the neurons from `first` on.
    ///
    /// [`Ctrnn::new`](crate::Ctrnn::new) checks that the neurons exist.
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

    /// Number of inputs.
    pub const fn inputs(&self) -> usize {
        self.inputs
    }

    /// Number of neurons.
    pub const fn neurons(&self) -> usize {
        self.neurons
    }

    /// Number of outputs.
    pub const fn outputs(&self) -> usize {
        self.outputs
    }

    /// The neurons of direct inputs, `None` if inputs are weighted.
    pub const fn direct_inputs(&self) -> Option<Range<usize>> {
        match self.direct {
            Some(first) => Some(first..first.saturating_add(self.inputs)),
            None => None,
        }
    }

    /// The neurons of the outputs.
    pub const fn output_neurons(&self) -> Range<usize> {
        self.first_output..self.first_output.saturating_add(self.outputs)
    }

    /// The integrator.
    pub const fn integrator(&self) -> Integrator {
        self.integrator
    }

    /// The activation function.
    pub const fn activation(&self) -> Activation {
        self.activation
    }

    /// Number of parameters, `m*n + n*n + 3*n`.
    pub const fn parameter_count(&self) -> usize {
        self.range(CtrnnParameter::TimeConstant).end
    }

    /// Length of the state: `5*n` for direct inputs, `4*n + m` for weighted ones, and `2*n` more for
    /// [`Integrator::RungeKutta4`].
    ///
    /// The order is: states `y` `[neurons]`, outputs `o` `[neurons]`, coefficients of the time constants `[neurons]`, workspace
    /// of the sums `[neurons]`, inputs, workspace of the integrator. Only `y` is memory. The rest follows from it and from the
    /// parameters.
    pub const fn state_len(&self) -> usize {
        let inputs = if self.direct.is_some() { self.neurons } else { self.inputs };
        let vectors = if matches!(self.integrator, Integrator::RungeKutta4) { 6 } else { 4 };
        self.neurons.saturating_mul(vectors).saturating_add(inputs)
    }

    /// The indices of the parameters of one kind.
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

    /// The kind of the parameter at this index, `None` beyond the last.
    pub fn kind(&self, index: usize) -> Option<CtrnnParameter> {
        CtrnnParameter::ALL.into_iter().find(|&kind| self.range(kind).contains(&index))
    }

    /// The kind of each parameter, in their order, for decoding a genome.
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

    /// Splits parameters [[`parameter_count`](Self::parameter_count)] by kind.
    ///
    /// A slice that is too short truncates the last kinds. Extra parameters are ignored.
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
