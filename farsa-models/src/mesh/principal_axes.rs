//! Principal axes of a symmetric matrix, and rotations from axes.

use farsa_body::Pose;
use farsa_body::robot::MassProperties;
use farsa_num::Scalar;

use crate::vector::{cross, norm};

/// A symmetric matrix [xx, yy, zz, xy, xz, yz] as its principal values and the rotation [x, y, z, w] from the axes that
/// belong to them.
///
/// Jacobi's method: each of the three elements off the diagonal is turned to zero in its place, over and over.
pub(crate) fn principal_axes([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> ([f64; 3], [f64; 4]) {
    let mut m = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    // Rows are the axes.
    let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _sweep in 0..30 {
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            if m[i][j] == 0.0 {
                continue;
            }
            // With slope = cot(2 a) of the angle a that clears m[i][j], t = tan(a) is the smaller root of t^2 + 2 slope
            // t - 1 = 0. No turn then exceeds 45 degrees, without which the sweeps may not converge.
            let slope = (m[j][j] - m[i][i]) / (2.0 * m[i][j]);
            let t = slope.signum() / (slope.abs() + Scalar::sqrt(slope * slope + 1.0));
            let c = 1.0 / Scalar::sqrt(t * t + 1.0);
            let s = t * c;
            if !s.is_finite() {
                continue;
            }
            for k in 0..3 {
                let (a, b) = (m[i][k], m[j][k]);
                (m[i][k], m[j][k]) = (c * a - s * b, s * a + c * b);
            }
            for row in &mut m {
                let (a, b) = (row[i], row[j]);
                (row[i], row[j]) = (c * a - s * b, s * a + c * b);
            }
            m[i][j] = 0.0;
            m[j][i] = 0.0;
            for k in 0..3 {
                let (a, b) = (axes[i][k], axes[j][k]);
                (axes[i][k], axes[j][k]) = (c * a - s * b, s * a + c * b);
            }
        }
    }
    // Rounding has not kept the axes exactly perpendicular.
    axes[2] = cross(axes[0], axes[1]);
    ([m[0][0], m[1][1], m[2][2]], rotation_of_axes(axes))
}

/// Moments of a symmetric matrix from the largest on, and the rotation [x, y, z, w] to their axes.
///
/// MuJoCo's `mjuu_eig3`, with its bounds: an absolute 1e-12 leaves a small mesh at an angle to its axes, and equal moments
/// have the same axes here and there.
pub(crate) fn sorted_axes([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> ([f64; 3], [f64; 4]) {
    const LEAST: f64 = 1e-12;
    let given = MassProperties { mass: 0.0, centre: [0.0; 3], inertia: [xx, yy, zz, xy, xz, yz] };
    let mut turn = Pose::<f64>::identity();
    let mut moments = [xx, yy, zz];
    for _ in 0..500 {
        let [x, y, z, w] = turn.rotation;
        let back = Pose { position: [0.0; 3], rotation: [-x, -y, -z, w] };
        let [a, b, c, ab, ac, bc] = given.placed(&back).inertia;
        moments = [a, b, c];
        let (row, column, off) = if ab.abs() > ac.abs() && ab.abs() > bc.abs() {
            (0, 1, ab)
        } else if ac.abs() > bc.abs() {
            (0, 2, ac)
        } else {
            (1, 2, bc)
        };
        if off.abs() < LEAST {
            break;
        }
        let tau = (moments[column] - moments[row]) / (2.0 * off);
        let t = if tau >= 0.0 { 1.0 } else { -1.0 } / (tau.abs() + Scalar::sqrt(1.0 + tau * tau));
        let cosine = 1.0 / Scalar::sqrt(1.0 + t * t);
        if cosine.is_nan() || cosine > 1.0 - LEAST {
            break;
        }
        let axis = 3 - row - column;
        let sine = Scalar::sqrt(0.5 - 0.5 * cosine);
        let mut q = [0.0; 4];
        q[axis] = if (tau >= 0.0) == (axis == 1) { sine } else { -sine };
        q[3] = Scalar::sqrt(1.0 - sine * sine);
        turn = normal(&turn.compose(&Pose { position: [0.0; 3], rotation: q }));
    }
    for lead in [0, 1, 0] {
        if moments[lead] + LEAST < moments[lead + 1] {
            moments.swap(lead, lead + 1);
            let mut q = [0.0, 0.0, 0.0, Scalar::sqrt(0.5)];
            q[(lead + 2) % 3] = q[3];
            turn = normal(&turn.compose(&Pose { position: [0.0; 3], rotation: q }));
        }
    }
    (moments, turn.rotation)
}

fn normal(turn: &Pose<f64>) -> Pose<f64> {
    let n = norm(&turn.rotation);
    Pose { position: [0.0; 3], rotation: turn.rotation.map(|x| x / n) }
}

/// Computes the rotation [x, y, z, w] that takes x, y and z to these perpendicular unit vectors.
pub(crate) fn rotation_of_axes([x, y, z]: [[f64; 3]; 3]) -> [f64; 4] {
    let trace = x[0] + y[1] + z[2];
    // The largest of the four components is computed first, the others follow from it.
    let q = if trace > 0.0 {
        [y[2] - z[1], z[0] - x[2], x[1] - y[0], 1.0 + trace]
    } else if x[0] >= y[1] && x[0] >= z[2] {
        [1.0 + x[0] - y[1] - z[2], x[1] + y[0], z[0] + x[2], y[2] - z[1]]
    } else if y[1] >= z[2] {
        [x[1] + y[0], 1.0 + y[1] - x[0] - z[2], y[2] + z[1], z[0] - x[2]]
    } else {
        [z[0] + x[2], y[2] + z[1], 1.0 + z[2] - x[0] - y[1], x[1] - y[0]]
    };
    let n = norm(&q);
    q.map(|part| part / n)
}

/// The shortest rotation [x, y, z, w] from z to a direction of any length. Half a turn about x to the opposite.
pub(crate) fn rotation_to(direction: [f64; 3]) -> [f64; 4] {
    let length = norm(&direction);
    let [x, y, z] = direction.map(|part| part / length);
    let q = [-y, x, 0.0, 1.0 + z];
    let n = norm(&q);
    if n > 1e-10 { q.map(|part| part / n) } else { [1.0, 0.0, 0.0, 0.0] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn axes_make_the_matrix_again(m in prop::array::uniform6(-5.0..5.0_f64), scale in 1e-9..1e3_f64) {
            let m = m.map(|x| x * scale);
            let (values, rotation) = principal_axes(m);
            let turn = Pose { position: [0.0; 3], rotation };
            let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| turn.rotate(axis));
            let at = |i: usize, j: usize| -> f64 { (0..3).map(|k| values[k] * axes[k][i] * axes[k][j]).sum() };
            for (made, given) in [at(0, 0), at(1, 1), at(2, 2), at(0, 1), at(0, 2), at(1, 2)].into_iter().zip(m) {
                prop_assert!((made - given).abs() < 1e-13 * scale * 5.0, "{made} {given}");
            }
        }

        #[test]
        fn rotations_are_of_their_axes(q in prop::array::uniform4(-1.0..1.0_f64), to in prop::array::uniform3(-1.0..1.0_f64)) {
            prop_assume!(norm(&q) > 0.1 && norm(&to) > 0.1);
            let turn = Pose { position: [0.0; 3], rotation: q.map(|x| x / norm(&q)) };
            let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| turn.rotate(axis));
            let again = Pose { position: [0.0; 3], rotation: rotation_of_axes(axes) };
            let (a, b) = (again.rotate([0.3, 0.5, -0.7]), turn.rotate([0.3, 0.5, -0.7]));
            prop_assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-14));
            let up = Pose { position: [0.0; 3], rotation: rotation_to(to) }.rotate([0.0, 0.0, norm(&to)]);
            prop_assert!((0..3).all(|k| (up[k] - to[k]).abs() < 1e-14));
        }
    }

    #[test]
    fn half_turns_are_about_x() {
        assert_eq!(rotation_to([0.0, 0.0, -2.0]), [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(principal_axes([0.0; 6]).0, [0.0; 3]);
    }
}
