//! Contact points: where two colliders may touch.

use farsa_num::{Real, Scalar};

use crate::articulated::collision::{
    PlacedShape, Point, ball_box, ball_plane, balls, corner, distance_to_box, nearest_of_segments, nearest_on_segment,
    segment_box,
};
use crate::articulated::cylinder::{Cylinder, ball_cylinder, rim, segment_cylinder};
use crate::articulated::link::{LinkData, WORLD};
use crate::articulated::model::{Geometry, Model, Pair};
use crate::articulated::spatial::{Vector, add, dot, product, rotate, scale, splat, splat_matrix, sub};

/// The allowance for the approach of two surfaces over that of their centers [m/s]: a shape of 3 cm at 50 rad/s.
const TURNING: f64 = 1.5;

/// The colliders in the world.
#[inline(always)]
pub(crate) fn place_colliders<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    work: &[LinkData<S>],
    out: &mut [PlacedShape<S>],
) {
    for (c, o) in model.colliders.iter().zip(out) {
        let own = splat_matrix(simd, c.mount.rotation);
        let offset = splat::<S>(simd, c.mount.position);
        // `acceleration` holds the predicted velocity here, see `predict`: what it is at the collider's origin.
        *o = if c.mount.link == WORLD {
            PlacedShape { rotation: own, position: offset, velocity: [S::splat(simd, S::Real::from_f64(0.0)); 3] }
        } else {
            let w = &work[usize::from(c.mount.link)];
            let position = add(w.position, rotate(&w.rotation, offset));
            let velocity = w.acceleration.at(sub(position, w.reference));
            PlacedShape { rotation: product(&w.rotation, &own), position, velocity }
        };
    }
}

/// The distance within which what closes at a speed is looked at [m], and a little more for turning.
#[inline(always)]
pub(crate) fn reach<S: Scalar>(simd: S::Simd, model: &Model<S::Real>, h: S, approach: S) -> S {
    S::splat(simd, model.reach) + h * (approach + h.constant(TURNING))
}

/// Distance between a pair's bounds [m]. Nothing can touch while it is positive.
#[inline(always)]
pub(crate) fn clearance<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    pair: &Pair<S::Real>,
    placed: &[PlacedShape<S>],
) -> S {
    // A ball around the first shape is tested against a cheap second shape itself (plane, box), else against its ball.
    // A ball around a table would be near everything.
    let [a, b] = pair.colliders;
    let (pa, pb) = (&placed[a], &placed[b]);
    let bound = S::splat(simd, model.colliders[a].bound);
    match model.colliders[b].geometry {
        Geometry::Plane => dot(sub(pa.position, pb.position), pb.axis()) - bound,
        Geometry::Block { half } => distance_to_box(pa.position, pb, splat::<S>(simd, half)) - bound,
        _ => {
            let d = sub(pa.position, pb.position);
            dot(d, d).sqrt() - bound - S::splat(simd, model.colliders[b].bound)
        }
    }
}

/// The half edges of two boxes, for a pair of two boxes.
#[inline(always)]
pub(crate) fn halves_of_boxes<R: Real>(model: &Model<R>, pair: &Pair<R>) -> Option<[Vector<R>; 2]> {
    match pair.colliders.map(|collider| model.colliders[collider].geometry) {
        [Geometry::Block { half: first }, Geometry::Block { half: second }] => Some([first, second]),
        _ => None,
    }
}

/// One end of a capsule's axis, the upper one unless `index` is 0.
#[inline(always)]
fn end<S: Scalar>(place: &PlacedShape<S>, index: usize, half: S) -> Vector<S> {
    add(place.position, scale(place.axis(), if index == 0 { -half } else { half }))
}

/// Contact point `index` of a pair, except of two boxes, see [`crate::articulated::boxes`].
#[inline(never)]
pub(crate) fn find<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    pair: &Pair<S::Real>,
    placed: &[PlacedShape<S>],
    index: usize,
) -> Point<S> {
    S::vectorize(
        simd,
        #[inline(always)]
        || point(simd, model, pair, placed, index),
    )
}

#[inline(always)]
fn point<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    pair: &Pair<S::Real>,
    placed: &[PlacedShape<S>],
    index: usize,
) -> Point<S> {
    // Spheres and capsules are balls swept over a point or a segment, corners of boxes the same with radius 0. Each pair
    // reduces to a ball with a ball, a box, a cylinder or a plane. Shapes come in the order ball, capsule, block, cylinder,
    // plane.
    let [a, b] = pair.colliders;
    let (pa, pb) = (&placed[a], &placed[b]);
    match (model.colliders[a].geometry, model.colliders[b].geometry) {
        (Geometry::Ball { radius: ra }, Geometry::Ball { radius: rb }) => {
            balls(pa.position, S::splat(simd, ra), pb.position, S::splat(simd, rb))
        }
        (Geometry::Ball { radius: ra }, Geometry::Capsule { radius: rb, half_length }) => {
            let near = nearest_on_segment(pb.position, pb.axis(), S::splat(simd, half_length), pa.position);
            balls(pa.position, S::splat(simd, ra), near, S::splat(simd, rb))
        }
        (Geometry::Ball { radius }, Geometry::Block { half }) => {
            ball_box(pa.position, S::splat(simd, radius), pb, splat::<S>(simd, half))
        }
        (Geometry::Ball { radius }, Geometry::Cylinder { radius: rb, half_length }) => {
            ball_cylinder(pa.position, S::splat(simd, radius), pb, Cylinder::new(simd, rb, half_length))
        }
        (Geometry::Ball { radius }, Geometry::Plane) => ball_plane(pa.position, S::splat(simd, radius), pb),
        (Geometry::Capsule { radius: ra, half_length: la }, Geometry::Capsule { radius: rb, half_length: lb }) => {
            let (na, nb) = nearest_of_segments(
                pa.position,
                pa.axis(),
                S::splat(simd, la),
                pb.position,
                pb.axis(),
                S::splat(simd, lb),
            );
            balls(na, S::splat(simd, ra), nb, S::splat(simd, rb))
        }
        (Geometry::Capsule { radius, half_length }, Geometry::Block { half }) => {
            // Both ends of the axis, and the deepest place between them, where the capsule lies across an edge.
            let half = splat::<S>(simd, half);
            if index < 2 {
                ball_box(end(pa, index, S::splat(simd, half_length)), S::splat(simd, radius), pb, half)
            } else {
                segment_box(pa.position, pa.axis(), S::splat(simd, half_length), S::splat(simd, radius), pb, half)
            }
        }
        (Geometry::Capsule { radius, half_length }, Geometry::Cylinder { radius: rb, half_length: lb }) => {
            // As with a box.
            let (length, radius) = (S::splat(simd, half_length), S::splat(simd, radius));
            let cylinder = Cylinder::new(simd, rb, lb);
            if index < 2 {
                ball_cylinder(end(pa, index, length), radius, pb, cylinder)
            } else {
                segment_cylinder(pa.position, pa.axis(), length, radius, pb, cylinder)
            }
        }
        (Geometry::Capsule { radius, half_length }, _) => {
            ball_plane(end(pa, index, S::splat(simd, half_length)), S::splat(simd, radius), pb)
        }
        (Geometry::Block { half }, _) => {
            ball_plane(corner(pa, splat::<S>(simd, half), index), S::splat(simd, S::Real::from_f64(0.0)), pb)
        }
        (Geometry::Cylinder { radius, half_length }, _) => {
            let rim = rim(pa, Cylinder::new(simd, radius, half_length), pb, index);
            ball_plane(rim, S::splat(simd, S::Real::from_f64(0.0)), pb)
        }
        (Geometry::Plane, _) => ball_plane(pa.position, S::splat(simd, S::Real::from_f64(0.0)), pb),
    }
}

#[cfg(test)]
#[path = "contact_tests.rs"]
mod tests;
