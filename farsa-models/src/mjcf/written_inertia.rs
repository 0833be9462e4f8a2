//! Masses and inertias in the form that MuJoCo accepts.

use farsa_body::robot::Segment;

use crate::mesh::principal_axes::principal_axes;
use crate::xml::write::{has_inertial, numbers};

/// Returns the `inertial` of a segment, or `None` without a mass.
///
/// MuJoCo refuses moments with A + B < C, without a tolerance, and computes those of `fullinertia` itself. The moments of
/// flat bodies are therefore written as `diaginertia`, rounded to valid ones. Note that it also refuses moments below 1e-15
/// of bodies that move.
pub(crate) fn inertial(segment: &Segment) -> Option<String> {
    if !has_inertial(segment) {
        return None;
    }
    let [xx, yy, zz, crossed @ ..] = segment.inertia;
    let inertia = if crossed == [0.0; 3] {
        format!("diaginertia=\"{}\"", numbers(&accepted([xx, yy, zz])))
    } else {
        let (moments, [x, y, z, w]) = principal_axes(segment.inertia);
        let valid = accepted(moments);
        if valid == moments && !is_flat(moments) {
            format!("fullinertia=\"{}\"", numbers(&segment.inertia))
        } else {
            format!("diaginertia=\"{}\" quat=\"{}\"", numbers(&valid), numbers(&[w, x, y, z]))
        }
    };
    Some(format!("<inertial pos=\"{}\" mass=\"{:?}\" {inertia}/>", numbers(&segment.centre), segment.mass))
}

/// Returns the moments that MuJoCo accepts: none is larger than the sum of the others.
fn accepted(moments: [f64; 3]) -> [f64; 3] {
    let [a, b, c] = moments.map(|moment| moment.max(0.0));
    [a.min(b + c), b.min(a + c), c.min(a + b)]
}

/// Checks whether the largest of the moments is nearly the sum of the others. MuJoCo's moments have errors of 1e-12.
fn is_flat([a, b, c]: [f64; 3]) -> bool {
    let sum = a + b + c;
    sum - 2.0 * a.max(b).max(c) <= 1e-9 * sum + 1e-12
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_body::Pose;
    use farsa_body::robot::{Joint, MassProperties};

    fn moments_of(text: &str) -> [f64; 3] {
        let list = text.split("diaginertia=\"").nth(1).and_then(|rest| rest.split('"').next()).expect("moments");
        let mut numbers = list.split(' ').map(|word| word.parse::<f64>().expect("a number"));
        [(); 3].map(|()| numbers.next().expect("three numbers"))
    }

    #[test]
    fn flat_bodies_satisfy_the_inequality_after_rounding() {
        // A flat body has A + B = C (perpendicular axis theorem). MuJoCo 4.0 refuses 398 of 1000 that are turned at
        // random and written as `fullinertia`, and none with these moments.
        let mut flat = 0;
        let scales = [1e-6, 1e-4, 1e-3, 0.01, 0.1, 1.0, 100.0].into_iter().cycle();
        for (i, scale) in (0..500_u32).zip(scales) {
            let [a, b] = [f64::from(i % 17 + 1) * 0.013, f64::from(i % 23 + 1) * 0.007];
            let (sine, cosine) = farsa_num::sin_cos(f64::from(i) * 0.37);
            let rotation = [0.6 * sine, 0.0, 0.8 * sine, cosine];
            let inertia = [a * scale, b * scale, (a + b) * scale, 0.0, 0.0, 0.0];
            let body = MassProperties { mass: 1.0, centre: [0.0; 3], inertia };
            let body = body.placed(&Pose { rotation, ..Pose::identity() });
            let joint = Joint::revolute("j", [0.0, 0.0, 1.0], Pose::identity(), [-1.0, 1.0]);
            let text = inertial(&Segment::new("s", None, joint, body)).expect("a mass");
            let [x, y, z] = moments_of(&text);
            assert!(x + y >= z && x + z >= y && y + z >= x, "{text}");
            let mut found = [x, y, z];
            found.sort_by(f64::total_cmp);
            let mut expected = [a * scale, b * scale, (a + b) * scale];
            expected.sort_by(f64::total_cmp);
            assert!(found.iter().zip(expected).all(|(x, y)| (x - y).abs() <= 1e-12 * expected[2]), "{text}");
            flat += usize::from(text.contains("quat"));
        }
        assert!(flat > 400, "{flat}");
    }

    #[test]
    fn other_moments_keep_their_digits() {
        assert_eq!(accepted([0.1, 0.2, 0.25]), [0.1, 0.2, 0.25]);
        assert_eq!(accepted([0.1, 0.2, 0.300_000_000_000_000_1]), [0.1, 0.2, 0.1 + 0.2]);
        assert_eq!(accepted([-1e-20, 1.0, 1.0]), [0.0, 1.0, 1.0]);
        assert!(is_flat([0.1, 0.2, 0.3]) && !is_flat([0.1, 0.2, 0.29]));
    }
}
