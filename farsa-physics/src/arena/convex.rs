//! Convex obstacles of a planar world, as data.

use alloc::vec::Vec;

use farsa_num::sin_cos;

/// The default color.
pub(crate) const GREY: [f64; 3] = [0.5; 3];

/// The form of a [`Convex`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum ConvexForm {
    /// An upright prism that rests on the ground.
    Prism {
        /// Corners of its base in order, either clockwise or counter-clockwise [m].
        corners: Vec<[f64; 2]>,
        /// Height [m].
        height: f64,
    },
    /// Convex hull of a set of points, which can be in any order. This needs the feature `parry`.
    Hull {
        /// Points of the hull, given as x, y and the height above the ground [m]. The height must not be negative.
        points: Vec<[f64; 3]>,
    },
}

/// A convex obstacle that does not move, in the world's frame.
///
/// In the plane it is its outline as seen from above. Robots collide with the outline, and
/// [`Sight`](farsa_body::ports::Sight) and infrared sensors detect it. Rays in space
/// ([`Rays`](farsa_body::ports::Rays)) hit the solid itself, slopes included. Like a wall, it is no body.
///
/// ```
/// use farsa_body::ports::{Rays, Sight};
/// use farsa_body::robots::MobileRobot;
/// use farsa_physics::arena::{Arena, Convex, World};
///
/// let mut arena = Arena::walled(1.0, 1.0);
/// arena.add_convex(Convex::prism(&[[0.4, 0.4], [0.7, 0.4], [0.4, 0.7]], 0.1));
/// arena.add_robot(MobileRobot::khepera(), [0.2, 0.2], 0.0);
/// let world = World::new(&arena)?;
/// // Past the corner along the diagonal, the long side is met.
/// let sight = world.cast_planar([0.9, 0.9], [-0.5_f32.sqrt(), -0.5_f32.sqrt()], 2.0, None).unwrap();
/// assert!((sight.distance - 0.35 * 2.0_f32.sqrt()).abs() < 1e-6);
/// assert!(world.cast([0.5, 0.1, 0.11], [0.0, 1.0, 0.0], 0.5).is_none());
/// # Ok::<(), farsa_physics::arena::ArenaError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Convex {
    /// Form and place of the obstacle.
    pub form: ConvexForm,
    /// Red, green and blue [0..1].
    pub color: [f64; 3],
}

impl Convex {
    /// Creates a gray upright prism of the given height [m] over the convex polygon with these corners [m].
    ///
    /// Corners follow each other either way round. A corner on the straight line between its neighbors is allowed, a
    /// dent is not.
    pub fn prism(corners: &[[f64; 2]], height: f64) -> Self {
        Self { form: ConvexForm::Prism { corners: corners.into(), height }, color: GREY }
    }

    /// Creates the gray convex hull of a set of points [m], which can be in any order. Their third coordinate is the
    /// height above the ground.
    ///
    /// Needs the feature `parry`. Points within the hull are allowed.
    pub fn hull(points: &[[f64; 3]]) -> Self {
        Self { form: ConvexForm::Hull { points: points.into() }, color: GREY }
    }

    /// Sets the color of the obstacle.
    pub fn with_color(self, color: [f64; 3]) -> Self {
        Self { color, ..self }
    }

    /// Turns the obstacle counter-clockwise about the origin by `heading` [rad] and then moves it by `at` [m].
    pub fn placed(self, at: [f64; 2], heading: f64) -> Self {
        let (sine, cosine) = sin_cos(heading);
        let place = |x: f64, y: f64| [at[0] + (x * cosine - y * sine), at[1] + (x * sine + y * cosine)];
        let form = match self.form {
            ConvexForm::Prism { corners, height } => {
                ConvexForm::Prism { corners: corners.iter().map(|[x, y]| place(*x, *y)).collect(), height }
            }
            ConvexForm::Hull { points } => {
                let points = points.iter().map(|[x, y, z]| {
                    let [x, y] = place(*x, *y);
                    [x, y, *z]
                });
                ConvexForm::Hull { points: points.collect() }
            }
        };
        Self { form, ..self }
    }

    /// Computes the corners of its outline as seen from above [m]. They are counter-clockwise and begin with the lowest
    /// x. If the obstacle has no area, there are fewer than three.
    pub fn outline(&self) -> Vec<[f64; 2]> {
        match &self.form {
            ConvexForm::Prism { corners, .. } => crate::arena::outline::hull(corners),
            ConvexForm::Hull { points } => {
                crate::arena::outline::hull(&points.iter().map(|[x, y, _]| [*x, *y]).collect::<Vec<_>>())
            }
        }
    }

    /// Height of its highest point above the ground [m].
    pub fn height(&self) -> f64 {
        match &self.form {
            ConvexForm::Prism { height, .. } => *height,
            ConvexForm::Hull { points } => points.iter().fold(0.0, |most: f64, [.., z]| most.max(*z)),
        }
    }
}
