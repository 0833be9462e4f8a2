//! Vectors of three numbers.

/// A point or a direction in space.
pub(crate) type Vector = [f64; 3];

/// Returns a + b.
pub(crate) fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Returns a - b.
pub(crate) fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Returns a times s.
pub(crate) fn scale(a: Vector, s: f64) -> Vector {
    [a[0] * s, a[1] * s, a[2] * s]
}

/// Computes the point at `distance` on the ray from `origin` along `direction`.
pub(crate) fn along(origin: Vector, direction: Vector, distance: f64) -> Vector {
    add(origin, scale(direction, distance))
}

/// Interpolates from a to b at `share`.
pub(crate) fn mix(a: Vector, b: Vector, share: f64) -> Vector {
    along(a, sub(b, a), share)
}

/// Computes the scalar product.
pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Computes the vector product.
pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Computes the Euclidean length.
pub(crate) fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// Computes the unit vector in the direction of a, or 0 for 0.
pub(crate) fn unit(a: Vector) -> Vector {
    let length = length(a);
    if length > 0.0 { scale(a, 1.0 / length) } else { a }
}

/// Returns two unit vectors perpendicular to the unit vector a and to each other.
pub(crate) fn across(a: Vector) -> [Vector; 2] {
    // The coordinate axis farthest from a gives the longest product.
    let helper = if a[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let u = unit(cross(helper, a));
    [u, cross(a, u)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_stand_at_right_angles() {
        for a in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0], unit([1.0, -2.0, 3.0])] {
            let [u, v] = across(a);
            for [x, y] in [[a, u], [a, v], [u, v]] {
                assert!(dot(x, y).abs() < 1e-15);
            }
            assert!((length(u) - 1.0).abs() < 1e-15 && (length(v) - 1.0).abs() < 1e-15);
        }
        assert_eq!(unit([0.0; 3]), [0.0; 3]);
    }
}
