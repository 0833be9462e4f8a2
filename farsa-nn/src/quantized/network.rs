//! The leaky recurrent network in integer arithmetic.

use crate::controller::Controller;
use crate::error::Error;
use crate::fault::{ParameterFault, Slice};
use crate::kernel::prefix;
use crate::leak::Leak;
use crate::leaky_layout::{LeakyLayout, LeakyParameter};
use crate::quantized::logistic::{ACTIVATION_BITS, logistic};
use crate::quantized::scale::{LEAK_BITS, QuantizedScale};

/// Number of outputs that are summed together.
const BLOCK: usize = 8;

/// Fraction bits of activations between steps. The lower half of them lets a slow neuron move.
const STATE_BITS: u32 = 30;

/// A [`LeakyNetwork`](crate::LeakyNetwork) with 16-bit parameters and 32-bit sums. A step uses neither floating-point
/// numbers nor divisions, and no multiplication is wider than 32 bits.
///
/// Use [`QuantizedScale::quantize`] to convert the parameters of a `LeakyNetwork` with the same layout. The resulting
/// weights include the slope of the logistic function, so the slope of the layout is not used. Each product is rounded
/// once,
///
/// ```text
/// net_i = sum_j (w_ji I_j >> s) + sum_k (r_ki H_k >> s') + (beta_i >> s')
/// ```
///
/// and the results are added as integers. Therefore the order of the sums does not matter. The constructor checks that
/// no sum can overflow. The measured effect on motor values is documented in the README of the crate.
///
/// As a [`Controller`], the network reads and writes `f32`. Sensor values are clamped to the range defined by
/// [`input_bits`](QuantizedScale::input_bits). Motor values are multiples of 2^-15 in [0, 1 - 2^-15].
///
/// Source: the equations of [`LeakyNetwork`](crate::LeakyNetwork), `[Ferrauto2010]` chapter 2. Deviation: the
/// arithmetic.
#[derive(Clone, Debug)]
pub struct QuantizedNetwork<P, S> {
    layout: LeakyLayout,
    leak: Leak,
    scale: QuantizedScale,
    parameters: P,
    state: S,
}

impl<P: AsRef<[i16]>, S: AsMut<[i32]>> QuantizedNetwork<P, S> {
    /// Creates a network with the given parameters and resets its state to zero. The slices must have the lengths
    /// [`parameter_count`](LeakyLayout::parameter_count) and [`state_len`](LeakyLayout::state_len).
    ///
    /// # Errors
    /// Returns [`Error::Length`], [`Error::Parameter`] or [`Error::Sum`].
    pub fn new(
        layout: LeakyLayout,
        leak: Leak,
        scale: QuantizedScale,
        parameters: P,
        mut state: S,
    ) -> Result<Self, Error> {
        check(&layout, scale, parameters.as_ref(), |fixed| fixed)?;
        Slice::State.check(layout.state_len(), state.as_mut().len())?;
        state.as_mut().fill(0);
        Ok(Self { layout, leak, scale, parameters, state })
    }

    /// Replaces the parameters and their scale, and returns the previous parameters. Since the units of the state are
    /// the same for all scales, the state is not changed.
    ///
    /// # Errors
    /// Returns [`Error::Length`], [`Error::Parameter`] or [`Error::Sum`]. In this case the network is unchanged.
    pub fn set_parameters(&mut self, scale: QuantizedScale, parameters: P) -> Result<P, Error> {
        check(&self.layout, scale, parameters.as_ref(), |fixed| fixed)?;
        self.scale = scale;
        Ok(core::mem::replace(&mut self.parameters, parameters))
    }

    /// Copies new parameters with the given scale into the network. The state is not changed.
    ///
    /// # Errors
    /// Returns [`Error::Length`], [`Error::Parameter`] or [`Error::Sum`]. In this case the network is unchanged.
    pub fn copy_parameters(&mut self, scale: QuantizedScale, parameters: &[i16]) -> Result<(), Error>
    where
        P: AsMut<[i16]>,
    {
        check(&self.layout, scale, parameters, |fixed| fixed)?;
        self.scale = scale;
        self.parameters.as_mut().iter_mut().zip(parameters).for_each(|(to, p)| *to = *p);
        Ok(())
    }

    /// Advances the network by one tick. It reads the sensor values `x` in units of
    /// 2^-[`input_bits`](QuantizedScale::input_bits) and overwrites the motor values `y`. They are in 0..=32767 in
    /// units of 2^-15.
    ///
    /// All integers are valid sensor values. If a slice has the wrong length, the shorter length is used.
    ///
    /// # Panics
    /// Panics if a slice has a different length and debug assertions are enabled.
    pub fn step_quantized(&mut self, x: &[i16], y: &mut [i16]) {
        debug_assert_eq!(x.len(), self.layout.sensors(), "sensor values and the layout's sensors");
        debug_assert_eq!(y.len(), self.layout.outputs(), "motor values and the layout's outputs");
        self.advance(x.iter().copied(), y, |motor| motor);
    }

    /// Advances from sensor values to motor values. The function `write` converts them.
    // Each sensor value is read once, so a float is converted once.
    #[inline(always)]
    fn advance<Y>(&mut self, x: impl Iterator<Item = i16>, y: &mut [Y], write: impl Fn(i16) -> Y) {
        let Self { layout, leak, scale, parameters, state } = self;
        let fixed = parameters.as_ref();
        let part = |kind| fixed.get(layout.range(kind)).unwrap_or(&[]);
        let (count, state) = (layout.hidden(), state.as_mut());
        let (hidden, state) = state.split_at_mut(count.min(state.len()));
        let (previous, sums) = state.split_at_mut(count.min(state.len()));
        // An empty row would be an invalid chunk.
        let row_len = count.max(1);

        // The bias is the weight of a source that is always 1.
        let shift = scale.activation_shift();
        for (sum, bias) in sums.iter_mut().zip(part(LeakyParameter::Bias)) {
            *sum = product(*bias, 1 << ACTIVATION_BITS, shift);
        }
        for (h, row) in hidden.iter().zip(part(LeakyParameter::RecurrentWeight).chunks_exact(row_len)) {
            let source = activation(*h);
            for (sum, w) in sums.iter_mut().zip(row) {
                *sum += product(*w, source, shift);
            }
        }
        let shift = scale.input_shift();
        for (x, row) in x.zip(part(LeakyParameter::SensorWeight).chunks_exact(row_len)) {
            for (sum, w) in sums.iter_mut().zip(row) {
                *sum += product(*w, i32::from(x), shift);
            }
        }

        let neurons = hidden.iter_mut().zip(previous).zip(&*sums).zip(part(LeakyParameter::Leak));
        for (((h, previous), sum), d) in neurons {
            let response = logistic(*sum, scale.sum_bits()) << (STATE_BITS - ACTIVATION_BITS);
            let d = i32::from(*d);
            match leak {
                Leak::Filter => *h += share(d, response - *h),
                Leak::TwoTap => {
                    *h = *previous + share(d, response - *previous);
                    *previous = response;
                }
                Leak::Evonet => *h += share((1 << LEAK_BITS) - d, response - *h),
            }
        }

        // The sums are no longer needed.
        let sources = sums;
        for (source, h) in sources.iter_mut().zip(&*hidden) {
            *source = activation(*h);
        }
        let shift = scale.activation_shift();
        let outputs = layout.outputs();
        let rows = part(LeakyParameter::OutputWeight).chunks_exact(outputs.max(1));
        // Source by source, as above. The state has no room for the sums of all outputs.
        for (block, y) in prefix(y, outputs).chunks_mut(BLOCK).enumerate() {
            let mut sums = [0; BLOCK];
            for (source, row) in sources.iter().zip(rows.clone()) {
                for (sum, w) in sums.iter_mut().zip(row.get(block * BLOCK..).unwrap_or(&[])) {
                    *sum += product(*w, *source, shift);
                }
            }
            for (y, sum) in y.iter_mut().zip(sums) {
                // 1 is not an `i16` in these units.
                *y = write(logistic(sum, scale.sum_bits()).min(i32::from(i16::MAX)) as i16);
            }
        }
    }

    /// Gets the parameters of the network.
    pub fn parameters(&self) -> &[i16] {
        self.parameters.as_ref()
    }
}

impl<P, S> QuantizedNetwork<P, S> {
    /// Gets the layout of the network.
    pub const fn layout(&self) -> LeakyLayout {
        self.layout
    }

    /// Gets the interpretation of the leaks.
    pub const fn leak(&self) -> Leak {
        self.leak
    }

    /// Gets the scale that defines the positions of the binary points.
    pub const fn scale(&self) -> QuantizedScale {
        self.scale
    }

    /// Returns the parameters and the state of the network.
    pub fn into_parts(self) -> (P, S) {
        (self.parameters, self.state)
    }

    /// Returns the activations `H(t)` of the hidden neurons in units of 2^-30, from 0 to 2^30.
    pub fn hidden(&self) -> &[i32]
    where
        S: AsRef<[i32]>,
    {
        let state = self.state.as_ref();
        state.get(..self.layout.hidden()).unwrap_or(state)
    }
}

impl<P: AsRef<[i16]>, S: AsMut<[i32]>> Controller for QuantizedNetwork<P, S> {
    fn inputs(&self) -> usize {
        self.layout.sensors()
    }

    fn outputs(&self) -> usize {
        self.layout.outputs()
    }

    fn reset(&mut self) {
        self.state.as_mut().fill(0);
    }

    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        debug_assert_eq!(x.len(), self.layout.sensors(), "sensor values and the layout's sensors");
        debug_assert_eq!(y.len(), self.layout.outputs(), "motor values and the layout's outputs");
        let scale = self.scale;
        self.advance(x.iter().map(|x| scale.input(*x)), y, QuantizedScale::output);
    }
}

/// A weight times a source of at most 2^15, shifted right and rounded down.
#[inline(always)]
fn product(weight: i16, source: i32, shift: u32) -> i32 {
    (i32::from(weight) * source) >> shift
}

/// An activation as a source of the next layer, to the nearest of its units, 0..=2^15.
#[inline(always)]
fn activation(h: i32) -> i32 {
    (h + (1 << (STATE_BITS - ACTIVATION_BITS - 1))) >> (STATE_BITS - ACTIVATION_BITS)
}

/// The share `d` / 2^14, 0..=1, of a difference within 2^30, rounded down. The products of the two halves fit 32 bits.
#[inline(always)]
fn share(d: i32, difference: i32) -> i32 {
    const HALF: u32 = 15;
    ((d * (difference >> HALF)) << (HALF - LEAK_BITS)) + ((d * (difference & ((1 << HALF) - 1))) >> LEAK_BITS)
}

/// Checks the parameters of a network. The function `value` decodes them.
pub(crate) fn check<T: Copy>(
    layout: &LeakyLayout,
    scale: QuantizedScale,
    fixed: &[T],
    value: impl Fn(T) -> i16,
) -> Result<(), Error> {
    Slice::Parameters.check(layout.parameter_count(), fixed.len())?;
    let leaks = fixed.iter().enumerate().skip(layout.range(LeakyParameter::Leak).start).map(|(i, d)| (i, value(*d)));
    if let Some((index, d)) = leaks.into_iter().find(|(_, d)| !(0..=1 << LEAK_BITS).contains(d)) {
        return Err(ParameterFault::QuantizedLeak(d).at(index));
    }
    scale.check_sums(layout, fixed, value)
}
