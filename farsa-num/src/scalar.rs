//! The scalar of all generic numerical code: one number, or the same number in several worlds.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

/// A truth value per lane, the result of a comparison of [`Scalar`]s.
pub trait Mask: Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Returns true if any lane is true.
    fn any(self) -> bool;
    /// Returns true if every lane is true.
    fn all(self) -> bool;
    /// The truth value of one lane, false beyond the last.
    fn lane(self, index: usize) -> bool;
}

/// The type of one lane of a [`Scalar`]: `f32` or `f64`.
pub trait Real: Scalar<Real = Self, Mask = bool, Simd = ()> + PartialOrd + Default + Send + Sync + 'static {
    /// Binary digits of the significand: 24 for `f32`, 53 for `f64`.
    const DIGITS: u32;

    /// The nearest value of this type.
    fn from_f64(x: f64) -> Self;
    /// The value in double precision, exact.
    fn to_f64(self) -> f64;
}

/// Arithmetic on one value per lane, with the same bits in a lane as alone.
///
/// Implemented by `f32`, `f64` and, for SIMD, `fearless_simd::f32x8` and `f32x16`. Code over it has no `if` on a value. It
/// compares to a [`Mask`] and selects. Every operation is one rounded IEEE operation per lane, never fused or approximated.
/// Functions over it are `#[inline(always)]`, so they inherit the target features of the dispatch around them.
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
    /// The type of one lane.
    type Real: Real;
    /// The result of a comparison.
    type Mask: Mask;
    /// The proof that the processor has the instructions, `()` for one lane.
    type Simd: Copy;
    /// Number of lanes.
    const LANES: usize;

    /// The same value in every lane.
    fn splat(simd: Self::Simd, x: Self::Real) -> Self;
    /// The first [`LANES`](Self::LANES) values of a slice, one per lane.
    ///
    /// # Panics
    /// If there are fewer.
    fn load(simd: Self::Simd, from: &[Self::Real]) -> Self;
    /// Writes the lanes over the first [`LANES`](Self::LANES) values of a slice.
    ///
    /// # Panics
    /// If there are fewer.
    fn store(self, to: &mut [Self::Real]);
    /// The token this value was made with.
    fn simd(self) -> Self::Simd;
    /// One lane's value.
    ///
    /// # Panics
    /// If `index >= LANES`.
    fn lane(self, index: usize) -> Self::Real;
    /// Replaces one lane's value.
    ///
    /// # Panics
    /// If `index >= LANES`.
    fn set_lane(&mut self, index: usize, x: Self::Real);
    /// Calls a function compiled for the instructions that the token proves.
    ///
    /// A large piece of lane code becomes one function this way, compiled once and not in each caller. The closure must be
    /// `#[inline(always)]` to inherit the instructions.
    fn vectorize<T>(simd: Self::Simd, work: impl FnOnce() -> T) -> T;

    /// Square root, correctly rounded. NaN below zero.
    fn sqrt(self) -> Self;
    /// Clears the sign.
    fn abs(self) -> Self;
    /// `self < other`, false with a NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`, false with a NaN.
    fn le(self, other: Self) -> Self::Mask;
    /// `self > other`, false with a NaN.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// `self >= other`, false with a NaN.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }
    /// `if_true` where the mask is true, else `if_false`.
    fn select(mask: Self::Mask, if_true: Self, if_false: Self) -> Self;
    /// The nearest integer, ties to even, for magnitudes below 2^22 (`f32`) or 2^51 (`f64`).
    fn round_small(self) -> Self;
    /// 2 to the power of an integer-valued number within the normal exponents [-126, 127] or [-1022, 1023]. Unspecified beyond.
    fn exp2_integer(self) -> Self;

    /// A constant in every lane, rounded once to the lane's type.
    #[inline(always)]
    fn constant(self, x: f64) -> Self {
        Self::splat(self.simd(), Self::Real::from_f64(x))
    }
    /// A lane-type value in every lane.
    #[inline(always)]
    fn like(self, x: Self::Real) -> Self {
        Self::splat(self.simd(), x)
    }
    /// The smaller one, or `other` where `self` is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }
    /// The larger one, or `other` where `self` is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.gt(other), self, other)
    }
    /// `self` clamped to [low, high], or `low` where `self` is NaN.
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
