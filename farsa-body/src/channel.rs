//! Errors of sensors and motors, and a helper that writes to slices of any length.

use core::fmt;

/// The error returned when a sensor, a motor or a wrapper cannot be created.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ChannelError {
    /// A number is NaN, infinite or out of its range.
    Value {
        /// Name of the invalid number.
        field: &'static str,
        /// Invalid value.
        value: f32,
    },
    /// The ends of a range are equal, in the wrong order or not finite.
    Range {
        /// Beginning of the range.
        from: f32,
        /// End of the range.
        to: f32,
    },
    /// A selection of channels ends after the last channel or before its start.
    Selection {
        /// The first selected channel.
        start: usize,
        /// Index after the last selected channel. It can exceed `channels`.
        end: usize,
        /// Number of available channels.
        channels: usize,
    },
    /// A list is empty or cannot be divided into groups of equal size.
    Groups {
        /// Kind of elements in the list.
        field: &'static str,
        /// Number of elements in the list.
        count: usize,
        /// Required size of a group.
        size: usize,
    },
    /// The memory that was provided for a wrapper is too short.
    Memory {
        /// Length of the memory.
        given: usize,
        /// Required length of the memory.
        needed: usize,
    },
}

impl fmt::Display for ChannelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value { field, value } => write!(f, "{field} is {value}"),
            Self::Range { from, to } => write!(f, "no range from {from} to {to}"),
            Self::Selection { start, end, channels } => write!(f, "channels {start}..{end} of {channels}"),
            Self::Groups { field, count, size } => write!(f, "{count} {field} are no whole groups of {size}"),
            Self::Memory { given, needed } => write!(f, "memory of {given} values, {needed} are needed"),
        }
    }
}

impl core::error::Error for ChannelError {}

/// Passes a finite number on.
pub(crate) fn finite(field: &'static str, value: f32) -> Result<f32, ChannelError> {
    if value.is_finite() { Ok(value) } else { Err(ChannelError::Value { field, value }) }
}

/// Passes a finite number > 0 on.
pub(crate) fn positive(field: &'static str, value: f32) -> Result<f32, ChannelError> {
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err(ChannelError::Value { field, value }) }
}

/// Checks that `count` parts form one or more groups of this size.
pub(crate) fn groups(field: &'static str, count: usize, size: usize) -> Result<(), ChannelError> {
    if size > 0 && count > 0 && count.is_multiple_of(size) {
        Ok(())
    } else {
        Err(ChannelError::Groups { field, count, size })
    }
}

/// Checks that a direction of the plane has length 1.
pub(crate) fn direction(field: &'static str, [x, y]: [f32; 2]) -> Result<(), ChannelError> {
    let length = farsa_num::Scalar::sqrt(x * x + y * y);
    if (length - 1.0).abs() < 1e-3 { Ok(()) } else { Err(ChannelError::Value { field, value: length }) }
}

/// Checks that a range has two finite ends with a finite distance.
pub(crate) fn finite_range(from: f32, to: f32) -> Result<(), ChannelError> {
    if from.is_finite() && to.is_finite() && (to - from).is_finite() {
        Ok(())
    } else {
        Err(ChannelError::Range { from, to })
    }
}

/// Writes as many values as there is room for.
#[inline]
pub(crate) fn write<const N: usize>(out: &mut [f32], values: [f32; N]) {
    for (o, value) in out.iter_mut().zip(values) {
        *o = value;
    }
}

/// The value in [0, 1] nearest to `y`, or 0 for NaN.
#[inline]
pub(crate) fn unit(y: f32) -> f32 {
    farsa_num::Scalar::clamp(y, 0.0, 1.0)
}

/// The value in [-1, 1] nearest to `x`, or 0 for NaN.
#[inline]
pub(crate) fn signed_unit(x: f32) -> f32 {
    if x.is_nan() { 0.0 } else { farsa_num::Scalar::clamp(x, -1.0, 1.0) }
}
