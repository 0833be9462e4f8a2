//! A model for the response of infrared sensors to surfaces.

use farsa_num::Scalar;

/// The response of an infrared sensor to a surface of a given radius. It is computed by a formula and does not need a
/// table.
///
/// The reading of a sensor is the sum of `distance_term * angle_term` over all surfaces, clamped to [0, 1].
/// - `distance_term = clamp((far - d) / (far - near), 0, 1)`, where `d` is the distance between the hull of the robot
///   and the nearest point of the surface (in meters).
/// - `angle_term = s^2` with `s = max((cos(a) - cos(width)) / (1 - cos(width)), 0)`, where `a` is the angle between the
///   axis of the sensor and the bearing of that point from the center of the robot. It is 1 straight ahead, 1/2 at
///   about half the width, and decreases smoothly to 0 at the width.
///
/// | | curvature [1/m] | near [mm] | far [mm] | width [deg] |
/// |---|---|---|---|---|
/// | wall | 0 | 13 | 33 | 50 |
/// | cylinder of 27 mm | 37 | 11.1 | 29.3 | 32 |
/// | cylinder of 12.5 mm or less | 80 | 9 | 25 | 32 |
///
/// Between these rows, all values are interpolated linearly in the curvature. For the width, its cosine is
/// interpolated.
///
/// The near and far distances are those of the analytic sensor of FARSA2. The widths were derived from the measured
/// Khepera of FARSA2 as the mean of seven sensors at distances without saturation. They are the angles at which the
/// mean response is half of its maximum (25 degrees for a wall and 17 degrees for both cylinders). Deviations from the
/// measurements: all sensors are identical, and each sensor points away from the center of the robot.
///
/// ```
/// use farsa_body::sensors::infrared::InfraredModel;
///
/// let wall = InfraredModel::for_radius(0.0);
/// assert!((wall.response(0.010_f32, 1.0) - 1.0).abs() < 1e-6);
/// assert!((wall.response(0.023_f32, 1.0) - 0.5).abs() < 1e-6);
/// assert_eq!(wall.response(0.010_f32, 0.0), 0.0);
/// assert!(InfraredModel::for_radius(0.0125).response(0.023_f32, 1.0) < 0.2);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InfraredModel {
    /// Where the response ends [m].
    far: f32,
    /// Its slope with the distance [1/m].
    per_metre: f32,
    /// Cosine of the width.
    edge: f32,
    /// Slope of `s` with the cosine.
    per_cosine: f32,
}

/// Where a wall saturates and where it is lost [m].
const WALL: [f64; 2] = [0.013, 0.033];
/// Where the small cylinder saturates and where it is lost [m].
const SMALL: [f64; 2] = [0.009, 0.025];
/// Curvature of the small cylinder [1/m].
const SMALL_CURVATURE: f64 = 1.0 / 0.0125;
/// Curvature from which on the width stays the same [1/m].
const ROUND_CURVATURE: f64 = 1.0 / 0.027;
/// Cosines of the widths of a wall and of cylinders: 50 and 32 degrees.
const EDGE: [f64; 2] = [0.642_787_609_686_539_3, 0.848_048_096_156_426];

fn between([a, b]: [f64; 2], part: f64) -> f64 {
    a + (b - a) * part
}

impl InfraredModel {
    /// Distances from the hull at which a sensor in front of a wall reads 0 and 1 (in meters).
    ///
    /// These values are useful for tables of channels. Between them the reading decreases linearly with the distance.
    /// It also decreases with the angle.
    pub const WALL_ENDS: [f64; 2] = [WALL[1], WALL[0]];

    /// Returns the model for a surface with the given radius (in meters). The values 0, NaN and negative numbers
    /// represent a wall.
    pub fn for_radius(radius: f32) -> Self {
        let curvature = if radius > 0.0 { 1.0 / f64::from(radius) } else { 0.0 };
        let part = Scalar::min(curvature / SMALL_CURVATURE, 1.0);
        let (near, far) = (between([WALL[0], SMALL[0]], part), between([WALL[1], SMALL[1]], part));
        let edge = between(EDGE, Scalar::min(curvature / ROUND_CURVATURE, 1.0));
        Self {
            far: far as f32,
            per_metre: (1.0 / (far - near)) as f32,
            edge: edge as f32,
            per_cosine: (1.0 / (1.0 - edge)) as f32,
        }
    }

    /// Gets the distance from the hull at which the response ends (in meters).
    pub fn range(&self) -> f32 {
        self.far
    }

    /// Computes the response to one surface. The result is between 0 and 1.
    ///
    /// The `distance` is measured from the hull of the robot to the nearest point of the surface (in meters). The
    /// `cosine` is that of the angle between the axis of the sensor and the bearing of this point from the center of
    /// the robot. If one of them is NaN, the response is 0.
    #[inline(always)]
    pub fn response<S: Scalar>(&self, distance: S, cosine: S) -> S {
        self.distance_term(distance) * self.angle_term(cosine)
    }

    /// Computes the factor of [`response`](Self::response) that is common to all sensors of a robot (between 0 and 1).
    #[inline(always)]
    pub fn distance_term<S: Scalar>(&self, distance: S) -> S {
        let slope = distance.constant(f64::from(self.per_metre));
        let far = distance.constant(f64::from(self.far));
        ((far - distance) * slope).clamp(distance.constant(0.0), distance.constant(1.0))
    }

    /// Computes the factor of [`response`](Self::response) that depends on the direction of the sensor (between 0 and
    /// 1).
    #[inline(always)]
    pub fn angle_term<S: Scalar>(&self, cosine: S) -> S {
        let slope = cosine.constant(f64::from(self.per_cosine));
        let edge = cosine.constant(f64::from(self.edge));
        // A cosine of rounded vectors may lie a little above 1.
        let s = ((cosine - edge) * slope).clamp(cosine.constant(0.0), cosine.constant(1.0));
        s * s
    }

    /// Converts the sum of the responses to a reading by clamping it to [0, 1].
    #[inline(always)]
    pub fn reading<S: Scalar>(sum: S) -> S {
        sum.clamp(sum.constant(0.0), sum.constant(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_num::Real;
    use proptest::prelude::*;

    /// Near and far [m], cosine of the width, as the model uses them.
    fn constants(model: &InfraredModel) -> [f64; 3] {
        let far = model.far.to_f64();
        [far - 1.0 / model.per_metre.to_f64(), far, model.edge.to_f64()]
    }

    #[test]
    fn the_documented_table_is_true() {
        let rows = [(0.0, [0.013, 0.033, 50.0]), (0.027, [0.01115, 0.0293, 32.0]), (0.0125, [0.009, 0.025, 32.0])];
        for (radius, [near, far, width]) in rows {
            let [n, f, edge] = constants(&InfraredModel::for_radius(radius));
            let cosine = farsa_num::sin_cos::<f64>(width * core::f64::consts::PI / 180.0).1;
            assert!((n - near).abs() < 1e-5 && (f - far).abs() < 1e-5 && (edge - cosine).abs() < 1e-6, "{radius}");
        }
        assert_eq!(InfraredModel::for_radius(0.001), InfraredModel::for_radius(0.0125));
        assert_eq!(InfraredModel::for_radius(f32::NAN), InfraredModel::for_radius(0.0));
    }

    #[test]
    fn a_wall_reads_0_and_1_at_its_ends() {
        let wall = InfraredModel::for_radius(0.0);
        let [zero, one] = InfraredModel::WALL_ENDS.map(|distance| wall.response(distance as f32, 1.0));
        assert!(zero.abs() < 1e-6 && (one - 1.0).abs() < 1e-6, "{zero} {one}");
        let between = InfraredModel::WALL_ENDS.map(|end| 0.999 * end + 0.001 * 0.023);
        let within = between.map(|distance| wall.response(distance as f32, 1.0));
        assert!(within[0] > 0.0 && within[1] < 1.0, "{within:?}");
    }

    #[test]
    fn half_the_response_is_at_half_the_width() {
        for (radius, degrees) in [(0.0, 26.0_f64), (0.0125, 17.0)] {
            let cosine = farsa_num::sin_cos(degrees * core::f64::consts::PI / 180.0).1 as f32;
            let half = InfraredModel::for_radius(radius).angle_term(cosine);
            assert!((half - 0.5).abs() < 0.03, "{radius}: {half}");
        }
    }

    proptest! {
        #[test]
        fn falls_with_distance_and_angle(
            radius in 0.0_f32..0.1, d in -0.05_f32..0.05, further in 0.0_f32..0.05, c in -1.0_f32..1.0, off in 0.0_f32..1.0,
        ) {
            let model = InfraredModel::for_radius(radius);
            let here = model.response(d, c);
            prop_assert!((0.0..=1.0).contains(&here));
            prop_assert!(model.response(d + further, c) <= here);
            prop_assert!(model.response(d, c - off) <= here);
            prop_assert_eq!(model.response(model.range(), c), 0.0);
            // A rounder thing is seen less.
            prop_assert!(model.response(d, c) <= InfraredModel::for_radius(0.0).response(d, c) + 1e-6);
        }
    }

    #[test]
    fn what_is_no_number_is_not_seen() {
        let wall = InfraredModel::for_radius(0.0);
        assert_eq!([wall.response(f32::NAN, 1.0), wall.response(0.0, f32::NAN)], [0.0; 2]);
    }
}
