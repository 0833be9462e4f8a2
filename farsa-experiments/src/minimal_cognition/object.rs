//! The falling objects of `minimal-cognition`, and their intersections with rays.

/// The shape of a falling object. Coordinates are relative to its center.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Object {
    /// A circle that the agent has to catch.
    Circle {
        /// Radius of the circle.
        radius: f64,
    },
    /// A square that the agent has to avoid. It is rotated by 45 degrees and contains all points with |x| + |y| <=
    /// `half`.
    Diamond {
        /// Half the length of the diagonal.
        half: f64,
    },
}

impl Object {
    /// Creates a circle with the given diameter.
    pub fn circle(diameter: f64) -> Self {
        Self::Circle { radius: 0.5 * diameter }
    }

    /// Creates a diamond with the given side length.
    pub fn diamond(side: f64) -> Self {
        Self::Diamond { half: side * core::f64::consts::FRAC_1_SQRT_2 }
    }

    /// Returns the name of the shape.
    pub fn name(self) -> &'static str {
        match self {
            Self::Circle { .. } => "circle",
            Self::Diamond { .. } => "diamond",
        }
    }

    /// Computes the distance at which a ray enters the object. The origin `from` is relative to the center of the
    /// object, and `direction` must be a unit vector. Returns 0 if the ray starts inside the object, and `None` if it
    /// misses the object.
    pub fn meet(self, from: [f64; 2], direction: [f64; 2]) -> Option<f64> {
        let ([x, y], [u, v]) = (from, direction);
        let [first, last] = match self {
            Self::Circle { radius } => {
                let middle = -(x * u + y * v);
                // From the nearest point: its square is exact where the textbook's discriminant cancels.
                let (x, y) = (x + middle * u, y + middle * v);
                let left = radius * radius - (x * x + y * y);
                if left < 0.0 {
                    return None;
                }
                let half = left.sqrt();
                [middle - half, middle + half]
            }
            // Along the diagonals x + y and y - x it is a square.
            Self::Diamond { half } => {
                let [a, b] = [slab(y + x, v + u, half), slab(y - x, v - u, half)];
                [a[0].max(b[0]), a[1].min(b[1])]
            }
        };
        (first <= last && last >= 0.0).then(|| first.max(0.0))
    }
}

/// The distances between which a ray is within `half` of 0 on one axis. The range is empty if first > last.
fn slab(origin: f64, direction: f64, half: f64) -> [f64; 2] {
    if direction == 0.0 {
        let inside = origin.abs() <= half;
        return if inside { [f64::NEG_INFINITY, f64::INFINITY] } else { [f64::INFINITY, f64::NEG_INFINITY] };
    }
    // |origin + t direction| = half at both ends of the slab. min and max order them for rays from either side.
    let (a, b) = ((-half - origin) / direction, (half - origin) / direction);
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_num::sin_cos;
    use proptest::prelude::*;

    fn within(object: Object, [x, y]: [f64; 2]) -> bool {
        match object {
            Object::Circle { radius } => x * x + y * y <= radius * radius,
            Object::Diamond { half } => x.abs() + y.abs() <= half,
        }
    }

    /// Marches along the ray in small steps and bisects the step that enters. Rays that graze by less than a step are
    /// missed.
    fn marched(object: Object, from: [f64; 2], direction: [f64; 2]) -> Option<f64> {
        const STEP: f64 = 0.02;
        let at = |distance: f64| [0, 1].map(|k| from[k] + distance * direction[k]);
        let entered = (0..20_000).find(|step| within(object, at(f64::from(*step) * STEP)))?;
        let (mut outside, mut inside) = (f64::from(entered - 1) * STEP, f64::from(entered) * STEP);
        if entered == 0 {
            return Some(0.0);
        }
        for _ in 0..60 {
            let middle = 0.5 * (outside + inside);
            *(if within(object, at(middle)) { &mut inside } else { &mut outside }) = middle;
        }
        Some(inside)
    }

    fn objects() -> impl Strategy<Value = Object> {
        let size = 10.0..40.0;
        prop_oneof![size.clone().prop_map(Object::circle), size.prop_map(Object::diamond)]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn rays_meet_what_a_walk_along_them_meets(
            object in objects(), x in -60.0..60.0_f64, y in -260.0..30.0_f64, angle in -0.6..0.6_f64,
        ) {
            let (sine, cosine) = sin_cos(angle);
            let (from, direction) = ([x, y], [sine, cosine]);
            let (met, expected) = (object.meet(from, direction), marched(object, from, direction));
            match (met, expected) {
                (Some(met), Some(expected)) => prop_assert!((met - expected).abs() < 1e-9, "{met} {expected}"),
                // The march stepped over the object: the way through it is short.
                (Some(met), None) => {
                    let beyond = met + 0.021;
                    prop_assert!(!within(object, [x + beyond * sine, y + beyond * cosine]));
                }
                (None, Some(expected)) => prop_assert!(false, "missed at {expected}"),
                (None, None) => {}
            }
        }

        #[test]
        fn a_mirrored_ray_is_as_long_to_the_bit(
            object in objects(), x in -60.0..60.0_f64, y in -260.0..30.0_f64, angle in -0.6..0.6_f64,
        ) {
            let (sine, cosine) = sin_cos(angle);
            prop_assert_eq!(object.meet([x, y], [sine, cosine]), object.meet([-x, y], [-sine, cosine]));
        }
    }

    #[test]
    fn known_rays() {
        let (circle, diamond) = (Object::circle(30.0), Object::diamond(30.0));
        let up = [0.0, 1.0];
        assert_eq!(circle.meet([0.0, -100.0], up), Some(85.0));
        assert_eq!(circle.meet([9.0, -100.0], up), Some(88.0));
        let half = 30.0 / 2.0_f64.sqrt();
        assert!((diamond.meet([0.0, -100.0], up).unwrap() - (100.0 - half)).abs() < 1e-12);
        assert!((diamond.meet([10.0, -100.0], up).unwrap() - (110.0 - half)).abs() < 1e-12);
        for object in [circle, diamond] {
            assert_eq!(object.meet([22.0, -100.0], up), None, "beside");
            assert_eq!(object.meet([0.0, 100.0], up), None, "behind");
            assert_eq!(object.meet([1.0, 2.0], up), Some(0.0), "within");
        }
        assert_eq!([circle, diamond].map(Object::name), ["circle", "diamond"]);
    }
}
