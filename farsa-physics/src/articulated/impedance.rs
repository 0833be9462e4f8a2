//! The impedance of a soft contact or stop over its depth, see [`Impedance`].

use farsa_body::robot::Impedance;
use farsa_num::{Real, Scalar};

/// The curve of an impedance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curve<R> {
    surface: R,
    deep: R,
    /// From the surface to the full depth.
    rise: R,
    per_width: R,
    midpoint: R,
    /// Reciprocals of the midpoint and of its distance from 1.
    parts: [R; 2],
    is_linear: bool,
}

impl<R: Real> Curve<R> {
    pub(crate) fn new(law: &Impedance) -> Self {
        let r = R::from_f64;
        Self {
            surface: r(law.surface),
            deep: r(law.deep),
            rise: r(law.deep - law.surface),
            per_width: r(1.0 / law.width),
            midpoint: r(law.midpoint),
            parts: [r(1.0 / law.midpoint), r(1.0 / (1.0 - law.midpoint))],
            is_linear: law.power == 1,
        }
    }

    /// Factors of a damper and an inertia, and of a spring, at a depth.
    #[inline(always)]
    pub(crate) fn factors<S: Scalar<Real = R>>(&self, simd: S::Simd, depth: S) -> [S; 2] {
        let one = S::splat(simd, R::from_f64(1.0));
        let x = (depth * S::splat(simd, self.per_width)).clamp(one.constant(0.0), one);
        let y = if self.is_linear {
            x
        } else {
            let left = one - x;
            let [first, second] = self.parts.map(|part| S::splat(simd, part));
            S::select(x.le(S::splat(simd, self.midpoint)), x * x * first, one - left * left * second)
        };
        let deep = S::splat(simd, self.deep);
        let d = S::splat(simd, self.surface) + S::splat(simd, self.rise) * y;
        let share = d / deep;
        let factor = share * ((one - deep) / (one - d));
        [factor, factor * share]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_those_of_the_impedance() {
        for (surface, deep, midpoint, power) in
            [(0.9, 0.95, 0.5, 2), (1e-4, 0.8, 0.5, 2), (0.2, 0.99, 0.1, 2), (0.3, 0.6, 0.5, 1), (0.9, 0.5, 0.7, 2)]
        {
            let law = Impedance { surface, deep, width: 0.03, midpoint, power };
            for step in -4..=44 {
                let depth = 0.03 * f64::from(step) / 40.0;
                let d = law.at(depth);
                let factor = d * (1.0 - deep) / (deep * (1.0 - d));
                let [found, of_spring] = Curve::<f64>::new(&law).factors((), depth);
                assert!(
                    (found - factor).abs() < 1e-12 && (of_spring - factor * d / deep).abs() < 1e-12,
                    "{law:?} {depth}"
                );
            }
            assert!((law.at(0.0) - surface).abs() < 1e-15 && (law.at(1.0) - deep).abs() < 1e-15);
        }
    }
}
