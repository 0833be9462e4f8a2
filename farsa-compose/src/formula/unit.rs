//! Units of quantities.

use std::fmt;

/// Names of the base units, in the order of the exponents.
const BASE: [&str; 5] = ["m", "s", "rad", "N", "kg"];

/// Units in a formula: name, number of the base unit, and the fraction of base units in one of it.
const NAMED: [(&str, usize, [f64; 2]); 10] = [
    ("m", 0, [1.0, 1.0]),
    ("cm", 0, [1.0, 100.0]),
    ("mm", 0, [1.0, 1000.0]),
    ("s", 1, [1.0, 1.0]),
    ("ms", 1, [1.0, 1000.0]),
    ("rad", 2, [1.0, 1.0]),
    ("deg", 2, [std::f64::consts::PI, 180.0]),
    ("N", 3, [1.0, 1.0]),
    ("kg", 4, [1.0, 1.0]),
    ("g", 4, [1.0, 1000.0]),
];

/// Exponents of meter, second, radian, newton and kilogram.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Unit([i8; 5]);

impl Unit {
    /// Unit of plain numbers.
    pub(crate) const NONE: Self = Self([0; 5]);
    /// Unit of times.
    pub(crate) const SECOND: Self = Self([0, 1, 0, 0, 0]);
    /// Unit of angles.
    pub(crate) const RADIAN: Self = Self([0, 0, 1, 0, 0]);

    /// Returns a unit such as `m/s` in base units, with the fraction of base units in one of it.
    pub(crate) fn parse(text: &str) -> Option<(Self, [f64; 2])> {
        let mut parts = text.split('/');
        let (mut unit, mut scale) = (Self::NONE, [1.0, 1.0]);
        let mut add = |name: &str, sign: i8| {
            let (_, base, [numerator, denominator]) = NAMED.iter().find(|(known, ..)| *known == name.trim())?;
            unit.0[*base] += sign;
            let ratio = if sign > 0 { [*numerator, *denominator] } else { [*denominator, *numerator] };
            scale = [scale[0] * ratio[0], scale[1] * ratio[1]];
            Some(())
        };
        add(parts.next()?, 1)?;
        if let Some(below) = parts.next() {
            add(below, -1)?;
        }
        parts.next().is_none().then_some((unit, scale))
    }

    /// Lists the names of units.
    pub(crate) fn names() -> impl Iterator<Item = &'static str> + Clone {
        NAMED.iter().map(|(name, ..)| *name)
    }

    /// Returns the unit of a product, unless an exponent is too large.
    pub(crate) fn times(self, other: Self) -> Option<Self> {
        self.combined(other, i8::checked_add)
    }

    /// Returns the unit of a quotient, unless an exponent is too large.
    pub(crate) fn over(self, other: Self) -> Option<Self> {
        self.combined(other, i8::checked_sub)
    }

    /// Returns the unit of a power, unless an exponent is too large.
    pub(crate) fn to_power(self, exponent: i8) -> Option<Self> {
        self.combined(Self([exponent; 5]), i8::checked_mul)
    }

    /// Returns the unit of a square root, unless an exponent is odd.
    pub(crate) fn root(self) -> Option<Self> {
        self.0.iter().all(|exponent| exponent % 2 == 0).then(|| Self(self.0.map(|exponent| exponent / 2)))
    }

    fn combined(self, other: Self, combine: fn(i8, i8) -> Option<i8>) -> Option<Self> {
        let mut exponents = [0; 5];
        for (k, exponent) in exponents.iter_mut().enumerate() {
            *exponent = combine(self.0[k], other.0[k])?;
        }
        Some(Self(exponents))
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::NONE {
            return f.write_str("no unit");
        }
        let side = |sign: i8| {
            let powers = self.0.iter().zip(BASE).filter(|(exponent, _)| exponent.signum() == sign);
            let power = |(exponent, name): (&i8, &str)| match exponent.unsigned_abs() {
                1 => name.to_owned(),
                exponent => format!("{name}^{exponent}"),
            };
            powers.map(power).collect::<Vec<_>>()
        };
        let (above, below) = (side(1), side(-1));
        f.write_str(&if above.is_empty() { "1".to_owned() } else { above.join(" ") })?;
        below.iter().try_for_each(|unit| write!(f, "/{unit}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_combined_and_written() {
        let parse = |text: &str| Unit::parse(text).map(|(unit, _)| unit);
        let [meter, second] = ["m", "s"].map(|text| parse(text).unwrap());
        assert_eq!(parse("mm/ms"), meter.over(second));
        assert_eq!(Unit::parse("cm/ms").unwrap().1, [1000.0, 100.0]);
        assert_eq!(meter.times(meter).and_then(Unit::root), Some(meter));
        assert_eq!(
            (meter.root(), meter.to_power(2), meter.to_power(100).unwrap().to_power(2)),
            (None, meter.times(meter), None)
        );
        for (text, wanted) in [("m", "m"), ("rad/s", "rad/s"), ("g", "kg")] {
            assert_eq!(parse(text).unwrap().to_string(), wanted);
        }
        assert_eq!(Unit::NONE.over(second).unwrap().to_string(), "1/s");
        assert_eq!(meter.over(second.to_power(2).unwrap()).unwrap().to_string(), "m/s^2");
        for wrong in ["", "/s", "m/", "m/s/s", "mile", "M"] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
    }
}
