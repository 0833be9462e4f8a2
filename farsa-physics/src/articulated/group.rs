//! Groups of pairs that are searched together: only while the spheres around their two sets of colliders are near.
//!
//! It also has the memory of distant points.

use alloc::vec::Vec;

use farsa_body::robot::Robot;
use farsa_num::{Mask as _, Real, Scalar};

use crate::articulated::collision::PlacedShape;
use crate::articulated::contact::reach;
use crate::articulated::model::{Cluster, Geometry, Group, Model, POINT_WORDS, Pair};
use crate::articulated::spatial::{Vector, add, dot, scale, sub};

/// A sphere around a cluster that holds its colliders' bounds, and the largest of their speeds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere<S> {
    centre: Vector<S>,
    radius: S,
    speed: S,
}

impl<S: Scalar> Sphere<S> {
    pub(crate) fn new(simd: S::Simd) -> Self {
        let zero = S::splat(simd, S::Real::from_f64(0.0));
        Self { centre: [zero; 3], radius: zero, speed: zero }
    }
}

/// The runs of pairs with one group, and of pairs without one, in their order, and the clusters of the groups.
pub(crate) fn groups_of<R: Real>(
    robot: &Robot,
    pairs: &[Pair<R>],
    is_plane: impl Fn(usize) -> bool,
) -> (Vec<Group>, Vec<Cluster<R>>) {
    let (mut groups, mut sets) = (Vec::new(), Vec::<Vec<usize>>::new());
    let mut start = 0;
    for run in robot.pairs.chunk_by(|a, b| a.group == b.group) {
        let end = start + run.len();
        // No sphere holds a plane.
        let grouped = run[0].group.is_some() && !run.iter().any(|pair| pair.colliders.into_iter().any(&is_plane));
        let clusters = grouped.then(|| {
            [0, 1].map(|side| {
                let mut set: Vec<usize> = run.iter().map(|pair| pair.colliders[side]).collect();
                set.sort_unstable();
                set.dedup();
                sets.iter().position(|known| *known == set).unwrap_or_else(|| {
                    sets.push(set);
                    sets.len() - 1
                })
            })
        });
        let points = pairs[start].point..pairs[end - 1].point + pairs[end - 1].points;
        groups.push(Group { pairs: start..end, points, clusters });
        start = end;
    }
    let share = |set: &Vec<usize>| R::from_f64(1.0 / set.len() as f64);
    (groups, sets.into_iter().map(|set| Cluster { share: share(&set), colliders: set }).collect())
}

/// The spheres around all clusters, for colliders at these places.
#[inline(always)]
pub(crate) fn place_spheres<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    placed: &[PlacedShape<S>],
    out: &mut [Sphere<S>],
) {
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    for (cluster, o) in model.clusters.iter().zip(out) {
        if let [index] = cluster.colliders[..] {
            let (shape, radius) = (&placed[index], S::splat(simd, model.colliders[index].bound));
            *o = Sphere { centre: shape.position, radius, speed: dot(shape.velocity, shape.velocity).sqrt() };
            continue;
        }
        let members = cluster.colliders.iter().map(|index| &placed[*index]);
        let sum = members.clone().fold([zero; 3], |sum, shape| add(sum, shape.position));
        let centre = scale(sum, S::splat(simd, cluster.share));
        // The farthest and the largest need not be one: then the sphere is larger than it has to be.
        let [mut apart, mut speed, mut bound] = [zero; 3];
        for (index, shape) in cluster.colliders.iter().zip(members) {
            let from = sub(shape.position, centre);
            apart = apart.max(dot(from, from));
            speed = speed.max(dot(shape.velocity, shape.velocity));
            bound = bound.max(S::splat(simd, model.colliders[*index].bound));
        }
        *o = Sphere { centre, radius: apart.sqrt() + bound, speed: speed.sqrt() };
    }
}

/// In which lanes two spheres are so near that a pair of what they hold may have to be looked at.
///
/// Where a pair's own bounds are near ([`crate::articulated::solver`]), so are the spheres, which are larger and close no more
/// slowly.
#[inline(always)]
pub(crate) fn spheres_near<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    h: S,
    a: &Sphere<S>,
    b: &Sphere<S>,
) -> S::Mask {
    let apart = sub(a.centre, b.centre);
    (dot(apart, apart).sqrt() - a.radius - b.radius).le(reach(simd, model, h, a.speed + b.speed))
}

/// Returns the gap of a point of a distant group, for which no smaller gap was computed.
#[inline(always)]
pub(crate) fn unknown_gap<S: Scalar>(simd: S::Simd) -> S {
    S::splat(simd, S::Real::from_f64(f64::INFINITY))
}

/// Returns whether the words of a group's points, [`POINT_WORDS`] of each, are those of a group that is far in every
/// lane.
///
/// Its first point decides: while a group is near, that point's gap is finite.
#[inline(always)]
pub(crate) fn is_clear<S: Scalar>(simd: S::Simd, points: &[S], group: &Group) -> bool {
    group.clusters.is_some() && !points[POINT_WORDS * group.points.start + 7].lt(unknown_gap(simd)).any()
}

/// The rolling impulse of a pair's point among those of all points. Empty for a pair without rolling friction.
#[inline(always)]
pub(crate) fn rolling_words<'a, R, S>(pair: &Pair<R>, index: usize, all: &'a mut [S]) -> &'a mut [S] {
    match pair.rolling {
        Some(first) => &mut all[3 * (first + index)..3 * (first + index + 1)],
        None => &mut [],
    }
}

/// Writes the state of a point that carries nothing: its gap, and no impulse from which the next step could start.
#[inline(always)]
pub(crate) fn forget_point<S: Scalar>(words: &mut [S], rolling: &mut [S], gap: S) {
    let zero = gap.constant(0.0);
    for w in words.iter_mut() {
        *w = zero;
    }
    for w in rolling {
        *w = zero;
    }
    words[7] = gap;
}

/// Writes the state of all points of a group that is far in every lane, where it was not before.
#[inline(always)]
pub(crate) fn forget_group<S: Scalar>(
    simd: S::Simd,
    model: &Model<S::Real>,
    group: &Group,
    points: &mut [S],
    rolling_impulses: &mut [S],
) {
    if is_clear(simd, points, group) {
        return;
    }
    for pair in &model.pairs[group.pairs.clone()] {
        for index in 0..pair.points {
            let words = &mut points[POINT_WORDS * (pair.point + index)..POINT_WORDS * (pair.point + index + 1)];
            forget_point(words, rolling_words(pair, index, rolling_impulses), unknown_gap(simd));
        }
    }
}

/// Returns whether a geometry is endless.
pub(crate) fn is_plane<R>(geometry: &Geometry<R>) -> bool {
    matches!(geometry, Geometry::Plane)
}
