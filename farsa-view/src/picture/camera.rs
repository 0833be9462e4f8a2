//! Cameras, and their views of pictures.

use crate::error::Error;
use crate::recording::view::View;
use crate::shape::vector::{Vector, across, add, along, cross, dot, scale, sub, unit};

/// A camera that looks from a named direction. Its frame is fitted to the scene.
///
/// If you don't need a particular direction, use [`Camera::default`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    name: &'static str,
    /// Direction from the scene to the camera, of any length.
    towards: Vector,
    /// True for a parallel projection.
    parallel: bool,
    /// True if the frame is fitted only to things and the hands that handle them.
    close: bool,
}

const fn camera(name: &'static str, towards: Vector) -> Camera {
    Camera { name, towards, parallel: false, close: false }
}

/// All cameras, the default first. Robots face along +X.
const CAMERAS: [Camera; 5] = [
    camera("three-quarter", [0.80, -0.75, 0.62]),
    camera("front", [1.0, 0.0, 0.30]),
    camera("side", [0.0, -1.0, 0.20]),
    Camera { parallel: true, ..camera("top", [0.0, 0.0, 1.0]) },
    Camera { close: true, ..camera("close", [1.0, -0.10, 0.34]) },
];

/// Half the shorter edge of the frame at distance 1, an angle of 23 degrees from edge to edge.
const TANGENT: f64 = 0.2;
/// Largest share of the frame that the scene fills.
const FILLED: f64 = 0.88;
/// Least distance of a camera to the scene [m].
const NEAR: f64 = 1e-3;

/// Projection of the world to a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Window {
    /// Eye, or for a parallel projection a point in front of the scene [m].
    pub(crate) eye: Vector,
    /// Directions to the right, upward and toward the viewer.
    pub(crate) axes: [Vector; 3],
    /// Pixels per tangent of the angle of sight, or per meter in a parallel projection.
    pub(crate) focal: f64,
    /// True for a parallel projection.
    pub(crate) parallel: bool,
    /// Width and height [pixels].
    pub(crate) size: [u32; 2],
    /// Center of the scene, in the world [m].
    pub(crate) centre: Vector,
    /// Radius of a ball around the center that contains the scene [m].
    pub(crate) radius: f64,
}

impl Default for Camera {
    fn default() -> Self {
        CAMERAS[0]
    }
}

impl Camera {
    /// Names of all cameras, starting with the default one.
    pub const NAMES: [&'static str; 5] = {
        let mut names = [""; 5];
        let mut i = 0;
        while i < names.len() {
            names[i] = CAMERAS[i].name;
            i += 1;
        }
        names
    };

    /// Finds a camera by its name. See [`NAMES`](Self::NAMES) for all names.
    ///
    /// # Errors
    /// If there is no such camera, returns [`Error::UnknownCamera`] with the nearest valid name.
    pub fn named(name: &str) -> Result<Self, Error> {
        let camera = CAMERAS.into_iter().find(|camera| camera.name == name);
        camera.ok_or_else(|| Error::unknown_camera(name, Self::NAMES))
    }

    /// Gets the initial camera of a view.
    pub fn for_view(view: View) -> Self {
        match view {
            View::Free => CAMERAS[0],
            View::Top => CAMERAS[3],
        }
    }

    /// Gets the name of this camera.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// True if the frame is fitted only to things and the hands that handle them.
    pub(crate) fn is_close(&self) -> bool {
        self.close
    }

    /// Returns the nearest view in this direction that shows all balls in a frame of width and height [pixels].
    pub(crate) fn fit(&self, mut balls: Vec<(Vector, f64)>, size: [u32; 2]) -> Window {
        let size = size.map(|x| x.max(1));
        if balls.is_empty() {
            balls.push(([0.0; 3], 0.5));
        }
        let back = unit(self.towards);
        let right = cross([0.0, 0.0, 1.0], back);
        // From above, X points to the right and Y upward.
        let right = if dot(right, right) > 1e-12 { unit(right) } else { [1.0, 0.0, 0.0] };
        let axes = [right, cross(back, right), back];

        let range = |axis: Vector| {
            let low = balls.iter().map(|(c, r)| dot(*c, axis) - r).fold(f64::INFINITY, f64::min);
            let high = balls.iter().map(|(c, r)| dot(*c, axis) + r).fold(f64::NEG_INFINITY, f64::max);
            [low, high]
        };
        let ranges = axes.map(range);
        let centre = (0..3).fold([0.0; 3], |sum, i| along(sum, axes[i], f64::midpoint(ranges[i][0], ranges[i][1])));
        let distance = |(c, r): &(Vector, f64)| crate::shape::vector::length(sub(*c, centre)) + r;
        let radius = balls.iter().map(distance).fold(1e-3, f64::max);
        let [width, height] = size.map(f64::from);
        let shorter = width.min(height) / 2.0;

        if self.parallel {
            let half = [0, 1].map(|i| ((ranges[i][1] - ranges[i][0]) / 2.0).max(1e-3));
            let focal = FILLED * (width / 2.0 / half[0]).min(height / 2.0 / half[1]);
            // Above everything in the scene.
            let eye = along(centre, back, 10.0 * radius + 10.0);
            return Window { eye, axes, focal, parallel: true, size, centre, radius };
        }
        let focal = shorter / TANGENT;
        // Every ball must be within the four planes through the eye e and the edges of the (reduced) frame. These conditions
        // are linear in e, such as x - e_x <= t (e_z - z) - r sqrt(1 + t^2). The nearest eye touches two or more of them.
        let planes = [width, height].map(|extent| FILLED * extent / 2.0 / focal);
        let mut bounds = [[f64::NEG_INFINITY; 2]; 2];
        for (c, r) in &balls {
            let depth = dot(*c, back);
            for (i, t) in planes.into_iter().enumerate() {
                let (x, room) = (dot(*c, axes[i]), t * depth + r * (1.0 + t * t).sqrt());
                bounds[i] = [bounds[i][0].max(room - x), bounds[i][1].max(room + x)];
            }
        }
        let need = |i: usize| (bounds[i][0] + bounds[i][1]) / (2.0 * planes[i]);
        let height_of_eye = need(0).max(need(1)).max(ranges[2][1] + 0.1 * radius + NEAR);
        let sideways = |i: usize| (bounds[i][1] - bounds[i][0]) / 2.0;
        let eye = scale(back, height_of_eye);
        let eye = add(eye, add(scale(right, sideways(0)), scale(axes[1], sideways(1))));
        Window { eye, axes, focal, parallel: false, size, centre, radius }
    }
}

impl Window {
    /// Computes the depth of a point in front of the eye [m].
    pub(crate) fn depth(&self, point: Vector) -> f64 {
        -dot(sub(point, self.eye), self.axes[2])
    }

    /// Computes the place of a point in the picture from the upper left corner [pixels], `None` behind the eye.
    pub(crate) fn project(&self, point: Vector) -> Option<[f64; 2]> {
        let depth = self.depth(point);
        let from = sub(point, self.eye);
        let share = if self.parallel { self.focal } else { self.focal / depth };
        let [width, height] = self.size.map(f64::from);
        let place = [width / 2.0 + share * dot(from, self.axes[0]), height / 2.0 - share * dot(from, self.axes[1])];
        (self.parallel || depth >= NEAR).then_some(place)
    }

    /// Returns the start [m] and the unit direction of the ray through a place in the picture [pixels].
    pub(crate) fn ray(&self, place: [f64; 2]) -> (Vector, Vector) {
        let [width, height] = self.size.map(f64::from);
        let (x, y) = ((place[0] - width / 2.0) / self.focal, (height / 2.0 - place[1]) / self.focal);
        let [right, up, back] = self.axes;
        let aside = add(scale(right, x), scale(up, y));
        if self.parallel { (add(self.eye, aside), scale(back, -1.0)) } else { (self.eye, unit(sub(aside, back))) }
    }

    /// Computes the unit direction of view to a point.
    pub(crate) fn sight(&self, point: Vector) -> Vector {
        if self.parallel { scale(self.axes[2], -1.0) } else { unit(sub(point, self.eye)) }
    }

    /// Computes the size of a pixel on a surface at a point that faces the eye [m].
    pub(crate) fn pixel(&self, point: Vector) -> f64 {
        if self.parallel { 1.0 / self.focal } else { self.depth(point).max(NEAR) / self.focal }
    }

    /// Clips a polygon to the part in front of the eye.
    pub(crate) fn before(&self, corners: &[Vector]) -> Vec<Vector> {
        if self.parallel {
            return corners.to_vec();
        }
        // A little beyond the limit of projection, so that all remaining points can be projected.
        crate::picture::outline::clip(corners, |point| self.depth(*point) - 2.0 * NEAR, crate::shape::vector::mix)
    }

    /// Computes the direction from the scene to the light, at the upper left in front of the scene.
    pub(crate) fn key_light(&self) -> Vector {
        let [right, up, back] = self.axes;
        if back[2] > 0.99 {
            // Long shadows would hide their objects.
            return unit(add([0.0, 0.0, 2.6], add(scale(right, -0.62), scale(up, 0.62))));
        }
        let ahead = unit([back[0], back[1], 0.0]);
        unit(add([0.0, 0.0, 1.55], add(scale(right, -0.62), scale(ahead, 0.48))))
    }

    /// Returns directions to `count` points spread evenly over the light, which is as wide as a lamp shade.
    pub(crate) fn lights(&self, count: usize) -> Vec<Vector> {
        let key = self.key_light();
        let [u, v] = across(key);
        let disc = |i: usize| {
            // Vogel's spiral, with the golden angle from one point to the next.
            let (sine, cosine) = farsa_num::sin_cos(i as f64 * 2.399_963_229_728_653);
            let radius = 0.05 * ((i as f64 + 0.5) / count as f64).sqrt();
            unit(add(key, add(scale(u, radius * cosine), scale(v, radius * sine))))
        };
        (0..count).map(disc).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::moment::Picture;
    use crate::shape::appearance::{Instance, Role};
    use crate::shape::geometry::{Geometry, Sight};
    use farsa_body::Pose;
    use proptest::prelude::*;

    fn placed() -> impl Strategy<Value = Instance> {
        let size = || 0.02..0.6;
        let geometry = prop_oneof![
            size().prop_map(|radius| Geometry::Sphere { radius }),
            (size(), size()).prop_map(|(radius, half_length)| Geometry::Capsule { radius, half_length }),
            (size(), size()).prop_map(|(radius, half_length)| Geometry::Cylinder { radius, half_length }),
            prop::array::uniform3(size()).prop_map(|half| Geometry::Box { half }),
        ];
        let turn = prop::array::uniform4(-1.0..1.0);
        let turn = turn.prop_filter("a turn", |q: &[f64; 4]| q.iter().map(|x| x * x).sum::<f64>() > 0.1);
        (geometry, prop::array::uniform3(-2.0..2.0), turn).prop_map(|(geometry, position, q)| {
            let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            Instance::new(geometry, Pose { position, rotation: q.map(|x| x / length) }, Role::Object)
        })
    }

    proptest! {
        #[test]
        fn all_that_is_looked_for_is_in_the_frame(
            shapes in prop::collection::vec(placed(), 1..6), which in 0..5usize, width in 50u32..2000, height in 50u32..2000,
        ) {
            let picture = Picture { shapes, ..Picture::default() };
            let view = picture.window(CAMERAS[which], [width, height]);
            for placed in &picture.shapes {
                let sight = if view.parallel {
                    Sight::Along(placed.pose.rotate_back(view.axes[2]))
                } else {
                    Sight::Eye(placed.pose.transform_back(view.eye))
                };
                for point in placed.geometry.rim(sight, 24) {
                    let [x, y] = view.project(placed.pose.transform(point)).unwrap();
                    prop_assert!(x >= 0.0 && x <= f64::from(width), "{x} of {width}");
                    prop_assert!(y >= 0.0 && y <= f64::from(height), "{y} of {height}");
                }
            }
        }

        #[test]
        fn a_ray_goes_through_what_is_projected(
            point in prop::array::uniform3(-1.0..1.0), which in 0..5usize, size in prop::array::uniform2(50u32..2000),
        ) {
            let picture = Picture {
                shapes: vec![Instance::new(Geometry::Box { half: [1.0; 3] }, Pose::identity(), Role::Object)],
                ..Picture::default()
            };
            let view = picture.window(CAMERAS[which], size);
            let (origin, direction) = view.ray(view.project(point).unwrap());
            let from = sub(point, origin);
            let aside = sub(from, scale(direction, dot(from, direction)));
            prop_assert!(dot(aside, aside) < 1e-18);
            prop_assert!((dot(view.sight(point), direction) - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn cameras_have_names() {
        for name in Camera::NAMES {
            assert_eq!(Camera::named(name).unwrap().name(), name);
        }
        assert_eq!(Camera::default().name(), "three-quarter");
        let error = Camera::named("tree-quarter").unwrap_err();
        assert_eq!(error.to_string(), "unknown camera `tree-quarter`; the nearest is `three-quarter`");
        let nothing = Picture::default().window(Camera::default(), [0, 0]);
        assert!(nothing.project([0.0; 3]).is_some());
    }
}
