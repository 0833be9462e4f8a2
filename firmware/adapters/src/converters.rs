//! Sensors on analog-to-digital converters: infrared, light, the gray level of the ground.

use core::fmt;

use farsa_body::ports::{Channels, Sensor};

use crate::Fault;

/// Channels of a board's analog-to-digital converter.
///
/// `embedded-hal` 1.0 has no trait for converters. Implement this one for your board in a few lines.
pub trait Converter {
    /// The error of a conversion.
    type Error;

    /// Reads the count of a sensor, numbered from 0.
    ///
    /// # Errors
    /// The error of the board.
    fn count(&mut self, sensor: usize) -> Result<u16, Self::Error>;
}

/// `N` sensors of a converter, each with a curve from counts to inputs of the network.
///
/// A curve is a list of points [count, value] with rising counts. It is straight between them and level beyond its ends. Two
/// points are enough for a proportional sensor, a measured one has more. A failed conversion keeps the last value, at first 0,
/// and [`check`](Self::check) reports it.
#[derive(Debug)]
pub struct Converters<C, const N: usize> {
    converter: C,
    curves: [&'static [[f32; 2]]; N],
    values: [f32; N],
    fault: Option<Fault>,
}

/// An invalid curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CurveError {
    /// It has no point.
    Empty {
        /// Number of the sensor.
        sensor: usize,
    },
    /// A point is not finite, or its count is not above that of the previous point.
    Point {
        /// Number of the sensor.
        sensor: usize,
        /// Number of the point, from 0.
        point: usize,
    },
}

impl fmt::Display for CurveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Empty { sensor } => write!(f, "sensor {sensor}: its curve has no point"),
            Self::Point { sensor, point } => {
                write!(f, "sensor {sensor}: point {point} of its curve is not finite, or not above the one before it")
            }
        }
    }
}

impl core::error::Error for CurveError {}

impl<C: Converter, const N: usize> Converters<C, N> {
    /// Builds the sensors of a converter with their curves.
    ///
    /// # Errors
    /// [`CurveError`] of the first invalid curve.
    pub fn new(converter: C, curves: [&'static [[f32; 2]]; N]) -> Result<Self, CurveError> {
        for (sensor, curve) in curves.iter().enumerate() {
            if curve.is_empty() {
                return Err(CurveError::Empty { sensor });
            }
            let mut before = f32::NEG_INFINITY;
            for (point, [count, value]) in curve.iter().enumerate() {
                if !(count.is_finite() && value.is_finite() && *count > before) {
                    return Err(CurveError::Point { sensor, point });
                }
                before = *count;
            }
        }
        Ok(Self { converter, curves, values: [0.0; N], fault: None })
    }

    /// Returns the fault since the last call.
    ///
    /// # Errors
    /// [`Fault::Read`].
    pub fn check(&mut self) -> Result<(), Fault> {
        self.fault.take().map_or(Ok(()), Err)
    }

    /// Returns the converter.
    pub fn into_converter(self) -> C {
        self.converter
    }
}

/// The value of a curve at this count.
fn value_at(curve: &[[f32; 2]], count: f32) -> f32 {
    let mut points = curve.iter();
    let Some(mut before) = points.next() else { return 0.0 };
    if count <= before[0] {
        return before[1];
    }
    for point in points {
        if count <= point[0] {
            return before[1] + (point[1] - before[1]) * ((count - before[0]) / (point[0] - before[0]));
        }
        before = point;
    }
    before[1]
}

impl<C, const N: usize> Channels for Converters<C, N> {
    fn channels(&self) -> usize {
        N
    }
}

impl<W: ?Sized, C: Converter, const N: usize> Sensor<W> for Converters<C, N> {
    fn read(&mut self, _: &W, out: &mut [f32]) {
        for (sensor, (value, curve)) in self.values.iter_mut().zip(self.curves).enumerate() {
            match self.converter.count(sensor) {
                Ok(count) => *value = value_at(curve, f32::from(count)),
                Err(_) => self.fault = Some(Fault::Read),
            }
        }
        out.iter_mut().zip(self.values).for_each(|(out, value)| *out = value);
    }
}
