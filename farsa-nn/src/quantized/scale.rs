//! The scale of a fixed-point network, and the conversion of real parameters.

use farsa_num::Scalar;

use crate::error::Error;
use crate::fault::{LayoutFault, ParameterFault, Slice};
use crate::leak::Leak;
use crate::leaky_layout::{LeakyLayout, LeakyParameter};
use crate::leaky_network::LeakyModel;
use crate::network::Model as _;
use crate::quantized::logistic::{ACTIVATION_BITS, ARGUMENT_BITS};

/// Fraction bits of leaks: 2^14 is exactly 1.
pub(crate) const LEAK_BITS: u32 = 14;

/// The positions of the binary points in a [`QuantizedNetwork`](crate::quantized::QuantizedNetwork). An integer `v`
/// with `b` fraction bits represents `v / 2^b`.
///
/// | integers | fraction bits |
/// |---|---|
/// | sensor values, `i16` | [`input_bits`](Self::input_bits), chosen by the caller: 9 cover [-64, 64) in steps of 0.002 |
/// | weights and biases, `i16`, times the layout's slope | [`weight_bits`](Self::weight_bits) |
/// | sums, `i32`: arguments of the logistic function | [`sum_bits`](Self::sum_bits) |
/// | leaks, `i16` | 14 |
/// | motor values, `i16`, and responses | 15. The largest motor value is 32767, the largest response 32768 |
/// | activations between steps, `i32` | 30 |
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "SavedScale"))]
pub struct QuantizedScale {
    inputs: u8,
    weights: u8,
    sums: u8,
}

/// A scale before its check.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(rename = "QuantizedScale")]
struct SavedScale {
    inputs: u8,
    weights: u8,
    sums: u8,
}

#[cfg(feature = "serde")]
impl TryFrom<SavedScale> for QuantizedScale {
    type Error = Error;

    fn try_from(saved: SavedScale) -> Result<Self, Error> {
        Self::new(saved.inputs.into(), saved.weights.into(), saved.sums.into())
    }
}

impl QuantizedScale {
    /// Smallest number of fraction bits of a sum. With fewer than 10 bits, the error of the logistic function
    /// would exceed 1e-4.
    pub const SUM_BITS_MIN: u32 = 10;

    /// Creates a scale from stored numbers of fraction bits.
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if inputs or weights have more than 15 fraction bits. The same error is returned if
    /// the number for sums is outside 10..=20 or larger than that of a product of a weight and an input.
    pub const fn new(input_bits: u32, weight_bits: u32, sum_bits: u32) -> Result<Self, Error> {
        if input_bits > 15 {
            return Err(fraction_bits("inputs", input_bits, 0, 15));
        }
        if weight_bits > 15 {
            return Err(fraction_bits("weights", weight_bits, 0, 15));
        }
        let product = input_bits + weight_bits;
        let most = if product < ARGUMENT_BITS { product } else { ARGUMENT_BITS };
        if sum_bits < Self::SUM_BITS_MIN || sum_bits > most {
            return Err(fraction_bits("sums", sum_bits, Self::SUM_BITS_MIN, most));
        }
        Ok(Self { inputs: input_bits as u8, weights: weight_bits as u8, sums: sum_bits as u8 })
    }

    /// Converts the parameters of a [`LeakyNetwork`](crate::LeakyNetwork) to the integers of a
    /// [`QuantizedNetwork`](crate::quantized::QuantizedNetwork). Sensor values must have `input_bits` fraction bits.
    ///
    /// Weights and biases get as many fraction bits as possible, but at most 15. The largest of them, multiplied by the
    /// slope, must fit into an `i16`. Sums also get as many fraction bits as possible, but at most 20. No sensor values
    /// may cause an overflow.
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if the slope or the fraction bits are invalid, [`Error::Length`] if a slice has the
    /// wrong length, or [`Error::Parameter`]. The latter is also returned for a weight that exceeds 32767 after
    /// multiplication by the slope. Returns [`Error::Sum`] if sums with 10 fraction bits could overflow. In these cases
    /// `fixed` may have been partly written.
    ///
    /// ```
    /// use farsa_nn::quantized::{QuantizedNetwork, QuantizedScale};
    /// use farsa_nn::{Leak, LeakyLayout};
    ///
    /// const LAYOUT: LeakyLayout = LeakyLayout::new(1, 1, 1);
    /// let mut fixed = [0; LAYOUT.parameter_count()];
    /// let scale = QuantizedScale::quantize(&LAYOUT, 9, &[6.0, 0.0, -3.0, 0.0, 0.5], &mut fixed)?;
    /// // 0.2 * 6 = 1.2 is 19661 / 2^14.
    /// assert_eq!((scale.weight_bits(), fixed), (14, [19661, 0, -9830, 0, 8192]));
    /// let mut network = QuantizedNetwork::new(LAYOUT, Leak::Filter, scale, fixed, [0; LAYOUT.state_len()])?;
    /// let mut y = [0];
    /// network.step_quantized(&[512], &mut y); // x = 1
    /// assert_eq!(y, [14504]); // 0.4426
    /// # Ok::<(), farsa_nn::Error>(())
    /// ```
    pub fn quantize(
        layout: &LeakyLayout,
        input_bits: u32,
        parameters: &[f32],
        fixed: &mut [i16],
    ) -> Result<Self, Error> {
        let slope = layout.slope();
        LeakyModel { layout: *layout, leak: Leak::Filter }.check_model(parameters, |p| p)?;
        Slice::Parameters.check(parameters.len(), fixed.len())?;
        if input_bits > 15 {
            return Err(fraction_bits("inputs", input_bits, 0, 15));
        }
        let leaks = layout.range(LeakyParameter::Leak);
        let (weights, fixed_weights) = (&parameters[..leaks.start], &mut fixed[..leaks.start]);
        // Exact in double precision.
        let sloped = |weight: f32| f64::from(weight) * f64::from(slope);
        let mut weight_bits = 15;
        for (index, weight) in weights.iter().enumerate() {
            while rounded(sloped(*weight), weight_bits).abs() > 32767.0 {
                if weight_bits == 0 {
                    return Err(ParameterFault::Weight(sloped(*weight)).at(index));
                }
                weight_bits -= 1;
            }
        }
        for (fixed, weight) in fixed_weights.iter_mut().zip(weights) {
            *fixed = rounded(sloped(*weight), weight_bits) as i16;
        }
        for (fixed, leak) in fixed[leaks.clone()].iter_mut().zip(&parameters[leaks]) {
            *fixed = rounded(f64::from(*leak), LEAK_BITS) as i16;
        }
        let most = ARGUMENT_BITS.min(input_bits + weight_bits);
        let mut sum_bits = most;
        loop {
            let scale = Self::new(input_bits, weight_bits, sum_bits)?;
            match scale.check_sums(layout, fixed, |fixed| fixed) {
                Err(_) if sum_bits > Self::SUM_BITS_MIN => sum_bits -= 1,
                result => return result.map(|()| scale),
            }
        }
    }

    /// Returns the number of fraction bits of the sensor values.
    pub const fn input_bits(self) -> u32 {
        self.inputs as u32
    }

    /// Returns the number of fraction bits of weights and biases. Their values include the slope.
    pub const fn weight_bits(self) -> u32 {
        self.weights as u32
    }

    /// Returns the number of fraction bits of the sums.
    pub const fn sum_bits(self) -> u32 {
        self.sums as u32
    }

    /// Rounds a sensor value to an integer. Values outside the range of `i16` are clamped, and NaN results in 0.
    pub fn input(self, x: f32) -> i16 {
        // Single precision, because processors without floating-point arithmetic run this too.
        let x = x * f32::from(1_u16 << self.input_bits());
        x.clamp(-32768.0, 32767.0).round_small() as i16
    }

    /// Converts a motor value to a real number.
    pub fn output(y: i16) -> f32 {
        f32::from(y) * (1.0 / 32768.0)
    }

    /// Right shift of a product of a sensor value and its weight before the addition.
    pub(crate) const fn input_shift(self) -> u32 {
        self.input_bits() + self.weight_bits() - self.sum_bits()
    }

    /// Right shift of a product of an activation and its weight before the addition.
    pub(crate) const fn activation_shift(self) -> u32 {
        ACTIVATION_BITS + self.weight_bits() - self.sum_bits()
    }

    /// Checks that every sum fits an `i32` for all sensor values. `value` decodes a parameter.
    pub(crate) fn check_sums<T: Copy>(
        self,
        layout: &LeakyLayout,
        fixed: &[T],
        value: impl Fn(T) -> i16,
    ) -> Result<(), Error> {
        let part = |kind| fixed.get(layout.range(kind)).unwrap_or(&[]);
        // The largest sensor value and the largest activation are both 2^15. A shifted product is rounded down, so the
        // magnitude of a negative one may be larger by one.
        let largest = |weights: &[T], target: usize, targets: usize, shift: u32| {
            let products = weights.iter().skip(target).step_by(targets.max(1));
            products.map(|w| ((u64::from(value(*w).unsigned_abs()) << 15) >> shift) + 1).sum::<u64>()
        };
        let (h, o) = (layout.hidden(), layout.outputs());
        let (input, activation) = (self.input_shift(), self.activation_shift());
        let hidden = (0..h).map(|i| {
            largest(part(LeakyParameter::SensorWeight), i, h, input)
                + largest(part(LeakyParameter::RecurrentWeight), i, h, activation)
                + largest(part(LeakyParameter::Bias), i, h, activation)
        });
        // Without hidden neurons outputs have no weights, and untrusted bytes may have any number of them.
        let weights = part(LeakyParameter::OutputWeight);
        let outputs = (0..o.min(weights.len())).map(|i| largest(weights, i, o, activation));
        let limit = i32::MAX as u64;
        match hidden.chain(outputs).enumerate().find(|(_, sum)| *sum > limit) {
            Some((target, largest)) => Err(Error::Sum { target, largest, limit }),
            None => Ok(()),
        }
    }
}

/// The error of an invalid number of fraction bits.
const fn fraction_bits(of: &'static str, found: u32, least: u32, most: u32) -> Error {
    Error::Layout(LayoutFault::FractionBits { of, found, least, most })
}

/// Rounds `x` in units of 2^-bits, ties to even, up to 2^51. Larger numbers stay large.
fn rounded(x: f64, bits: u32) -> f64 {
    (x * f64::from(1_u32 << bits)).round_small()
}
