//! Ray casts against the colliders of an articulated world.

use farsa_body::ports::{BodyId, Hit};
use farsa_num::Real;

use crate::articulated::link::WORLD;
use crate::articulated::model::Geometry;
use crate::articulated::spatial::{Matrix, Vector, add, dot, product, rotate, rotate_back, scale, sub};
use crate::articulated::view::View;

/// The distance and outward normal at which a ray enters a shape, in the shape's frame. Rays that begin inside hit
/// nothing.
pub(crate) type Entry<R> = Option<(R, Vector<R>)>;

pub(crate) fn ball<R: Real>(origin: Vector<R>, direction: Vector<R>, centre: Vector<R>, radius: R) -> Entry<R> {
    let zero = R::from_f64(0.0);
    // |from + t d|^2 = r^2 with |d| = 1 is t^2 + 2 b t + c = 0, whose smaller root is the entry [Ericson2005] section
    // 5.3.2.
    let from = sub(origin, centre);
    let b = dot(from, direction);
    let c = dot(from, from) - radius * radius;
    let disc = b * b - c;
    // From within, away from it, or past it.
    if c < zero || b > zero || disc < zero {
        return None;
    }
    let t = -b - disc.sqrt();
    Some((t, scale(add(from, scale(direction, t)), R::from_f64(1.0) / radius)))
}

pub(crate) fn capsule<R: Real>(origin: Vector<R>, direction: Vector<R>, radius: R, half: R) -> Entry<R> {
    let zero = R::from_f64(0.0);
    // The cylinder's side first, then the two caps. A hit on the side is nearer than any on a cap behind it. Across the
    // axis: a t^2 + 2 b t + c = 0. Along the axis a is 0, and only the caps are in the way.
    let a = direction[0] * direction[0] + direction[1] * direction[1];
    let b = origin[0] * direction[0] + origin[1] * direction[1];
    let c = origin[0] * origin[0] + origin[1] * origin[1] - radius * radius;
    let disc = b * b - a * c;
    let mut best: Entry<R> = None;
    if a > zero && c >= zero && disc >= zero {
        let t = (-b - disc.sqrt()) / a;
        let z = origin[2] + t * direction[2];
        if t >= zero && z.abs() <= half {
            let p = add(origin, scale(direction, t));
            return Some((t, [p[0] / radius, p[1] / radius, zero]));
        }
    }
    let inside = |centre: R| {
        let d = sub(origin, [zero, zero, centre]);
        dot(d, d) < radius * radius
    };
    if inside(-half) || inside(half) || (c < zero && origin[2].abs() <= half) {
        return None;
    }
    for end in [-half, half] {
        if let Some((t, n)) = ball(origin, direction, [zero, zero, end], radius)
            && best.is_none_or(|(s, _)| t < s)
        {
            best = Some((t, n));
        }
    }
    best
}

pub(crate) fn block<R: Real>(origin: Vector<R>, direction: Vector<R>, half: Vector<R>) -> Entry<R> {
    let zero = R::from_f64(0.0);
    let one = R::from_f64(1.0);
    // The ray is within between the last entry into a pair of faces and the first exit from one [Ericson2005] section
    // 5.3.3.
    let mut enter: Entry<R> = None;
    let mut leave: Option<R> = None;
    for k in 0..3 {
        if direction[k] == zero {
            // Parallel to these two faces: always between them, or never.
            if origin[k].abs() > half[k] {
                return None;
            }
            continue;
        }
        let side = if direction[k] > zero { -one } else { one };
        let near = (side * half[k] - origin[k]) / direction[k];
        let far = (-side * half[k] - origin[k]) / direction[k];
        if enter.is_none_or(|(t, _)| near > t) {
            let mut normal = [zero; 3];
            normal[k] = side;
            enter = Some((near, normal));
        }
        if leave.is_none_or(|t| far < t) {
            leave = Some(far);
        }
    }
    let (t, normal) = enter?;
    // From within, the last entry lies behind the origin.
    (t >= zero && leave.is_none_or(|far| t <= far)).then_some((t, normal))
}

pub(crate) fn cylinder<R: Real>(origin: Vector<R>, direction: Vector<R>, radius: R, half: R) -> Entry<R> {
    let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
    // The side as that of a capsule, then the end that the ray comes from.
    let a = direction[0] * direction[0] + direction[1] * direction[1];
    let b = origin[0] * direction[0] + origin[1] * direction[1];
    let c = origin[0] * origin[0] + origin[1] * origin[1] - radius * radius;
    let disc = b * b - a * c;
    if a > zero && c >= zero && disc >= zero {
        let t = (-b - disc.sqrt()) / a;
        if t >= zero && (origin[2] + t * direction[2]).abs() <= half {
            let p = add(origin, scale(direction, t));
            return Some((t, [p[0] / radius, p[1] / radius, zero]));
        }
    }
    if direction[2] == zero {
        return None;
    }
    let side = if direction[2] > zero { -one } else { one };
    let t = (side * half - origin[2]) / direction[2];
    let p = add(origin, scale(direction, t));
    (t >= zero && p[0] * p[0] + p[1] * p[1] <= radius * radius).then_some((t, [zero, zero, side]))
}

pub(crate) fn plane<R: Real>(origin: Vector<R>, direction: Vector<R>) -> Entry<R> {
    let zero = R::from_f64(0.0);
    if origin[2] < zero || direction[2] >= zero {
        return None;
    }
    Some((-origin[2] / direction[2], [zero, zero, R::from_f64(1.0)]))
}

/// Where a ray enters a geometry, in the frame of its collider.
#[inline]
pub(crate) fn enter<R: Real>(geometry: &Geometry<R>, origin: Vector<R>, direction: Vector<R>) -> Entry<R> {
    match *geometry {
        Geometry::Ball { radius } => ball(origin, direction, [R::from_f64(0.0); 3], radius),
        Geometry::Capsule { radius, half_length } => capsule(origin, direction, radius, half_length),
        Geometry::Block { half } => block(origin, direction, half),
        Geometry::Cylinder { radius, half_length } => cylinder(origin, direction, radius, half_length),
        Geometry::Plane => plane(origin, direction),
    }
}

/// The frame of a collider in the world.
pub(crate) fn collider_frame<R: Real>(world: &impl View<R>, index: usize) -> (Matrix<R>, Vector<R>) {
    let mount = &world.model().colliders[index].mount;
    if mount.link == WORLD {
        return (mount.rotation, mount.position);
    }
    let (rotation, position) = world.link_frame(usize::from(mount.link));
    (product(&rotation, &mount.rotation), add(position, rotate(&rotation, mount.position)))
}

/// The first collider on a ray.
pub(crate) fn cast<R: Real>(
    world: &impl View<R>,
    origin: [f32; 3],
    direction: [f32; 3],
    range: f32,
) -> Option<Hit<BodyId>> {
    let origin = origin.map(|x| R::from_f64(f64::from(x)));
    let direction = direction.map(|x| R::from_f64(f64::from(x)));
    let mut best: Option<Hit<BodyId>> = None;
    for (i, collider) in world.model().colliders.iter().enumerate() {
        let (rotation, position) = collider_frame(world, i);
        // In the frame of the collider. Rotations keep lengths, so t is the distance in the world, too.
        let o = rotate_back(&rotation, sub(origin, position));
        let d = rotate_back(&rotation, direction);
        let Some((t, normal)) = enter(&collider.geometry, o, d) else { continue };
        let distance = t.to_f64() as f32;
        if distance <= range && best.is_none_or(|hit| distance < hit.distance) {
            let normal = rotate(&rotation, normal).map(|x| x.to_f64() as f32);
            best = Some(Hit { distance, normal, body: world.model().collider_bodies[i] });
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Signed distance to each geometry, the oracle that a march along the ray finds the same surface by.
    fn distance(geometry: &Geometry<f64>, p: Vector<f64>) -> f64 {
        let length = |v: Vector<f64>| Real::to_f64(farsa_num::Scalar::sqrt(dot(v, v)));
        match *geometry {
            Geometry::Ball { radius } => length(p) - radius,
            Geometry::Capsule { radius, half_length } => {
                length([p[0], p[1], p[2] - p[2].clamp(-half_length, half_length)]) - radius
            }
            Geometry::Block { half } => {
                let q = [0, 1, 2].map(|k: usize| p[k].abs() - half[k]);
                length(q.map(|x| x.max(0.0))) + q[0].max(q[1]).max(q[2]).min(0.0)
            }
            Geometry::Cylinder { radius, half_length } => {
                let q = [length([p[0], p[1], 0.0]) - radius, p[2].abs() - half_length];
                length([q[0].max(0.0), q[1].max(0.0), 0.0]) + q[0].max(q[1]).min(0.0)
            }
            Geometry::Plane => p[2],
        }
    }

    #[test]
    fn rays_meet_what_marching_along_them_meets() {
        let geometries = [
            Geometry::Ball { radius: 0.3 },
            Geometry::Capsule { radius: 0.2, half_length: 0.4 },
            Geometry::Block { half: [0.3, 0.2, 0.5] },
            Geometry::Cylinder { radius: 0.3, half_length: 0.4 },
            Geometry::Plane,
        ];
        let mut stream = farsa_num::Stream::new(1, farsa_num::Domain::Start, 0, 0, 0);
        let mut met = [0; 5];
        for _ in 0..2000 {
            let mut draw = || stream.range_f64(-1.0, 1.0);
            let origin = [draw(), draw(), draw()];
            let d = [draw(), draw(), draw()];
            let n = farsa_num::Scalar::sqrt(dot(d, d));
            let d = d.map(|x| x / n);
            for (i, geometry) in geometries.iter().enumerate() {
                if distance(geometry, origin) <= 1e-3 {
                    continue;
                }
                let entry = enter(geometry, origin, d);
                // Sphere tracing: steps of the distance itself never jump over the surface.
                let (mut t, mut hit) = (0.0, false);
                for _ in 0..400 {
                    let gap = distance(geometry, add(origin, scale(d, t)));
                    if gap < 1e-9 {
                        hit = true;
                        break;
                    }
                    t += gap;
                    if t > 10.0 {
                        break;
                    }
                }
                if let Some((found, normal)) = entry {
                    if found < 10.0 && hit {
                        met[i] += 1;
                        assert!((found - t).abs() < 1e-4, "geometry {i}: {found} marching {t}");
                        assert!((dot(normal, normal) - 1.0).abs() < 1e-9 && dot(normal, d) <= 0.0);
                    }
                } else {
                    assert!(!hit, "geometry {i} missed: marching met it at {t}");
                }
            }
        }
        assert!(met.iter().all(|n| *n > 50), "{met:?}");
    }
}
