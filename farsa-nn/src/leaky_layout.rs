//! The layout of a network with three layers. It also defines the order of the parameters.

use core::ops::Range;

/// The kind of a parameter in a [`LeakyLayout`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum LeakyParameter {
    /// Weight `w_ji` from sensor `j` to hidden neuron `i`.
    SensorWeight,
    /// Weight `r_ki` from hidden neuron `k` in the previous step to hidden neuron `i`.
    RecurrentWeight,
    /// Weight `w_ji` from hidden neuron `j` to output `i`.
    OutputWeight,
    /// Bias `beta_i` added to the net input of hidden neuron `i`.
    Bias,
    /// Leak `d_i` of hidden neuron `i` [0..1]. It is interpreted according to a [`Leak`](crate::Leak).
    Leak,
}

impl LeakyParameter {
    /// All kinds in the order of the parameters.
    pub const ALL: [Self; 5] = [Self::SensorWeight, Self::RecurrentWeight, Self::OutputWeight, Self::Bias, Self::Leak];
}

/// The layout of a [`LeakyNetwork`](crate::LeakyNetwork). It consists of the numbers of sensors `n`, hidden neurons
/// `h` and outputs `o`, and of the slope of its logistic function.
///
/// All parameters are stored in one slice. Weights are ordered by source, so the weights to all targets of a source are
/// consecutive.
///
/// | kind | count | at |
/// |---|---|---|
/// | [`SensorWeight`](LeakyParameter::SensorWeight) | `n*h` | `j*h + i`, sensor `j` to hidden `i` |
/// | [`RecurrentWeight`](LeakyParameter::RecurrentWeight) | `h*h` | `n*h + k*h + i`, hidden `k` to hidden `i` |
/// | [`OutputWeight`](LeakyParameter::OutputWeight) | `h*o` | `n*h + h*h + j*o + i`, hidden `j` to output `i` |
/// | [`Bias`](LeakyParameter::Bias) | `h` | `n*h + h*h + h*o + i` |
/// | [`Leak`](LeakyParameter::Leak) | `h` | `n*h + h*h + h*o + h + i` |
///
/// All counts saturate. If a layout is too large for the machine, it has `usize::MAX` parameters. No slice can
/// contain them.
///
/// Source: `[Ferrauto2010]` chapter 2. It has the totals 792 and 756 but not the order.
///
/// ```
/// use farsa_nn::LeakyLayout;
///
/// const LABELS: LeakyLayout = LeakyLayout::new(29, 12, 23);
/// const NO_LABELS: LeakyLayout = LeakyLayout::new(26, 12, 23);
/// assert_eq!(LABELS.parameter_count(), 792);
/// assert_eq!(NO_LABELS.parameter_count(), 756);
/// static ZEROS: [f32; LABELS.parameter_count()] = [0.0; LABELS.parameter_count()];
/// ```
// In source-major order a vector of targets reads neighboring weights. Every target adds its sources in the same order, so the
// width of the vectors does not change a bit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LeakyLayout {
    sensors: usize,
    hidden: usize,
    outputs: usize,
    slope: f32,
}

/// The parameters of a [`LeakyLayout`], separated by kind. This is the result of [`LeakyLayout::split`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LeakyParts<'a> {
    /// Weights from the sensors `[sensors x hidden]`.
    pub sensor_weights: &'a [f32],
    /// Weights from the hidden neurons in the previous step `[hidden x hidden]`.
    pub recurrent_weights: &'a [f32],
    /// Weights to the outputs `[hidden x outputs]`.
    pub output_weights: &'a [f32],
    /// Biases of the hidden neurons.
    pub biases: &'a [f32],
    /// Leaks of the hidden neurons.
    pub leaks: &'a [f32],
}

impl LeakyLayout {
    /// Default slope of the logistic function (`[Ferrauto2010]` chapter 2).
    pub const SLOPE: f32 = 0.2;

    /// Creates a layout with the default slope [`LeakyLayout::SLOPE`].
    pub const fn new(sensors: usize, hidden: usize, outputs: usize) -> Self {
        Self { sensors, hidden, outputs, slope: Self::SLOPE }
    }

    /// Sets the slope of `sigma(x) = 1/(1 + exp(-slope*x))`.
    ///
    /// It is checked by [`LeakyNetwork::new`](crate::LeakyNetwork::new) and must be finite.
    pub const fn with_slope(self, slope: f32) -> Self {
        Self { slope, ..self }
    }

    /// Gets the number of sensors.
    pub const fn sensors(&self) -> usize {
        self.sensors
    }

    /// Gets the number of hidden neurons.
    pub const fn hidden(&self) -> usize {
        self.hidden
    }

    /// Gets the number of outputs.
    pub const fn outputs(&self) -> usize {
        self.outputs
    }

    /// Gets the slope of the logistic function of hidden neurons and outputs.
    pub const fn slope(&self) -> f32 {
        self.slope
    }

    /// Returns the number of parameters. This is `n*h + h*h + h*o + h + h`.
    pub const fn parameter_count(&self) -> usize {
        self.range(LeakyParameter::Leak).end
    }

    /// Returns the length of the state. This is `3*h`.
    ///
    /// The state contains the activations `H(t)` `[hidden]`, the responses `y(t)` `[hidden]` and a workspace for sums
    /// `[hidden]`. The responses are used by [`Leak::TwoTap`](crate::Leak::TwoTap) and are zero otherwise.
    pub const fn state_len(&self) -> usize {
        self.hidden.saturating_mul(3)
    }

    /// Returns the indices of all parameters of a kind.
    pub const fn range(&self, kind: LeakyParameter) -> Range<usize> {
        let h = self.hidden;
        let recurrent = self.sensors.saturating_mul(h);
        let output = recurrent.saturating_add(h.saturating_mul(h));
        let bias = output.saturating_add(h.saturating_mul(self.outputs));
        let leak = bias.saturating_add(h);
        match kind {
            LeakyParameter::SensorWeight => 0..recurrent,
            LeakyParameter::RecurrentWeight => recurrent..output,
            LeakyParameter::OutputWeight => output..bias,
            LeakyParameter::Bias => bias..leak,
            LeakyParameter::Leak => leak..leak.saturating_add(h),
        }
    }

    /// Returns the kind of the parameter at the given index, or `None` if there is no such parameter.
    pub fn kind(&self, index: usize) -> Option<LeakyParameter> {
        LeakyParameter::ALL.into_iter().find(|&kind| self.range(kind).contains(&index))
    }

    /// Returns an iterator over the kinds of all parameters. This is useful for decoding a genome.
    ///
    /// ```
    /// use farsa_nn::{LeakyLayout, LeakyParameter};
    ///
    /// let layout = LeakyLayout::new(29, 12, 23);
    /// let genes = [0.5_f32; 792];
    /// let mut parameters = [0.0_f32; 792];
    /// for ((p, gene), kind) in parameters.iter_mut().zip(genes).zip(layout.kinds()) {
    ///     *p = if kind == LeakyParameter::Leak { gene } else { 12.0 * gene - 6.0 };
    /// }
    /// assert_eq!(layout.split(&parameters).leaks, [0.5; 12]);
    /// assert_eq!(layout.split(&parameters).biases, [0.0; 12]);
    /// ```
    pub fn kinds(&self) -> impl Iterator<Item = LeakyParameter> + use<> {
        let layout = *self;
        LeakyParameter::ALL.into_iter().flat_map(move |kind| core::iter::repeat_n(kind, layout.range(kind).len()))
    }

    /// Separates parameters by kind. The length of the slice should be [`parameter_count`](Self::parameter_count).
    ///
    /// If the slice is too short, the last kinds are truncated. Additional parameters are ignored.
    #[inline]
    pub fn split<'a>(&self, parameters: &'a [f32]) -> LeakyParts<'a> {
        let part = |kind| {
            let Range { start, end } = self.range(kind);
            parameters.get(start..end.min(parameters.len())).unwrap_or(&[])
        };
        LeakyParts {
            sensor_weights: part(LeakyParameter::SensorWeight),
            recurrent_weights: part(LeakyParameter::RecurrentWeight),
            output_weights: part(LeakyParameter::OutputWeight),
            biases: part(LeakyParameter::Bias),
            leaks: part(LeakyParameter::Leak),
        }
    }
}
