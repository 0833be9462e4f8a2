//! Sight in a horizontal plane of an articulated world: the sections of shapes that have a color.

use farsa_body::ports::{BodyId, NearbySurface, PlanarHit};
use farsa_num::Real;

use crate::articulated::model::Geometry;
use crate::articulated::ray::{ball, collider_frame, enter};
use crate::articulated::spatial::{Matrix, Vector, add, rotate, rotate_back, scale, sub};
use crate::articulated::view::{self, View};

/// Where a collider of a ball is. Its turn does not matter.
#[inline]
fn centre<R: Real>(world: &impl View<R>, index: usize) -> Vector<R> {
    view::place(world, &world.model().colliders[index].mount)
}

/// The first shape with a color on a ray in the plane, except those of `but`.
pub(crate) fn cast_planar<R: Real>(
    world: &impl View<R>,
    from: [f32; 2],
    direction: [f32; 2],
    range: f32,
    but: Option<BodyId>,
) -> Option<PlanarHit<BodyId>> {
    let model = world.model();
    let [x, y] = from.map(|x| R::from_f64(f64::from(x)));
    let [u, v] = direction.map(|x| R::from_f64(f64::from(x)));
    let zero = R::from_f64(0.0);
    let (origin, direction) = ([x, y, model.sight_height], [u, v, zero]);
    let mut best: Option<PlanarHit<BodyId>> = None;
    for &(index, color) in &model.shown {
        let index = usize::from(index);
        let body = model.collider_bodies[index];
        if but.is_some() && body == but {
            continue;
        }
        let geometry = model.colliders[index].geometry;
        let entry = if let Geometry::Ball { radius } = geometry {
            ball(origin, direction, centre(world, index), radius)
        } else {
            let (rotation, position) = collider_frame(world, index);
            let o = rotate_back(&rotation, sub(origin, position));
            let d = rotate_back(&rotation, direction);
            enter(&geometry, o, d)
        };
        let Some((t, _)) = entry else { continue };
        let distance = t.to_f64() as f32;
        if distance <= range && best.is_none_or(|hit| distance < hit.distance) {
            best = Some(PlanarHit { distance, body, color });
        }
    }
    best
}

/// Reports every shape with a color that the plane cuts within `range` of a place.
pub(crate) fn query_near<R: Real>(
    world: &impl View<R>,
    from: [f32; 2],
    range: f32,
    tell: &mut dyn FnMut(NearbySurface<BodyId>),
) {
    let model = world.model();
    let height = model.sight_height;
    let at = [R::from_f64(f64::from(from[0])), R::from_f64(f64::from(from[1])), height];
    for &(index, color) in &model.shown {
        let index = usize::from(index);
        let body = model.collider_bodies[index];
        let near = match model.colliders[index].geometry {
            Geometry::Ball { radius } => near_ball(at, centre(world, index), radius),
            Geometry::Capsule { radius, half_length } => {
                let (rotation, position) = collider_frame(world, index);
                near_capsule(at, &rotation, position, radius, half_length)
            }
            Geometry::Block { half } => {
                let (rotation, position) = collider_frame(world, index);
                near_block(at, &rotation, position, half)
            }
            Geometry::Cylinder { radius, half_length } => {
                let (rotation, position) = collider_frame(world, index);
                near_cylinder(at, &rotation, position, radius, half_length)
            }
            Geometry::Plane => {
                let (rotation, position) = collider_frame(world, index);
                near_plane(at, &rotation, position)
            }
        };
        let Some((point, distance, radius)) = near else { continue };
        let [point, [distance, radius]] = [point, [distance, radius]].map(|x| x.map(|x| x.to_f64() as f32));
        // A shape that is fixed to the world is a wall, whatever its form.
        let radius = if body.is_some() { radius } else { 0.0 };
        let (distance, point) = if body.is_none() && distance < 0.0 { (0.0, from) } else { (distance, point) };
        if distance <= range {
            tell(NearbySurface { body, point, distance, radius, color, signal: None });
        }
    }
}

/// The nearest point of a cut, its distance, and the radius of a round one.
type Near<R> = Option<([R; 2], R, R)>;

fn length<R: Real>([x, y]: [R; 2]) -> R {
    (x * x + y * y).sqrt()
}

fn near_ball<R: Real>(at: Vector<R>, centre: Vector<R>, radius: R) -> Near<R> {
    let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
    let above = at[2] - centre[2];
    let cut = radius * radius - above * above;
    if cut <= zero {
        return None;
    }
    let cut = cut.sqrt();
    let to = [centre[0] - at[0], centre[1] - at[1]];
    let apart = length(to);
    let distance = apart - cut;
    let towards = if apart > zero { to.map(|x| x / apart) } else { [one, zero] };
    Some(([at[0] + distance * towards[0], at[1] + distance * towards[1]], distance, cut))
}

/// Halvings in the search along a capsule: its nearest place is found to a billionth of its length.
const HALVINGS: usize = 30;

fn near_capsule<R: Real>(
    at: Vector<R>,
    rotation: &Matrix<R>,
    position: Vector<R>,
    radius: R,
    half_length: R,
) -> Near<R> {
    // The section consists of discs, one of the ball at each place t of the axis. The distance to the disc at t is a
    // convex function of t, a norm less a square root of a concave one, so its slope finds its least value.
    let (zero, half, one) = (R::from_f64(0.0), R::from_f64(0.5), R::from_f64(1.0));
    let axis = [rotation[0][2], rotation[1][2], rotation[2][2]];
    let rise = axis[2];
    let (mut low, mut high) = (-half_length, half_length);
    if rise.abs() > R::from_f64(1e-6) {
        let [a, b] = [radius, -radius].map(|r| (at[2] - position[2] - r) / rise);
        (low, high) = (low.max(a.min(b)), high.min(a.max(b)));
    } else if (at[2] - position[2]).abs() > radius {
        return None;
    }
    if low > high {
        return None;
    }
    let disc = |t: R| {
        let c = add(position, scale(axis, t));
        let above = at[2] - c[2];
        (c, (radius * radius - above * above).max(zero).sqrt())
    };
    let gap = |t: R| {
        let (c, cut) = disc(t);
        length([c[0] - at[0], c[1] - at[1]]) - cut
    };
    let step = R::from_f64(1e-3);
    for _ in 0..HALVINGS {
        let span = high - low;
        let (a, b) = (low + span * (half - step), low + span * (half + step));
        if gap(a) > gap(b) {
            low = a;
        } else {
            high = b;
        }
    }
    let (c, cut) = disc((low + high) * half);
    let to = [c[0] - at[0], c[1] - at[1]];
    let apart = length(to);
    let distance = (apart - cut).max(zero);
    let towards = if apart > zero { to.map(|x| x / apart) } else { [one, zero] };
    Some(([at[0] + distance * towards[0], at[1] + distance * towards[1]], distance, zero))
}

fn near_cylinder<R: Real>(
    at: Vector<R>,
    rotation: &Matrix<R>,
    position: Vector<R>,
    radius: R,
    half_length: R,
) -> Near<R> {
    // The section consists of chords, one of the disc at each place t of the axis. The distance to the chord at t is a
    // convex function of t.
    let (zero, half) = (R::from_f64(0.0), R::from_f64(0.5));
    let axis = [rotation[0][2], rotation[1][2], rotation[2][2]];
    let above = at[2] - position[2];
    let lean = length([axis[0], axis[1]]);
    if lean < R::from_f64(1e-6) {
        // An upright one is cut in a circle.
        return if above.abs() > half_length { None } else { near_ball(at, [position[0], position[1], at[2]], radius) };
    }
    let (mut low, mut high) = (-half_length, half_length);
    if axis[2].abs() > R::from_f64(1e-6) {
        let [a, b] = [radius, -radius].map(|r| (above - r * lean) / axis[2]);
        (low, high) = (low.max(a.min(b)), high.min(a.max(b)));
    } else if above.abs() > radius * lean {
        return None;
    }
    if low > high {
        return None;
    }
    let across = [-axis[1] / lean, axis[0] / lean];
    let nearest = |t: R| {
        // The chord is this high in the disc, whose direction of steepest rise has the height `lean`.
        let rise = (above - t * axis[2]) / lean;
        let chord = (radius * radius - rise * rise).max(zero).sqrt();
        let middle = [0, 1].map(|k| position[k] + t * axis[k] - rise * axis[2] * axis[k] / lean);
        let along = (at[0] - middle[0]) * across[0] + (at[1] - middle[1]) * across[1];
        let along = along.clamp(-chord, chord);
        [middle[0] + along * across[0], middle[1] + along * across[1]]
    };
    let gap = |t: R| {
        let point = nearest(t);
        length([point[0] - at[0], point[1] - at[1]])
    };
    let step = R::from_f64(1e-3);
    for _ in 0..HALVINGS {
        let span = high - low;
        let (a, b) = (low + span * (half - step), low + span * (half + step));
        if gap(a) > gap(b) {
            low = a;
        } else {
            high = b;
        }
    }
    let t = (low + high) * half;
    Some((nearest(t), gap(t), zero))
}

fn near_block<R: Real>(at: Vector<R>, rotation: &Matrix<R>, position: Vector<R>, half: Vector<R>) -> Near<R> {
    let zero = R::from_f64(0.0);
    let local = rotate_back(rotation, sub(at, position));
    if (0..3).all(|k| local[k].abs() <= half[k]) {
        return Some(([at[0], at[1]], zero, zero));
    }
    // Where the plane cuts the twelve edges. The cut is the convex hull of these places.
    let corner = |i: usize| {
        let mut place = half;
        for (k, x) in place.iter_mut().enumerate() {
            if i >> k & 1 == 0 {
                *x = -*x;
            }
        }
        add(position, rotate(rotation, place))
    };
    let (mut cuts, mut count) = ([[zero; 2]; 24], 0);
    for edge in 0..12 {
        let along = edge / 4;
        let (u, v) = ((along + 1) % 3, (along + 2) % 3);
        let first = (edge & 1) << u | (edge >> 1 & 1) << v;
        let [a, b] = [corner(first), corner(first | 1 << along)];
        let [above, below] = [a[2] - at[2], b[2] - at[2]];
        if above == zero && below == zero {
            (cuts[count], cuts[count + 1]) = ([a[0], a[1]], [b[0], b[1]]);
            count += 2;
        } else if (above <= zero && below >= zero) || (above >= zero && below <= zero) {
            let share = above / (above - below);
            cuts[count] = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
            count += 1;
        }
    }
    // From outside the nearest point of a hull lies on a line between two of its corners.
    let mut best: Near<R> = None;
    for i in 0..count {
        for j in i..count {
            let (a, b) = (cuts[i], cuts[j]);
            let way = [b[0] - a[0], b[1] - a[1]];
            let size = way[0] * way[0] + way[1] * way[1];
            let along = (at[0] - a[0]) * way[0] + (at[1] - a[1]) * way[1];
            let share = if size > zero { (along / size).clamp(zero, R::from_f64(1.0)) } else { zero };
            let point = [a[0] + share * way[0], a[1] + share * way[1]];
            let distance = length([point[0] - at[0], point[1] - at[1]]);
            if best.is_none_or(|(_, other, _)| distance < other) {
                best = Some((point, distance, zero));
            }
        }
    }
    best
}

fn near_plane<R: Real>(at: Vector<R>, rotation: &Matrix<R>, position: Vector<R>) -> Near<R> {
    let zero = R::from_f64(0.0);
    let normal = [rotation[0][2], rotation[1][2], rotation[2][2]];
    let steep = length([normal[0], normal[1]]);
    // No horizontal ray hits a horizontal plane.
    if steep < R::from_f64(1e-6) {
        return None;
    }
    let d = sub(at, position);
    let distance = (d[0] * normal[0] + d[1] * normal[1] + d[2] * normal[2]) / steep;
    let distance = distance.max(zero);
    let point = [at[0] - distance * normal[0] / steep, at[1] - distance * normal[1] / steep];
    Some((point, distance, zero))
}
