//! First two principal components of points.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Mean of points and the first two principal components of their deviations.
#[derive(Debug, Clone)]
pub(crate) struct PrincipalComponents {
    mean: DVector<f64>,
    axes: [DVector<f64>; 2],
    /// Their shares of the variance.
    pub(crate) shares: [f64; 2],
}

impl PrincipalComponents {
    /// Computes the components of points of equal dimension, or `None` for equal points and values that are not finite.
    ///
    /// The largest coordinate of each component is positive, so that equal points have equal figures.
    pub(crate) fn of<'p>(points: impl Iterator<Item = &'p [f32]> + Clone) -> Option<Self> {
        let size = points.clone().next()?.len();
        let count = points.clone().count() as f64;
        let as_vector = |point: &[f32]| DVector::from_iterator(size, point.iter().map(|x| f64::from(*x)));
        let sum = points.clone().fold(DVector::zeros(size), |sum, point| sum + as_vector(point));
        let mean = sum / count;
        let mut covariance = DMatrix::zeros(size, size);
        for point in points {
            let from = as_vector(point) - &mean;
            covariance.ger(1.0 / count, &from, &from, 1.0);
        }
        let variance = covariance.trace();
        if !(variance.is_finite() && variance > 0.0) {
            return None;
        }
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(covariance);
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by(|a, b| eigenvalues[*b].total_cmp(&eigenvalues[*a]));
        let axis = |number: usize| -> (DVector<f64>, f64) {
            let Some(&column) = order.get(number) else { return (DVector::zeros(size), 0.0) };
            let axis = eigenvectors.column(column).into_owned();
            let sign = axis[axis.icamax()].signum();
            (sign * axis, (eigenvalues[column] / variance).clamp(0.0, 1.0))
        };
        let [(first, one), (second, other)] = [axis(0), axis(1)];
        Some(Self { mean, axes: [first, second], shares: [one, other] })
    }

    /// Computes the coordinates of a point along the two components.
    pub(crate) fn place(&self, point: &[f32]) -> [f64; 2] {
        self.axes.each_ref().map(|axis| {
            let coordinates = point.iter().zip(self.mean.iter()).zip(axis.iter());
            coordinates.map(|((x, mean), part)| (f64::from(*x) - mean) * part).sum()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_num::sin_cos;

    fn of(points: &[Vec<f32>]) -> Option<PrincipalComponents> {
        PrincipalComponents::of(points.iter().map(Vec::as_slice))
    }

    #[test]
    fn an_ellipse_in_space_has_its_axes() {
        // Semi-axes 3 along (2, -1, 2) / 3 and 1 along (1, 2, 0) / sqrt 5, about (5, 6, 7).
        let [long, short] = [[2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0], [1.0 / 5.0_f64.sqrt(), 2.0 / 5.0_f64.sqrt(), 0.0]];
        let angle = |i: usize| i as f64 / 64.0 * core::f64::consts::TAU;
        let points: Vec<Vec<f32>> = (0..64)
            .map(|i| {
                let (sine, cosine) = sin_cos(angle(i));
                let [a, b] = [3.0 * cosine, sine];
                (0..3).map(|k| (5.0 + k as f64 + a * long[k] + b * short[k]) as f32).collect()
            })
            .collect();
        let components = of(&points).unwrap();
        assert!(
            (components.shares[0] - 0.9).abs() < 1e-6 && (components.shares[1] - 0.1).abs() < 1e-6,
            "{:?}",
            components.shares
        );
        for (i, point) in points.iter().enumerate() {
            let [x, y] = components.place(point);
            let (sine, cosine) = sin_cos(angle(i));
            let expected = [3.0 * cosine, sine];
            assert!((x - expected[0]).abs() < 1e-5 && (y - expected[1]).abs() < 1e-5, "{x} {y} for {expected:?}");
        }
    }

    #[test]
    fn points_of_one_coordinate_have_one_component_and_equal_points_none() {
        let components = of(&[vec![1.0], vec![3.0]]).unwrap();
        assert_eq!((components.shares, components.place(&[3.0])), ([1.0, 0.0], [1.0, 0.0]));
        assert!(of(&[]).is_none() && of(&[vec![], vec![]]).is_none());
        assert!(of(&[vec![0.25, 1.0], vec![0.25, 1.0]]).is_none());
        assert!(of(&[vec![0.25, f32::NAN], vec![0.25, 1.0]]).is_none());
    }
}
