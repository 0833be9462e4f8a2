//! A macro for Horner's rule. Since it is unrolled at compile time, the order of operations is defined by the source.

/// `c0 + x * (c1 + x * (c2 + ...))`, each constant rounded once to the lane's type.
macro_rules! polynomial {
    ($x:expr; $last:expr $(,)?) => { $x.constant($last) };
    ($x:expr; $first:expr, $($rest:expr),+ $(,)?) => {
        $x.constant($first) + $x * $crate::polynomial::polynomial!($x; $($rest),+)
    };
}
pub(crate) use polynomial;
