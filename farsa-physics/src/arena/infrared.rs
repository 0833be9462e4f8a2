//! The ring of analytic infrared sensors, for one world or for lanes of them.

use farsa_body::sensors::infrared::InfraredModel;
use farsa_num::{Mask, Scalar};

use crate::arena::model::{Model, POSE_WORDS};
use crate::arena::solid::{is_near, to_solid};
use crate::arena::step::{load, position_of, store};
use crate::arena::surface::to_wall;

/// A robot that senses: where it is, and the cosine and sine of its heading.
#[derive(Clone, Copy)]
struct Pose<S> {
    at: [S; 2],
    axis: [S; 2],
}

/// Adds what one surface does to the sensors' sums `out` [sensors x lanes]. `way` goes from the robot's center to the
/// surface's nearest point or, if it has a radius, to its center.
#[inline(always)]
fn add_surface<S: Scalar<Real = f32>>(
    simd: S::Simd,
    axes: &[[f32; 2]],
    seen: &InfraredModel,
    axis: [S; 2],
    way: [S; 2],
    radii: f32,
    out: &mut [f32],
) {
    // Each surface adds f(distance) g(cosine) by its nearest point alone, with the cosine of the angle between the
    // sensor's axis and the way there. F and g are those of `InfraredModel`.
    let zero = S::splat(simd, 0.0);
    let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
    let distance = length - S::splat(simd, radii);
    if !distance.lt(S::splat(simd, seen.range())).any() {
        // Every term is 0, and adding it changes no bit.
        return;
    }
    let strength = seen.distance_term(distance);
    // The unit vector of the way in the robot's frame, where the sensors' axes are constant.
    let divisor = S::select(length.gt(zero), length, S::splat(simd, 1.0));
    let ahead = (way[0] * axis[0] + way[1] * axis[1]) / divisor;
    let left = (way[1] * axis[0] - way[0] * axis[1]) / divisor;
    for (k, [x, y]) in axes.iter().take(out.len() / S::LANES).enumerate() {
        let cosine = ahead * S::splat(simd, *x) + left * S::splat(simd, *y);
        let sum = load::<S>(simd, out, k);
        store(out, k, sum + strength * seen.angle_term(cosine));
    }
}

#[inline(always)]
fn pose<S: Scalar<Real = f32>>(simd: S::Simd, words: &[f32], robot: usize) -> Pose<S> {
    let at = POSE_WORDS * robot;
    Pose { at: position_of(simd, words, robot), axis: [load(simd, words, at + 3), load(simd, words, at + 4)] }
}

#[inline(always)]
fn add_walls<S: Scalar<Real = f32>>(simd: S::Simd, model: &Model, robot: usize, pose: Pose<S>, out: &mut [f32]) {
    let kind = model.kind(robot);
    for slab in &model.slabs {
        let way = to_wall(slab, pose.at);
        add_surface(simd, &kind.infrared, &model.wall_seen, pose.axis, way, kind.radius, out);
    }
    // Twice what is felt: lanes that the mask leaves out feel nothing anyway.
    let reach = S::splat(simd, 2.0 * (kind.radius + model.wall_seen.range()));
    for solid in &model.solids {
        if is_near(solid, pose.at, reach).any() {
            let way = to_solid(solid, pose.at);
            add_surface(simd, &kind.infrared, &model.wall_seen, pose.axis, way, kind.radius, out);
        }
    }
}

#[inline(always)]
fn add_body<S: Scalar<Real = f32>>(
    simd: S::Simd,
    model: &Model,
    words: &[f32],
    robot: usize,
    pose: Pose<S>,
    body: usize,
    out: &mut [f32],
) {
    if body != robot {
        let kind = model.kind(robot);
        let other = position_of::<S>(simd, words, body);
        let way = [other[0] - pose.at[0], other[1] - pose.at[1]];
        let radii = kind.radius + model.radius(body);
        add_surface(simd, &kind.infrared, model.seen(body), pose.axis, way, radii, out);
    }
}

/// Number of sensors that there is room for.
#[inline(always)]
fn sensors<S: Scalar>(model: &Model, robot: usize, out: &[f32]) -> usize {
    model.kind(robot).infrared.len().min(out.len() / S::LANES)
}

#[inline(always)]
fn clear_sums<S: Scalar<Real = f32>>(simd: S::Simd, sensors: usize, out: &mut [f32]) {
    for k in 0..sensors {
        store(out, k, S::splat(simd, 0.0));
    }
}

#[inline(always)]
fn sums_to_readings<S: Scalar<Real = f32>>(simd: S::Simd, sensors: usize, out: &mut [f32]) {
    for k in 0..sensors {
        store(out, k, InfraredModel::reading(load::<S>(simd, out, k)));
    }
}

#[cfg_attr(not(all(feature = "lanes", not(test))), expect(dead_code, reason = "only lanes look at everything"))]
/// The readings of a robot's ring [sensors x lanes]. The first ones if there is no room for all.
#[inline(always)]
pub(crate) fn ring<S: Scalar<Real = f32>>(simd: S::Simd, model: &Model, words: &[f32], robot: usize, out: &mut [f32]) {
    // Walls, convex obstacles, then bodies by their numbers: `ring_among` adds in the same order, or the sums would differ.
    let sensors = sensors::<S>(model, robot, out);
    let pose = pose::<S>(simd, words, robot);
    clear_sums::<S>(simd, sensors, out);
    add_walls(simd, model, robot, pose, out);
    for other in 0..model.round_bodies() {
        add_body(simd, model, words, robot, pose, other, out);
    }
    sums_to_readings::<S>(simd, sensors, out);
}

/// Returns the where the bodies that may be sensed are given, in their order.
pub(crate) fn ring_among(
    model: &Model,
    words: &[f32],
    robot: usize,
    out: &mut [f32],
    near: impl FnOnce([f32; 2], f32, &mut dyn FnMut(usize)),
) {
    let sensors = sensors::<f32>(model, robot, out);
    let pose = pose::<f32>((), words, robot);
    clear_sums::<f32>((), sensors, out);
    add_walls((), model, robot, pose, out);
    // A little more than can be felt: what is given in vain adds zero.
    let reach = model.kind(robot).radius + model.largest + model.wall_seen.range();
    near(pose.at, 1.01 * reach, &mut |other| add_body((), model, words, robot, pose, other, out));
    sums_to_readings::<f32>((), sensors, out);
}
