//! Mass, center of mass and inertia of solid bodies.

use crate::pose::{Pose, cross};
use crate::robot::shape::Shape;

/// The mass, the center of mass and the inertia of a rigid body.
///
/// The constructors assume homogeneous solids centered at the origin, with their axis along z.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MassProperties {
    /// Mass of the body in kilograms.
    pub mass: f64,
    /// Center of mass in meters.
    pub centre: [f64; 3],
    /// Elements [xx, yy, zz, xy, xz, yz] of the inertia matrix about the center of mass (in kg m2).
    pub inertia: [f64; 6],
}

impl MassProperties {
    fn diagonal(mass: f64, [xx, yy, zz]: [f64; 3]) -> Self {
        Self { mass, centre: [0.0; 3], inertia: [xx, yy, zz, 0.0, 0.0, 0.0] }
    }

    /// Creates a sphere with the given mass (in kilograms) and radius (in meters). Its inertia is 2/5 m r2 about every
    /// axis.
    pub fn sphere(mass: f64, radius: f64) -> Self {
        Self::diagonal(mass, [0.4 * mass * radius * radius; 3])
    }

    /// Creates a box with the given mass (in kilograms) and half edge lengths (in meters). Its inertia about the axis
    /// along a is m (b2 + c2) / 3.
    pub fn cuboid(mass: f64, half: [f64; 3]) -> Self {
        let [a, b, c] = half.map(|x| x * x);
        Self::diagonal(mass, [b + c, a + c, a + b].map(|sum| mass * sum / 3.0))
    }

    /// Creates a cylinder with the given mass (in kilograms), radius and half length (in meters). Its inertia is m r2 /
    /// 2 about its axis and m (r2 / 4 + h2 / 3) about the others.
    pub fn cylinder(mass: f64, radius: f64, half_length: f64) -> Self {
        let r2 = radius * radius;
        let across = mass * (r2 / 4.0 + half_length * half_length / 3.0);
        Self::diagonal(mass, [across, across, mass * r2 / 2.0])
    }

    /// Creates a capsule with the given mass (in kilograms), radius and half length h of its axis (in meters). It
    /// consists of a cylinder and two half spheres of the same density. The half spheres contribute 2/5 m r2 about the
    /// axis and m (2/5 r2 + h2 + 3/4 h r) about the others.
    pub fn capsule(mass: f64, radius: f64, half_length: f64) -> Self {
        let (r2, h) = (radius * radius, half_length);
        let tube = mass * h / (h + 2.0 / 3.0 * radius);
        let caps = mass - tube;
        let across = tube * (r2 / 4.0 + h * h / 3.0) + caps * (0.4 * r2 + h * h + 0.75 * h * radius);
        Self::diagonal(mass, [across, across, tube * r2 / 2.0 + caps * 0.4 * r2])
    }

    /// Creates a solid with the given shape and mass (in kilograms). Since a plane has no volume, its inertia is zero.
    pub fn from_shape(shape: &Shape, mass: f64) -> Self {
        match *shape {
            Shape::Sphere { radius } => Self::sphere(mass, radius),
            Shape::Capsule { radius, half_length } => Self::capsule(mass, radius, half_length),
            Shape::Cylinder { radius, half_length } => Self::cylinder(mass, radius, half_length),
            Shape::Box { half } => Self::cuboid(mass, half),
            Shape::Plane => Self::diagonal(mass, [0.0; 3]),
        }
    }

    /// Transforms the mass properties to a frame in which the current frame has the pose `placement`.
    #[must_use]
    pub fn placed(&self, placement: &Pose<f64>) -> Self {
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        // R I: the columns of I turned. Then (R I) R' row by row, I being symmetric.
        let columns = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(|column| placement.rotate(column));
        let row = |i: usize| placement.rotate([columns[0][i], columns[1][i], columns[2][i]]);
        let [x, y, z] = [row(0), row(1), row(2)];
        Self {
            mass: self.mass,
            centre: placement.transform(self.centre),
            inertia: [x[0], y[1], z[2], x[1], x[2], y[2]],
        }
    }

    /// Combines two bodies that are rigidly connected. Both must be given in the same frame. If both masses are zero,
    /// the center of the first body is used.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        let share = if mass > 0.0 { other.mass / mass } else { 0.0 };
        let mut centre = self.centre;
        for i in 0..3 {
            centre[i] += share * (other.centre[i] - self.centre[i]);
        }
        let mut inertia = [0.0; 6];
        for part in [self, other] {
            let [x, y, z] = [0, 1, 2].map(|i| part.centre[i] - centre[i]);
            let steiner = [y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -x * z, -y * z];
            for i in 0..6 {
                inertia[i] += part.inertia[i] + part.mass * steiner[i];
            }
        }
        Self { mass, centre, inertia }
    }

    /// Returns true if a body with this mass and inertia can exist. The mass must be finite and not negative, and no
    /// principal moment may be negative or larger than the sum of the other two. The tolerance is 1e-7 of the sum of
    /// the moments.
    ///
    /// If `moving` is true, the mass and all principal moments must also be > 0, so that accelerations are finite.
    pub fn is_physical(&self, moving: bool) -> bool {
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        let finite = self.mass.is_finite() && self.centre.iter().chain(&self.inertia).all(|x| x.is_finite());
        if !finite || self.mass < 0.0 || (moving && self.mass == 0.0) {
            return false;
        }
        if !moving && self.inertia == [0.0; 6] {
            return true;
        }
        let trace = xx + yy + zz;
        // Flat and thin bodies lie on the border of what is possible: rounding may have pushed them over it. Two
        // moments of an oblique rod are as small as the slack, whose square has to be larger than rounding.
        let slack = 1e-7 * trace.abs();
        let floor = if moving { 0.0 } else { slack };
        // Half the trace less the inertia is the second moment of the mass, which has no negative eigenvalue.
        let half = trace / 2.0 + slack;
        positive_definite([xx + floor, yy + floor, zz + floor, xy, xz, yz])
            && positive_definite([half - xx, half - yy, half - zz, -xy, -xz, -yz])
    }
}

/// Returns whether a symmetric matrix [xx, yy, zz, xy, xz, yz] has positive leading minors.
fn positive_definite([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> bool {
    let last = cross([xx, xy, xz], [xy, yy, yz]);
    xx > 0.0 && xx * yy - xy * xy > 0.0 && last[0] * xz + last[1] * yz + last[2] * zz > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

    fn matrix([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Matrix3<f64> {
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }

    /// Mass properties of the points of a fine grid that `inside` accepts.
    fn summed(mass: f64, reach: f64, inside: impl Fn(f64, f64, f64) -> bool) -> [f64; 3] {
        let n = 100;
        let (mut count, mut moments) = (0.0, [0.0; 3]);
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(n) * reach;
        for i in -n..n {
            for j in -n..n {
                for k in -n..n {
                    let (x, y, z) = (at(i), at(j), at(k));
                    if inside(x, y, z) {
                        count += 1.0;
                        for (m, r2) in moments.iter_mut().zip([y * y + z * z, x * x + z * z, x * x + y * y]) {
                            *m += r2;
                        }
                    }
                }
            }
        }
        moments.map(|m| m * mass / count)
    }

    #[test]
    fn formulas_are_sums_over_points() {
        let (r, h) = (0.3, 0.5);
        let beyond = |z: f64| (z.abs() - h).max(0.0);
        let cases = [
            (MassProperties::sphere(2.0, r), summed(2.0, 0.3, |x, y, z| x * x + y * y + z * z <= r * r)),
            (MassProperties::cuboid(2.0, [0.3, 0.2, 0.1]), summed(2.0, 0.3, |_, y, z| y.abs() < 0.2 && z.abs() < 0.1)),
            (MassProperties::cylinder(2.0, r, h), summed(2.0, 0.5, |x, y, _| x * x + y * y <= r * r)),
            (
                MassProperties::capsule(2.0, r, h),
                summed(2.0, 0.8, |x, y, z| x * x + y * y + beyond(z) * beyond(z) <= r * r),
            ),
        ];
        for (formula, sum) in cases {
            for (a, b) in formula.inertia.iter().zip(sum) {
                assert!((a - b).abs() < 6e-3 * b, "{formula:?} instead of {sum:?}");
            }
        }
        assert_eq!(MassProperties::capsule(2.0, r, 0.0).inertia, MassProperties::sphere(2.0, r).inertia);
    }

    #[test]
    fn placing_turns_the_matrix() {
        let body = MassProperties { mass: 2.0, centre: [0.1, -0.2, 0.3], inertia: [3.0, 4.0, 5.0, 0.3, -0.2, 0.5] };
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(0.3, -0.5, 0.7, 0.2));
        let q = turn.coords;
        let placement = Pose { position: [1.0, 2.0, 3.0], rotation: [q.x, q.y, q.z, q.w] };
        let placed = body.placed(&placement);
        let r = turn.to_rotation_matrix();
        let expected = r.matrix() * matrix(body.inertia) * r.matrix().transpose();
        assert!((matrix(placed.inertia) - expected).norm() < 1e-13);
        let centre = turn * Vector3::from(body.centre) + Vector3::new(1.0, 2.0, 3.0);
        assert!((Vector3::from(placed.centre) - centre).norm() < 1e-14);
        assert!(placed.is_physical(true));
    }

    #[test]
    fn two_half_boxes_are_a_box() {
        let half = MassProperties::cuboid(1.0, [0.1, 0.2, 0.3]);
        let both = half.placed(&Pose::at([0.1, 0.0, 0.0])).with(&half.placed(&Pose::at([-0.1, 0.0, 0.0])));
        let whole = MassProperties::cuboid(2.0, [0.2, 0.2, 0.3]);
        assert_eq!(both.mass, 2.0);
        assert!(both.inertia.iter().zip(whole.inertia).all(|(a, b)| (a - b).abs() < 1e-15));
        assert!(both.centre.iter().all(|x| x.abs() < 1e-15));
        let nothing = MassProperties { mass: 0.0, centre: [1.0; 3], inertia: [0.0; 6] };
        assert_eq!(nothing.with(&nothing).centre, [1.0; 3]);
    }

    #[test]
    fn rods_may_be_thin_in_any_direction() {
        for k in 0..500 {
            let angle = 0.37 * f64::from(k);
            let q = Quaternion::new(0.4, angle.fract() - 0.5, (1.7 * angle).fract() - 0.5, (2.3 * angle).fract() - 0.5);
            let q = UnitQuaternion::from_quaternion(q).coords;
            let placement = Pose { position: [1.0, -0.5, 0.3], rotation: [q.x, q.y, q.z, q.w] };
            for radius in [0.0, 1e-9, 1e-6, 1e-3] {
                let rod = MassProperties::cylinder(0.5, radius, 0.5).placed(&placement);
                assert!(rod.is_physical(false), "{k}: {radius} m");
                assert!(rod.is_physical(true) || radius < 1e-3, "{k}: {radius} m");
            }
        }
    }

    #[test]
    fn impossible_bodies() {
        let ok =
            |inertia: [f64; 6], moving| MassProperties { mass: 1.0, centre: [0.0; 3], inertia }.is_physical(moving);
        assert!(ok([1.0, 1.0, 1.0, 0.0, 0.0, 0.0], true));
        assert!(ok([1.0, 1.0, 2.0, 0.0, 0.0, 0.0], true), "a flat body");
        assert!(!ok([1.0, 1.0, 2.1, 0.0, 0.0, 0.0], true), "more than the sum of the others");
        assert!(!ok([1.0, 1.0, 0.0, 0.0, 0.0, 0.0], true), "a needle cannot turn about itself");
        assert!(ok([1.0, 1.0, 0.0, 0.0, 0.0, 0.0], false), "unless it need not");
        assert!(!ok([1.0, 1.0, 1.0, 1.1, 0.0, 0.0], true), "not positive definite");
        assert!(!ok([-1.0, 1.0, 1.0, 0.0, 0.0, 0.0], false));
        assert!(!ok([1.0, 1.0, f64::NAN, 0.0, 0.0, 0.0], false));
        assert!(ok([0.0; 6], false) && !ok([0.0; 6], true));
        assert!(!MassProperties::sphere(-1.0, 0.1).is_physical(false));
        assert!(!MassProperties::sphere(0.0, 0.1).is_physical(true));
    }
}
