//! Geometries of pictures, with their rays and outlines.

use farsa_body::robot::Shape;
use farsa_num::sin_cos;

use crate::shape::vector::{Vector, across, add, along, dot, length, scale, sub, unit};

/// Geometry of a shape in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Geometry {
    /// Ball around the origin.
    Sphere {
        /// Radius [m].
        radius: f64,
    },
    /// All points with a distance of at most `radius` from the z axis between `-half_length` and `half_length`.
    Capsule {
        /// Radius [m].
        radius: f64,
        /// Half the length of its axis [m].
        half_length: f64,
    },
    /// Solid cylinder around the z axis, from `-half_length` to `half_length`.
    Cylinder {
        /// Radius [m].
        radius: f64,
        /// Half the height [m].
        half_length: f64,
    },
    /// Box around the origin.
    Box {
        /// Half the edge lengths along x, y and z [m].
        half: Vector,
    },
    /// Half space with z <= 0. Pictures only show a piece of its surface.
    Plane,
    /// Flat disc around the origin, in the plane z = 0.
    Disc {
        /// Radius [m].
        radius: f64,
    },
    /// Flat rectangle around the origin, in the plane z = 0.
    Rectangle {
        /// Half the edge lengths along x and y [m].
        half: [f64; 2],
    },
}

/// Hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Meeting {
    /// Distance along the ray [m].
    pub(crate) distance: f64,
    /// Unit normal of the surface, which points outward.
    pub(crate) normal: Vector,
}

/// Viewpoint of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sight {
    /// Position of the eye [m].
    Eye(Vector),
    /// Unit direction of a parallel projection.
    Along(Vector),
}

impl From<Shape> for Geometry {
    fn from(shape: Shape) -> Self {
        match shape {
            Shape::Sphere { radius } => Self::Sphere { radius },
            Shape::Capsule { radius, half_length } => Self::Capsule { radius, half_length },
            Shape::Cylinder { radius, half_length } => Self::Cylinder { radius, half_length },
            Shape::Box { half } => Self::Box { half },
            Shape::Plane => Self::Plane,
        }
    }
}

fn ball(origin: Vector, direction: Vector, centre: Vector, radius: f64) -> Option<Meeting> {
    let from = sub(origin, centre);
    let towards = dot(from, direction);
    // The nearest point of the ray to the center, whose square is exact where the usual discriminant cancels.
    let nearest = along(from, direction, -towards);
    let left = radius * radius - dot(nearest, nearest);
    let distance = -towards - left.max(0.0).sqrt();
    (left >= 0.0 && distance >= 0.0)
        .then(|| Meeting { distance, normal: scale(along(from, direction, distance), 1.0 / radius) })
}

/// Computes the distances between which a ray is within `half` of 0 on one axis, empty if first > last.
fn slab(origin: f64, direction: f64, half: f64) -> [f64; 2] {
    if direction == 0.0 {
        let inside = origin.abs() <= half;
        return if inside { [f64::NEG_INFINITY, f64::INFINITY] } else { [f64::INFINITY, f64::NEG_INFINITY] };
    }
    let (a, b) = ((-half - origin) / direction, (half - origin) / direction);
    [a.min(b), a.max(b)]
}

/// Computes the distances between which a ray is within the endless cylinder around z, empty if first > last.
fn tube(origin: Vector, direction: Vector, radius: f64) -> [f64; 2] {
    let ([x, y, _], [u, v, _]) = (origin, direction);
    let square = u * u + v * v;
    if square < 1e-18 {
        let inside = x * x + y * y <= radius * radius;
        return if inside { [f64::NEG_INFINITY, f64::INFINITY] } else { [f64::INFINITY, f64::NEG_INFINITY] };
    }
    let middle = -(x * u + y * v) / square;
    let (x, y) = (x + middle * u, y + middle * v);
    let left = radius * radius - x * x - y * y;
    if left < 0.0 {
        return [f64::INFINITY, f64::NEG_INFINITY];
    }
    let half = (left / square).sqrt();
    [middle - half, middle + half]
}

/// Returns `count` points of the circle around `centre` perpendicular to the unit vector `normal`.
fn circle(centre: Vector, normal: Vector, radius: f64, count: usize) -> impl Iterator<Item = Vector> {
    let [u, v] = across(normal);
    (0..count).map(move |i| {
        let (sine, cosine) = sin_cos(i as f64 * (2.0 * core::f64::consts::PI / count as f64));
        add(centre, add(scale(u, radius * cosine), scale(v, radius * sine)))
    })
}

impl Geometry {
    /// Finds the first hit of a ray from `origin` along the unit vector `direction`, if it starts outside.
    pub(crate) fn meet(&self, origin: Vector, direction: Vector) -> Option<Meeting> {
        match *self {
            Self::Sphere { radius } => ball(origin, direction, [0.0; 3], radius),
            Self::Capsule { radius, half_length } => {
                let [first, last] = tube(origin, direction, radius);
                if first > last {
                    return None;
                }
                let height = if first.is_finite() { origin[2] + first * direction[2] } else { -direction[2].signum() };
                if first.is_finite() && height.abs() <= half_length {
                    let [x, y, _] = along(origin, direction, first);
                    return (first >= 0.0).then(|| Meeting { distance: first, normal: [x / radius, y / radius, 0.0] });
                }
                // A ray within the endless cylinder beyond an end passes the ball of that end.
                ball(origin, direction, [0.0, 0.0, half_length.copysign(height)], radius)
            }
            Self::Cylinder { radius, half_length } => {
                let [first, last] = tube(origin, direction, radius);
                let [below, above] = slab(origin[2], direction[2], half_length);
                let distance = first.max(below);
                if !(distance >= 0.0 && distance <= last.min(above)) {
                    return None;
                }
                let [x, y, _] = along(origin, direction, distance);
                let side = first > below;
                let normal = if side { [x / radius, y / radius, 0.0] } else { [0.0, 0.0, -direction[2].signum()] };
                Some(Meeting { distance, normal })
            }
            Self::Box { half } => {
                let (mut distance, mut last, mut face) = (f64::NEG_INFINITY, f64::INFINITY, 0);
                for axis in 0..3 {
                    let [into, out] = slab(origin[axis], direction[axis], half[axis]);
                    if into > distance {
                        (distance, face) = (into, axis);
                    }
                    last = last.min(out);
                }
                let mut normal = [0.0; 3];
                normal[face] = -direction[face].signum();
                (distance >= 0.0 && distance <= last).then_some(Meeting { distance, normal })
            }
            Self::Plane => {
                let distance = -origin[2] / direction[2];
                let enters = origin[2] >= 0.0 && direction[2] < 0.0;
                enters.then_some(Meeting { distance, normal: [0.0, 0.0, 1.0] })
            }
            Self::Disc { .. } | Self::Rectangle { .. } => {
                let distance = -origin[2] / direction[2];
                let [x, y, _] = along(origin, direction, distance);
                let inside = match *self {
                    Self::Disc { radius } => x * x + y * y <= radius * radius,
                    Self::Rectangle { half } => x.abs() <= half[0] && y.abs() <= half[1],
                    _ => false,
                };
                let normal = [0.0, 0.0, -direction[2].signum()];
                (inside && distance >= 0.0 && distance.is_finite()).then_some(Meeting { distance, normal })
            }
        }
    }

    /// Computes the radius of the ball around the origin that contains the geometry [m], infinite for a plane.
    pub(crate) fn reach(&self) -> f64 {
        match *self {
            Self::Sphere { radius } | Self::Disc { radius } => radius,
            Self::Capsule { radius, half_length } => radius + half_length,
            Self::Cylinder { radius, half_length } => length([radius, half_length, 0.0]),
            Self::Box { half } => length(half),
            Self::Rectangle { half: [x, y] } => length([x, y, 0.0]),
            Self::Plane => f64::INFINITY,
        }
    }

    /// Returns balls whose convex hull tightly contains the geometry, as centers and radii [m], none for a plane.
    pub(crate) fn hull(&self) -> Vec<(Vector, f64)> {
        match *self {
            Self::Sphere { radius } => vec![([0.0; 3], radius)],
            Self::Capsule { radius, half_length: z } => vec![([0.0, 0.0, -z], radius), ([0.0, 0.0, z], radius)],
            // The corners of octagons around the circles, at 1 / cos(22.5 deg) of the radius.
            Self::Cylinder { radius, half_length } => [-half_length, half_length]
                .into_iter()
                .flat_map(|z| circle([0.0, 0.0, z], [0.0, 0.0, 1.0], 1.0824 * radius, 8))
                .map(|point| (point, 0.0))
                .collect(),
            Self::Disc { radius } => {
                circle([0.0; 3], [0.0, 0.0, 1.0], 1.0824 * radius, 8).map(|point| (point, 0.0)).collect()
            }
            Self::Box { .. } | Self::Rectangle { .. } | Self::Plane => {
                self.rim(Sight::Along([0.0, 0.0, 1.0]), 0).into_iter().map(|point| (point, 0.0)).collect()
            }
        }
    }

    /// Returns points of the surface whose convex hull in the picture is the outline, `count` per circle.
    ///
    /// Returns none for a plane and for a ball with the eye inside.
    pub(crate) fn rim(&self, sight: Sight, count: usize) -> Vec<Vector> {
        // The outline of a ball from a point is a circle nearer to the eye than the center and smaller than the ball.
        let contour = |centre: Vector, radius: f64| {
            let (centre, normal, radius) = match sight {
                Sight::Along(direction) => (centre, direction, radius),
                Sight::Eye(eye) => {
                    let towards = sub(eye, centre);
                    let share = radius * radius / dot(towards, towards);
                    (along(centre, towards, share), unit(towards), radius * (1.0 - share).max(0.0).sqrt())
                }
            };
            let count = if radius > 0.0 { count } else { 0 };
            circle(centre, normal, radius, count)
        };
        match *self {
            Self::Sphere { radius } => contour([0.0; 3], radius).collect(),
            Self::Capsule { radius, half_length } => {
                contour([0.0, 0.0, -half_length], radius).chain(contour([0.0, 0.0, half_length], radius)).collect()
            }
            Self::Cylinder { radius, half_length } => [-half_length, half_length]
                .into_iter()
                .flat_map(|z| circle([0.0, 0.0, z], [0.0, 0.0, 1.0], radius, count))
                .collect(),
            Self::Disc { radius } => circle([0.0; 3], [0.0, 0.0, 1.0], radius, count).collect(),
            Self::Box { half: [x, y, z] } => {
                let sign = |i: usize, bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
                (0..8).map(|i| [x * sign(i, 1), y * sign(i, 2), z * sign(i, 4)]).collect()
            }
            Self::Rectangle { half: [x, y] } => vec![[-x, -y, 0.0], [x, -y, 0.0], [x, y, 0.0], [-x, y, 0.0]],
            Self::Plane => Vec::new(),
        }
    }

    /// Returns the flat faces with their outward normals and corners in order, `count` per circle.
    pub(crate) fn faces(&self, count: usize) -> Vec<(Vector, Vec<Vector>)> {
        let z = [0.0, 0.0, 1.0];
        match *self {
            Self::Box { half } => (0..6)
                .map(|i| {
                    let (axis, sign) = (i / 2, if i % 2 == 0 { -1.0 } else { 1.0 });
                    let corner = |a: f64, b: f64| {
                        let mut point = [0.0; 3];
                        point[axis] = sign * half[axis];
                        point[(axis + 1) % 3] = a * half[(axis + 1) % 3];
                        point[(axis + 2) % 3] = b * half[(axis + 2) % 3];
                        point
                    };
                    let mut normal = [0.0; 3];
                    normal[axis] = sign;
                    (normal, vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)])
                })
                .collect(),
            Self::Cylinder { radius, half_length } => [-1.0, 1.0]
                .map(|sign| (scale(z, sign), circle([0.0, 0.0, sign * half_length], z, radius, count).collect()))
                .into(),
            // Flat shapes have a face on each side.
            Self::Disc { .. } | Self::Rectangle { .. } => {
                let corners = self.rim(Sight::Along(z), count);
                vec![(z, corners.clone()), (scale(z, -1.0), corners)]
            }
            Self::Sphere { .. } | Self::Capsule { .. } | Self::Plane => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Computes the distance to the surface, negative inside.
    fn signed_distance(geometry: &Geometry, p: Vector) -> f64 {
        let outside = |d: [f64; 3]| length(d.map(|x| x.max(0.0))) + d[0].max(d[1]).max(d[2]).min(0.0);
        match *geometry {
            Geometry::Sphere { radius } => length(p) - radius,
            Geometry::Capsule { radius, half_length } => {
                length([p[0], p[1], p[2] - p[2].clamp(-half_length, half_length)]) - radius
            }
            Geometry::Cylinder { radius, half_length } => {
                let side = length([p[0], p[1], 0.0]) - radius;
                outside([side, p[2].abs() - half_length, f64::NEG_INFINITY])
            }
            Geometry::Box { half } => outside([0, 1, 2].map(|i| p[i].abs() - half[i])),
            Geometry::Plane => p[2],
            Geometry::Disc { radius } => {
                let side = length([p[0], p[1], 0.0]) - radius;
                length([side.max(0.0), p[2], 0.0])
            }
            Geometry::Rectangle { half } => {
                length([(p[0].abs() - half[0]).max(0.0), (p[1].abs() - half[1]).max(0.0), p[2]])
            }
        }
    }

    /// Computes the distance at which small steps of the signed distance reach the surface.
    fn marched(geometry: &Geometry, origin: Vector, direction: Vector) -> Option<f64> {
        let mut distance = 0.0;
        for _ in 0..20_000 {
            let free = signed_distance(geometry, along(origin, direction, distance));
            if free < 1e-7 {
                return Some(distance);
            }
            distance += free;
            if distance > 20.0 {
                return None;
            }
        }
        Some(distance)
    }

    fn geometry() -> impl Strategy<Value = Geometry> {
        let size = || 0.05..1.0;
        prop_oneof![
            size().prop_map(|radius| Geometry::Sphere { radius }),
            (size(), size()).prop_map(|(radius, half_length)| Geometry::Capsule { radius, half_length }),
            (size(), size()).prop_map(|(radius, half_length)| Geometry::Cylinder { radius, half_length }),
            prop::array::uniform3(size()).prop_map(|half| Geometry::Box { half }),
            Just(Geometry::Plane),
            size().prop_map(|radius| Geometry::Disc { radius }),
            prop::array::uniform2(size()).prop_map(|half| Geometry::Rectangle { half }),
        ]
    }

    fn direction() -> impl Strategy<Value = Vector> {
        let any = prop::array::uniform3(-1.0..1.0).prop_filter("a direction", |v: &Vector| length(*v) > 0.1);
        prop_oneof![9 => any.prop_map(unit), 1 => Just([0.0, 0.0, -1.0]), 1 => Just([0.0, 1.0, 0.0])]
    }

    proptest! {
        #[test]
        fn rays_meet_what_marching_meets(
            geometry in geometry(), at in prop::array::uniform3(-1.0..1.0), back in 0.5..4.0f64, direction in direction(),
        ) {
            let origin = along(at, direction, -back);
            prop_assume!(signed_distance(&geometry, origin) > 1e-3);
            match (geometry.meet(origin, direction), marched(&geometry, origin, direction)) {
                (Some(meeting), Some(distance)) => {
                    let point = along(origin, direction, meeting.distance);
                    prop_assert!(signed_distance(&geometry, point).abs() < 1e-9);
                    // Marching stops early along a grazing ray.
                    prop_assert!((meeting.distance - distance).abs() < 2e-3, "{meeting:?} instead of {distance}");
                    prop_assert!(dot(meeting.normal, direction) <= 1e-9);
                    prop_assert!((length(meeting.normal) - 1.0).abs() < 1e-9);
                    prop_assert!(signed_distance(&geometry, along(point, meeting.normal, 1e-4)) > 0.5e-4);
                }
                (None, None) => {}
                (None, Some(distance)) => {
                    // A tangent ray.
                    let inner = along(origin, direction, distance + 1e-4);
                    prop_assert!(signed_distance(&geometry, inner) > -1e-4, "missed at {distance}");
                }
                // Marching does not reach distant planes.
                (Some(meeting), None) => prop_assert!(meeting.distance > 19.0, "met {meeting:?}, where nothing is"),
            }
        }

        #[test]
        fn rims_lie_on_the_form_and_balls_are_touched(geometry in geometry(), towards in direction(), far in 4.0..9.0f64) {
            let eye = scale(towards, far);
            for point in geometry.rim(Sight::Eye(eye), 16) {
                prop_assert!(signed_distance(&geometry, point) < 1e-9);
                prop_assert!(length(point) <= geometry.reach() + 1e-9);
                if let Geometry::Sphere { .. } = geometry {
                    prop_assert!(dot(point, sub(eye, point)).abs() < 1e-9);
                }
            }
        }

        #[test]
        fn hulls_hold_the_form(geometry in geometry(), looking in direction()) {
            for point in geometry.rim(Sight::Along(looking), 16) {
                let farthest = geometry.hull().into_iter().map(|(c, r)| dot(c, looking) + r).fold(f64::MIN, f64::max);
                prop_assert!(dot(point, looking) <= farthest + 1e-9);
            }
        }
    }

    #[test]
    fn faces_look_outwards() {
        for geometry in [Geometry::Box { half: [1.0, 2.0, 3.0] }, Geometry::Cylinder { radius: 1.0, half_length: 2.0 }]
        {
            for (normal, corners) in geometry.faces(12) {
                let outer = dot(normal, corners[0]);
                assert!(outer > 0.0);
                assert!(corners.iter().all(|corner| (dot(normal, *corner) - outer).abs() < 1e-12));
            }
        }
    }
}
