//! Sensors on analogue-to-digital converters: infrared, light, the ground's grey.

use core::fmt;

use farsa_body::ports::{Channels, Sensor};

use crate::Fault;

/// Some channels of a board's analogue-to-digital converter.
///
/// `embedded-hal` 1.0 has no trait for converters, so that this one takes a few lines for each board.
pub trait Converter {
    /// Why a conversion failed.
    type Error;

    /// The count of this sensor, the first one's number is 0.
    ///
    /// # Errors
    /// What the board says.
    fn count(&mut self, sensor: usize) -> Result<u16, Self::Error>;
}

/// `N` sensors of a converter, each with a curve from its counts to what the network reads.
///
/// A curve is a list of points [count, value] with rising counts, straight between them and level beyond its ends: two points
/// where the value is in proportion to the count, more where it was measured. When a conversion fails the value stays as it was
/// read last, 0 before that, and [`check`](Self::check) says so.
#[derive(Debug)]
pub struct Converters<C, const N: usize> {
    converter: C,
    curves: [&'static [[f32; 2]]; N],
    values: [f32; N],
    fault: Option<Fault>,
}

/// A curve that is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CurveError {
    /// It has no point.
    Empty {
        /// Which sensor's.
        sensor: usize,
    },
    /// A point is not finite, or its count is not above that of the point before it.
    Point {
        /// Which sensor's.
        sensor: usize,
        /// Which point, the first one's number is 0.
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
    /// The sensors of this converter with their curves.
    ///
    /// # Errors
    /// [`CurveError`], of the first curve that has one.
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

    /// What went wrong since this was asked last.
    ///
    /// # Errors
    /// [`Fault::Read`].
    pub fn check(&mut self) -> Result<(), Fault> {
        self.fault.take().map_or(Ok(()), Err)
    }

    /// Gives the converter back.
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
