//! The response of an infrared sensor to a surface: the analytic model.

use farsa_num::Scalar;

/// The response of an infrared sensor to a surface of one radius, as a formula instead of a table.
///
/// A sensor reads the sum over all surfaces of `distance_term * angle_term`, brought into [0, 1].
/// - `distance_term = clamp((far - d) / (far - near), 0, 1)`, with `d` the distance from the robot's hull to the nearest
///   point of the surface [m].
/// - `angle_term = s^2`, `s = max((cos(a) - cos(width)) / (1 - cos(width)), 0)`, with `a` the angle between the
///   sensor's axis and the bearing of that point from the robot's center. It is 1 ahead, 1/2 at about half the width,
///   and smoothly 0 at the width.
///
/// | | curvature [1/m] | near [mm] | far [mm] | width [deg] |
/// |---|---|---|---|---|
/// | wall | 0 | 13 | 33 | 50 |
/// | cylinder of 27 mm | 37 | 11.1 | 29.3 | 32 |
/// | cylinder of 12.5 mm or less | 80 | 9 | 25 | 32 |
///
/// Between these rows everything is linear in the curvature, the width by its cosine.
///
/// Near and far are those of FARSA2's analytic sensor. The widths come from the mean of seven sensors of its measured
/// Khepera, at distances without saturation. They are the angles at which the mean falls to half of its peak (25
/// degrees for a wall, 17 for either cylinder). Deviations from those measurements: all sensors are alike, and each
/// points away from the robot's center.
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
    /// Where a wall straight before a sensor reads 0 and where it reads 1, by its distance from the hull [m].
    ///
    /// Both ends of a table of channels: between them a reading falls in proportion to the distance, and with the angle.
    pub const WALL_ENDS: [f64; 2] = [WALL[1], WALL[0]];

    /// The model of a surface with this radius [m]. 0, negative and NaN are a wall's.
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

    /// The distance from the hull at which the response ends [m].
    pub fn range(&self) -> f32 {
        self.far
    }

    /// Returns the response to one surface [0..1].
    ///
    /// `distance` is that from the robot's hull to the surface's nearest point [m]. `cosine` is that of the angle
    /// between the sensor's axis and the bearing of this point from the robot's center. The response is 0 for a
    /// distance or an angle that is NaN.
    #[inline(always)]
    pub fn response<S: Scalar>(&self, distance: S, cosine: S) -> S {
        self.distance_term(distance) * self.angle_term(cosine)
    }

    /// The part of [`response`](Self::response) that all sensors of a robot share [0..1].
    #[inline(always)]
    pub fn distance_term<S: Scalar>(&self, distance: S) -> S {
        let slope = distance.constant(f64::from(self.per_metre));
        let far = distance.constant(f64::from(self.far));
        ((far - distance) * slope).clamp(distance.constant(0.0), distance.constant(1.0))
    }

    /// The part of [`response`](Self::response) that depends on where the sensor looks [0..1].
    #[inline(always)]
    pub fn angle_term<S: Scalar>(&self, cosine: S) -> S {
        let slope = cosine.constant(f64::from(self.per_cosine));
        let edge = cosine.constant(f64::from(self.edge));
        // A cosine of rounded vectors may lie a little above 1.
        let s = ((cosine - edge) * slope).clamp(cosine.constant(0.0), cosine.constant(1.0));
        s * s
    }

    /// Returns the reading for all surfaces: the sum of their responses, clamped to [0, 1].
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
