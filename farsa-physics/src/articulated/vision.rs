//! Rays of a camera in an articulated world.

use farsa_body::ports::{BodyId, Seen};
use farsa_num::Real;

use crate::articulated::model::Geometry;
use crate::articulated::ray::{collider_frame, enter};
use crate::articulated::spatial::{Vector, dot, rotate_back, sub};
use crate::articulated::view::View;

/// The first collider on each of many rays from one place, except those of `but`.
///
/// A collider's frame is computed once for all rays. Most rays pass far from most colliders, which a test with a ball
/// around it shows at little cost. The margin of that test is larger than its rounding, so it does not change results.
pub(crate) fn look<R: Real>(
    world: &impl View<R>,
    from: [f32; 3],
    directions: &[[f32; 3]],
    range: f32,
    but: Option<BodyId>,
    seen: &mut [Option<Seen<BodyId>>],
) {
    let model = world.model();
    let count = seen.len().min(directions.len());
    let seen = &mut seen[..count];
    seen.fill(None);
    let origin = from.map(|x| R::from_f64(f64::from(x)));
    for (index, collider) in model.colliders.iter().enumerate() {
        let body = model.collider_bodies[index];
        if but.is_some() && body == but {
            continue;
        }
        let (rotation, position) = collider_frame(world, index);
        let away = sub(position, origin);
        let around = Around::new(&collider.geometry, away);
        if around.as_ref().is_some_and(|around| around.is_beyond(range)) {
            continue;
        }
        let o = rotate_back(&rotation, sub(origin, position));
        let color = model.shown.binary_search_by_key(&index, |(shown, _)| usize::from(*shown));
        let color = color.ok().map(|place| model.shown[place].1);
        for (seen, direction) in seen.iter_mut().zip(directions) {
            let direction = direction.map(|x| R::from_f64(f64::from(x)));
            if around.as_ref().is_some_and(|around| around.is_passed_by(direction)) {
                continue;
            }
            let Some((t, _)) = enter(&collider.geometry, o, rotate_back(&rotation, direction)) else { continue };
            let distance = t.to_f64() as f32;
            if distance <= range && seen.is_none_or(|other| distance < other.distance) {
                *seen = Some(Seen { distance, body, color });
            }
        }
    }
}

/// A ball around a collider, as an eye sees it.
struct Around<R> {
    /// From the eye to its center, and the square of that way.
    away: Vector<R>,
    square: R,
    /// Its radius, and the square of what a ray's distance from the center must exceed.
    radius: R,
    room: R,
}

impl<R: Real> Around<R> {
    /// None for what has no end.
    fn new(geometry: &Geometry<R>, away: Vector<R>) -> Option<Self> {
        let radius = match *geometry {
            Geometry::Ball { radius } => radius,
            Geometry::Capsule { radius, half_length } => radius + half_length,
            Geometry::Cylinder { radius, half_length } => (radius * radius + half_length * half_length).sqrt(),
            Geometry::Block { half } => dot(half, half).sqrt(),
            Geometry::Plane => return None,
        };
        let square = dot(away, away);
        let radius = radius * R::from_f64(1.01);
        // The difference of two squares below is wrong by a few units in the last place of the greater one.
        let room = radius * radius + square * R::from_f64(1e-5);
        Some(Self { away, square, radius, room })
    }

    fn is_beyond(&self, range: f32) -> bool {
        let reach = R::from_f64(1.001 * f64::from(range)) + self.radius;
        self.square > reach * reach
    }

    fn is_passed_by(&self, direction: Vector<R>) -> bool {
        let along = dot(self.away, direction);
        let behind = along < R::from_f64(0.0) && self.square > self.room;
        behind || self.square - along * along > self.room
    }
}
