//! Poses and velocities of rigid bodies.

use farsa_num::Real;

/// The position (in meters) and the orientation of a frame. The orientation is a unit quaternion [x, y, z, w].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pose<R = f32> {
    /// Position of the frame's origin in the reference frame (in meters).
    pub position: [R; 3],
    /// Rotation from the frame to the reference frame as a unit quaternion [x, y, z, w].
    pub rotation: [R; 4],
}

/// The velocity of a body. Both components are given in the axes of the world.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Twist<R = f32> {
    /// Velocity of the body's origin, in meters per second.
    pub linear: [R; 3],
    /// Angular velocity (in radians per second).
    pub angular: [R; 3],
}

#[inline(always)]
pub(crate) fn cross<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The Euclidean length.
#[cfg(any(feature = "alloc", test))]
#[inline(always)]
pub(crate) fn norm<R: Real>(v: &[R]) -> R {
    v.iter().fold(R::from_f64(0.0), |sum, x| sum + *x * *x).sqrt()
}

impl<R: Real> Pose<R> {
    /// Returns the pose of the reference frame itself.
    pub fn identity() -> Self {
        let (o, l) = (R::from_f64(0.0), R::from_f64(1.0));
        Self { position: [o, o, o], rotation: [o, o, o, l] }
    }

    /// Creates a pose without rotation at the given `position` (in meters).
    pub fn at(position: [R; 3]) -> Self {
        Self { position, ..Self::identity() }
    }

    /// Creates a pose on the ground at the position (x, y) (in meters). The frame is rotated counter-clockwise about
    /// the vertical axis by `heading` (in radians).
    pub fn planar([x, y]: [R; 2], heading: R) -> Self {
        let o = R::from_f64(0.0);
        let (sine, cosine) = farsa_num::sin_cos(R::from_f64(0.5) * heading);
        Self { position: [x, y, o], rotation: [o, o, sine, cosine] }
    }

    /// Returns the direction of the frame's x axis as seen from above (in radians). The angle is measured
    /// counter-clockwise from the x axis of the reference frame.
    pub fn heading(&self) -> R {
        let [x, y, z, w] = self.rotation;
        let (one, two) = (R::from_f64(1.0), R::from_f64(2.0));
        farsa_num::atan2(two * (w * z + x * y), one - two * (y * y + z * z))
    }

    /// Rotates a vector from this frame to the reference frame.
    #[inline]
    pub fn rotate(&self, v: [R; 3]) -> [R; 3] {
        let [x, y, z, w] = self.rotation;
        let u = [x, y, z];
        let t = cross(u, v);
        let t = [t[0] + t[0], t[1] + t[1], t[2] + t[2]];
        let c = cross(u, t);
        [v[0] + w * t[0] + c[0], v[1] + w * t[1] + c[1], v[2] + w * t[2] + c[2]]
    }

    /// Rotates a vector from the reference frame to this frame.
    #[inline]
    pub fn rotate_back(&self, v: [R; 3]) -> [R; 3] {
        let [x, y, z, w] = self.rotation;
        Self { position: self.position, rotation: [-x, -y, -z, w] }.rotate(v)
    }

    /// Transforms a point (in meters) from this frame to the reference frame.
    #[inline]
    pub fn transform(&self, point: [R; 3]) -> [R; 3] {
        let p = self.rotate(point);
        [p[0] + self.position[0], p[1] + self.position[1], p[2] + self.position[2]]
    }

    /// Transforms a point (in meters) from the reference frame to this frame.
    #[inline]
    pub fn transform_back(&self, point: [R; 3]) -> [R; 3] {
        let p = self.position;
        self.rotate_back([point[0] - p[0], point[1] - p[1], point[2] - p[2]])
    }

    /// Converts the pose `inner` from this frame to the reference frame. You can chain poses with it.
    pub fn compose(&self, inner: &Self) -> Self {
        let [ax, ay, az, aw] = self.rotation;
        let [bx, by, bz, bw] = inner.rotation;
        Self {
            position: self.transform(inner.position),
            rotation: [
                aw * bx + ax * bw + ay * bz - az * by,
                aw * by - ax * bz + ay * bw + az * bx,
                aw * bz + ax * by - ay * bx + az * bw,
                aw * bw - ax * bx - ay * by - az * bz,
            ],
        }
    }

    /// Converts the pose to a different precision. Each number is rounded once.
    #[inline]
    pub fn cast<Q: Real>(&self) -> Pose<Q> {
        Pose {
            position: self.position.map(|x| Q::from_f64(x.to_f64())),
            rotation: self.rotation.map(|x| Q::from_f64(x.to_f64())),
        }
    }
}

impl<R: Real> Default for Pose<R> {
    fn default() -> Self {
        Self::identity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion, Vector3};
    use proptest::prelude::*;

    fn pose() -> impl Strategy<Value = Pose<f64>> {
        let turn = prop::array::uniform4(-1.0..1.0).prop_filter("a direction", |q: &[f64; 4]| norm(q) > 0.1);
        (prop::array::uniform3(-2.0..2.0), turn)
            .prop_map(|(position, q)| Pose { position, rotation: q.map(|x| x / norm(&q)) })
    }

    fn isometry(p: &Pose<f64>) -> Isometry3<f64> {
        let ([x, y, z], [a, b, c, w]) = (p.position, p.rotation);
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, a, b, c));
        Isometry3::from_parts(Translation3::new(x, y, z), turn)
    }

    fn same(a: [f64; 3], b: [f64; 3]) -> bool {
        a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-13)
    }

    proptest! {
        #[test]
        fn agrees_with_nalgebra(a in pose(), b in pose(), v in prop::array::uniform3(-2.0..2.0)) {
            let (ia, ib) = (isometry(&a), isometry(&b));
            prop_assert!(same(a.transform(v), (ia * Point3::from(v)).coords.into()));
            prop_assert!(same(a.rotate(v), (ia * Vector3::from(v)).into()));
            prop_assert!(same(a.compose(&b).transform(v), (ia * ib * Point3::from(v)).coords.into()));
            prop_assert!(same(a.transform_back(a.transform(v)), v));
            prop_assert!(same(a.rotate_back(a.rotate(v)), v));
            prop_assert!((norm(&a.compose(&b).rotation) - 1.0).abs() < 1e-14);
        }

        #[test]
        fn a_heading_is_that_of_the_x_axis_seen_from_above(a in pose()) {
            let [x, y, _] = a.rotate([1.0, 0.0, 0.0]);
            let (sine, cosine) = farsa_num::sin_cos(a.heading());
            let length = norm(&[x, y]);
            prop_assert!((length * cosine - x).abs() < 1e-13 && (length * sine - y).abs() < 1e-13, "{:?}", a);
        }

        #[test]
        fn cast_rounds_once(a in pose()) {
            let narrow: Pose = a.cast();
            prop_assert_eq!(narrow.position, a.position.map(|x| x as f32));
            prop_assert_eq!(narrow.cast::<f64>().rotation, a.rotation.map(|x| f64::from(x as f32)));
        }
    }

    #[test]
    fn a_heading_is_told_as_it_was_given() {
        for heading in [0.0, 0.5, -3.0, 3.1, 1.6_f64] {
            let pose = Pose::planar([1.0, 2.0], heading);
            assert!((pose.heading() - heading).abs() < 1e-14);
            let (sine, cosine) = farsa_num::sin_cos(heading);
            assert!(same(pose.transform([1.0, 0.0, 0.0]), [1.0 + cosine, 2.0 + sine, 0.0]));
        }
    }

    #[test]
    fn identity_changes_nothing() {
        let v = [0.1f32, -7.0, 3.3];
        assert_eq!(Pose::default().transform(v), v);
        assert_eq!(Pose::at([1.0f32, 2.0, 3.0]).transform_back([1.0, 2.0, 3.0]), [0.0; 3]);
        assert_eq!(Pose::at(v).compose(&Pose::identity()), Pose::at(v));
    }
}
