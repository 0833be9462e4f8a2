//! The scalar type of generic numerical code. It contains either a single number or one number per lane.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

/// A truth value for each lane. It results from a comparison of [`Scalar`]s.
pub trait Mask: Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Returns true if at least one lane is true.
    fn any(self) -> bool;
    /// Returns true if all lanes are true.
    fn all(self) -> bool;
    /// Returns the truth value of one lane. It is false if the lane does not exist.
    fn lane(self, index: usize) -> bool;
}

/// The type of a single lane of a [`Scalar`]. It is `f32` or `f64`.
pub trait Real: Scalar<Real = Self, Mask = bool, Simd = ()> + PartialOrd + Default + Send + Sync + 'static {
    /// The number of binary digits of the significand. It is 24 for `f32` and 53 for `f64`.
    const DIGITS: u32;

    /// Converts a number to the nearest value of this type.
    fn from_f64(x: f64) -> Self;
    /// Converts the value to double precision. The conversion is always exact.
    fn to_f64(self) -> f64;
}

/// Arithmetic on one or more lanes. The bits of a lane do not depend on the number of lanes.
///
/// This trait is implemented by `f32` and `f64`, and for SIMD by `fearless_simd::f32x8` and `f32x16`. Generic code must
/// not use values in conditions. It computes a [`Mask`] by a comparison and selects between two results. Each operation
/// is rounded once per lane as in IEEE 754 and is never fused or approximated. Functions that use this trait should be
/// `#[inline(always)]`, so that they inherit the target features of the calling dispatch.
///
/// ```
/// use farsa_num::Scalar;
/// use farsa_num::fearless_simd::{Level, dispatch, f32x8};
///
/// /// The distance to a wall at 0, none behind it.
/// #[inline(always)]
/// fn distance<S: Scalar>(x: S) -> S {
///     let wall = x.constant(0.0);
///     S::select(x.lt(wall), wall, x)
/// }
///
/// assert_eq!(distance(-0.5_f32), 0.0);
/// dispatch!(Level::baseline(), simd => {
///     let places = [-1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, -6.0];
///     let mut distances = [0.0; 8];
///     distance(f32x8::load(simd, &places)).store(&mut distances);
///     assert_eq!(distances, [0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 0.0]);
/// });
/// ```
pub trait Scalar:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// The type of a single lane.
    type Real: Real;
    /// The result of a comparison.
    type Mask: Mask;
    /// A token that proves that the processor supports the instructions. It is `()` for a single lane.
    type Simd: Copy;
    /// The number of lanes.
    const LANES: usize;

    /// Creates a value in which all lanes contain the same number.
    fn splat(simd: Self::Simd, x: Self::Real) -> Self;
    /// Loads the first [`LANES`](Self::LANES) numbers of a slice.
    ///
    /// # Panics
    /// Panics if the slice is too short.
    fn load(simd: Self::Simd, from: &[Self::Real]) -> Self;
    /// Writes all lanes to the first [`LANES`](Self::LANES) elements of a slice.
    ///
    /// # Panics
    /// Panics if the slice is too short.
    fn store(self, to: &mut [Self::Real]);
    /// Returns the token with which the value was created.
    fn simd(self) -> Self::Simd;
    /// Returns the number in one lane.
    ///
    /// # Panics
    /// Panics if `index >= LANES`.
    fn lane(self, index: usize) -> Self::Real;
    /// Replaces the number in one lane.
    ///
    /// # Panics
    /// Panics if `index >= LANES`.
    fn set_lane(&mut self, index: usize, x: Self::Real);
    /// Calls a function that is compiled for the instructions of the token.
    ///
    /// This is useful for large pieces of code. They are then compiled only once and not in every caller. The closure
    /// must be `#[inline(always)]` to inherit the instructions.
    fn vectorize<T>(simd: Self::Simd, work: impl FnOnce() -> T) -> T;

    /// Computes the correctly rounded square root. It is NaN for negative numbers.
    fn sqrt(self) -> Self;
    /// Computes the absolute value by clearing the sign.
    fn abs(self) -> Self;
    /// Tests if `self < other`. The result is false if one of them is NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// Tests if `self <= other`. The result is false if one of them is NaN.
    fn le(self, other: Self) -> Self::Mask;
    /// Tests if `self > other`. The result is false if one of them is NaN.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// Tests if `self >= other`. The result is false if one of them is NaN.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }
    /// Selects `if_true` in lanes where the mask is true, and `if_false` in all other lanes.
    fn select(mask: Self::Mask, if_true: Self, if_false: Self) -> Self;
    /// Rounds to the nearest integer, with ties to even. The magnitude must be below 2^22 (`f32`) or 2^51 (`f64`).
    fn round_small(self) -> Self;
    /// Computes 2 to the power of an integer. The exponent must be within [-126, 127] (`f32`) or [-1022, 1023] (`f64`).
    /// Otherwise the result is unspecified.
    fn exp2_integer(self) -> Self;

    /// Returns a constant in all lanes. It is rounded once to the type of a lane.
    #[inline(always)]
    fn constant(self, x: f64) -> Self {
        Self::splat(self.simd(), Self::Real::from_f64(x))
    }
    /// Returns a number of the lane type in all lanes.
    #[inline(always)]
    fn like(self, x: Self::Real) -> Self {
        Self::splat(self.simd(), x)
    }
    /// Returns the smaller number, or `other` in lanes where `self` is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }
    /// Returns the larger number, or `other` in lanes where `self` is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.gt(other), self, other)
    }
    /// Clamps the value to [low, high]. The result is `low` in lanes where `self` is NaN.
    #[inline(always)]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
}

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn all(self) -> bool {
        self
    }
    #[inline(always)]
    fn lane(self, index: usize) -> bool {
        self && index == 0
    }
}

macro_rules! real {
    ($real:ident, $bits:ident, $sqrt:path, $magic:expr, $bias:expr, $mantissa:expr) => {
        impl Real for $real {
            const DIGITS: u32 = <$real>::MANTISSA_DIGITS;

            #[inline(always)]
            fn from_f64(x: f64) -> Self {
                x as $real
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
        }

        impl Scalar for $real {
            type Real = $real;
            type Mask = bool;
            type Simd = ();
            const LANES: usize = 1;

            #[inline(always)]
            fn splat((): (), x: $real) -> Self {
                x
            }
            #[inline(always)]
            fn load((): (), from: &[$real]) -> Self {
                from[0]
            }
            #[inline(always)]
            fn store(self, to: &mut [$real]) {
                to[0] = self;
            }
            #[inline(always)]
            fn simd(self) {}
            #[inline(always)]
            fn lane(self, index: usize) -> $real {
                assert!(index == 0, "lane {index} of 1");
                self
            }
            #[inline(always)]
            fn set_lane(&mut self, index: usize, x: $real) {
                assert!(index == 0, "lane {index} of 1");
                *self = x;
            }
            #[inline(always)]
            fn vectorize<T>((): (), work: impl FnOnce() -> T) -> T {
                work()
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$real>::abs(self)
            }
            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn le(self, other: Self) -> bool {
                self <= other
            }
            #[inline(always)]
            fn select(mask: bool, if_true: Self, if_false: Self) -> Self {
                if mask { if_true } else { if_false }
            }
            #[inline(always)]
            fn round_small(self) -> Self {
                (self + $magic) - $magic
            }
            #[inline(always)]
            fn exp2_integer(self) -> Self {
                // The low mantissa bits of n + bias + magic are those of the integer n + bias.
                <$real>::from_bits((self + ($magic + $bias)).to_bits() << $mantissa)
            }
        }
    };
}

real!(f32, u32, crate::square_root::sqrtf, 12_582_912.0, 127.0, 23);
real!(f64, u64, crate::square_root::sqrt, 6_755_399_441_055_744.0, 1023.0, 52);
