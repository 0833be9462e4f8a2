//! A step of a planar world, for one world or for lanes of them.

use farsa_num::{Mask, Scalar, sin_cos};

use crate::arena::description::CollisionRule;
use crate::arena::model::{CONTACT, Kind, MET, Model, NOTHING, POSE_WORDS, SHOWN, VELOCITY, WHEELS};
use crate::arena::solid::{is_near, meets_solid, overlaps_solid};
use crate::arena::surface::{Meeting, meets_disc, meets_wall, wall_squared};

/// Sweeps of pushing overlapping discs apart.
pub(crate) const SWEEPS: usize = 8;
/// The gap between pushed discs, in parts of the radius, so that rounding leaves no overlap.
pub(crate) const LEFT: f32 = 1e-4;
/// Half the range of a wheel's position [rad]. The position wraps around by a full number of turns.
const WHEEL_RANGE: f64 = 32.0 * core::f64::consts::PI;

/// Words of a robot between its steps' parts: where it was, what it is pushed by, whether it is set back or will be.
pub(crate) const WORK_WORDS: usize = POSE_WORDS + 5;
const PUSH: usize = POSE_WORDS;
const PUSHED: usize = POSE_WORDS + 2;
const BACK: usize = POSE_WORDS + 3;
const SOON: usize = POSE_WORDS + 4;

/// One word of every lane.
#[inline(always)]
pub(crate) fn load<S: Scalar<Real = f32>>(simd: S::Simd, words: &[f32], index: usize) -> S {
    S::load(simd, &words[index * S::LANES..])
}

#[inline(always)]
pub(crate) fn store<S: Scalar<Real = f32>>(words: &mut [f32], index: usize, x: S) {
    x.store(&mut words[index * S::LANES..]);
}

#[inline(always)]
pub(crate) fn position_of<S: Scalar<Real = f32>>(simd: S::Simd, words: &[f32], body: usize) -> [S; 2] {
    let at = POSE_WORDS * body;
    [load(simd, words, at), load(simd, words, at + 1)]
}

/// A command as the wheel takes it: within its speeds, and at rest for a NaN.
#[inline(always)]
pub(crate) fn wheel_speed<S: Scalar<Real = f32>>(command: S, most: S) -> S {
    S::select(command.le(command), command, command.constant(0.0)).clamp(-most, most)
}

/// An angle brought back into [-half, half] from not far outside.
#[inline(always)]
fn wrapped<S: Scalar>(x: S, half: f64) -> S {
    // Two parts, the first short enough to be exact: a turn is lost without its rounding.
    let whole = 2.0 * half;
    let short = f64::from(f32::from_bits((whole as f32).to_bits() & 0xFFFF_F000));
    let turns = S::select(x.abs().gt(x.constant(half)), (x * x.constant(1.0 / whole)).round_small(), x.constant(0.0));
    (x - turns * x.constant(short)) - turns * x.constant(whole - short)
}

/// Where a robot comes in a step: along a circle about the instantaneous center of rotation, exactly.
///
/// Source: own (chord of an arc: its length times sin(h) / h, h half the angle, in the direction half-way).
#[inline(always)]
pub(crate) fn drive<S: Scalar<Real = f32>>(kind: &Kind, pose: [S; POSE_WORDS], speeds: [S; 2]) -> [S; POSE_WORDS] {
    // With the wheels' speeds w_l and w_r: the turn 2 half = (w_r - w_l) r T / b, the arc (w_l + w_r) r T / 2.
    let [x, y, heading, cosine, sine] = pose;
    let half = (speeds[1] - speeds[0]) * x.like(kind.half_turn);
    let arc = (speeds[0] + speeds[1]) * x.like(kind.advance);
    let (s, c) = sin_cos(half);
    let turning = half.abs().gt(x.constant(0.0));
    let one = x.constant(1.0);
    // A quotient of small numbers is as exact as of large ones. Only 0 / 0 is undefined.
    let chord = arc * S::select(turning, s / S::select(turning, half, one), one);
    let [x, y] = [x + chord * (cosine * c - sine * s), y + chord * (sine * c + cosine * s)];
    let heading = wrapped(heading + (half + half), core::f64::consts::PI);
    let (sine, cosine) = sin_cos(heading);
    [x, y, heading, cosine, sine]
}

/// Position of a wheel after a step.
#[inline(always)]
pub(crate) fn turned<S: Scalar<Real = f32>>(position: S, speed: S, time_step: f32) -> S {
    wrapped(position + speed * speed.like(time_step), WHEEL_RANGE)
}

/// Returns the displayed part of a command [0..1], or 0 for NaN.
#[inline(always)]
pub(crate) fn shown<S: Scalar>(command: S) -> S {
    command.clamp(command.constant(0.0), command.constant(1.0))
}

/// Everything of a robot's step but collisions.
#[inline(always)]
pub(crate) fn step_without_collisions<S: Scalar<Real = f32>>(
    simd: S::Simd,
    model: &Model,
    words: &mut [f32],
    work: &mut [f32],
    robot: usize,
) {
    // Wheels take their commands at once: their positions and speeds.
    let kind = model.kind(robot);
    let most = S::splat(simd, kind.max_wheel_speed);
    let first = model.command(robot, 0);
    let speeds =
        [wheel_speed(load::<S>(simd, words, first), most), wheel_speed(load::<S>(simd, words, first + 1), most)];
    let word = model.robot_word(robot, 0);
    for k in 0..2 {
        let position = load::<S>(simd, words, word + WHEELS + k);
        store(words, word + WHEELS + k, turned(position, speeds[k], model.time_step));
        store(words, word + WHEELS + 2 + k, speeds[k]);
    }
    // The pose, and the previous one, to which a collision returns the robot.
    let mut pose = [speeds[0]; POSE_WORDS];
    for k in 0..POSE_WORDS {
        pose[k] = load(simd, words, POSE_WORDS * robot + k);
        store(work, WORK_WORDS * robot + k, pose[k]);
    }
    let pose = drive(kind, pose, speeds);
    for k in 0..POSE_WORDS {
        store(words, POSE_WORDS * robot + k, pose[k]);
    }
    // The velocity at the end of the step, along the new heading.
    let forward = (speeds[0] + speeds[1]) * speeds[0].like(kind.speeds[0]);
    let spin = (speeds[1] - speeds[0]) * speeds[0].like(kind.speeds[1]);
    for (k, x) in [forward * pose[3], forward * pose[4], spin].into_iter().enumerate() {
        store(words, word + VELOCITY + k, x);
    }
    // Nothing met so far, nothing pushed, no robot set back.
    let zero = S::splat(simd, 0.0);
    for k in 0..5 {
        store(words, word + CONTACT + k, zero);
    }
    store(words, word + MET, S::splat(simd, NOTHING));
    for k in PUSHED..=SOON {
        store(work, WORK_WORDS * robot + k, zero);
    }
    show_leds_and_signal::<S>(simd, model, words, robot);
}

/// Shows a robot's LEDs and signal as they were commanded.
#[inline(always)]
pub(crate) fn show_leds_and_signal<S: Scalar<Real = f32>>(
    simd: S::Simd,
    model: &Model,
    words: &mut [f32],
    robot: usize,
) {
    let kind = model.kind(robot);
    let (first, word) = (model.command(robot, 0), model.robot_word(robot, 0));
    let mut next = 2;
    if kind.robot.leds {
        for k in 0..3 {
            store(words, word + SHOWN + k, shown(load::<S>(simd, words, first + next + k)));
        }
        next += 3;
    }
    if kind.robot.signal {
        store(words, word + SHOWN + 3, shown(load::<S>(simd, words, first + next)));
    }
}

/// The deepest overlap of a robot in each lane. Ties go to the first of walls, convex obstacles, robots, cylinders.
#[derive(Clone, Copy)]
pub(crate) struct Met<S> {
    pub(crate) meeting: Meeting<S>,
    pub(crate) body: S,
}

/// Returns whether a robot overlaps anything.
///
/// Squares are compared, here and where a world alone looks for overlaps: with a root on one side only, the two could differ in
/// the last bit.
#[inline(always)]
fn overlaps<S: Scalar<Real = f32>>(simd: S::Simd, model: &Model, words: &[f32], robot: usize) -> S::Mask {
    let at = position_of::<S>(simd, words, robot);
    let own = model.kind(robot).radius;
    let zero = S::splat(simd, 0.0);
    let square = S::splat(simd, own * own);
    let mut any = zero.lt(zero);
    for slab in &model.slabs {
        any = any | wall_squared(slab, at).lt(square);
    }
    for solid in &model.solids {
        let radius = S::splat(simd, own);
        if is_near(solid, at, radius).any() {
            any = any | overlaps_solid(solid, at, radius);
        }
    }
    for body in 0..model.round_bodies() {
        if body != robot {
            let other = position_of::<S>(simd, words, body);
            let [x, y] = [at[0] - other[0], at[1] - other[1]];
            let sum = own + model.radius(body);
            any = any | (x * x + y * y).lt(S::splat(simd, sum * sum));
        }
    }
    any
}

/// Returns the deepest overlap of a robot, and the sum of all pushes. `push` gives half of it to another robot.
#[inline(always)]
fn find_overlap<S: Scalar<Real = f32>>(
    simd: S::Simd,
    model: &Model,
    words: &[f32],
    robot: usize,
    push: &mut [S; 2],
) -> Met<S> {
    // Lanes that overlap nothing come through all of this with their sums as they were: every change is masked.
    let at = position_of::<S>(simd, words, robot);
    let radius = S::splat(simd, model.kind(robot).radius);
    let zero = S::splat(simd, 0.0);
    let nothing = S::splat(simd, NOTHING);
    let mut met = Met { meeting: Meeting { depth: zero, out: [zero; 2], point: [zero; 2] }, body: nothing };
    let left = radius * S::splat(simd, LEFT);
    let square = radius * radius;
    for slab in &model.slabs {
        let meeting = meets_wall(slab, at, radius);
        let mask = wall_squared(slab, at).lt(square);
        keep_deepest(&mut met, mask, meeting, nothing);
        add_push(push, mask, meeting, meeting.depth + left);
    }
    for solid in &model.solids {
        let mask = overlaps_solid(solid, at, radius);
        if mask.any() {
            let meeting = meets_solid(solid, at, radius);
            keep_deepest(&mut met, mask, meeting, nothing);
            add_push(push, mask, meeting, meeting.depth + left);
        }
    }
    for body in 0..model.round_bodies() {
        if body != robot {
            let other = position_of::<S>(simd, words, body);
            let [x, y] = [at[0] - other[0], at[1] - other[1]];
            let other_radius = S::splat(simd, model.radius(body));
            let sum = radius + other_radius;
            let mask = (x * x + y * y).lt(sum * sum);
            let meeting = meets_disc(at, other, radius, other_radius);
            keep_deepest(&mut met, mask, meeting, S::splat(simd, body as f32));
            // Two robots are pushed by half the depth each. A cylinder stays.
            let part = S::splat(simd, if body < model.robots.len() { 0.5 } else { 1.0 });
            add_push(push, mask, meeting, meeting.depth * part + left);
        }
    }
    met
}

/// The smallest depth that is reported of what overlaps: rounding may leave none [m].
const LEAST: f32 = 1e-12;

/// Keeps of two meetings the deeper one. The first of equal ones.
#[inline(always)]
pub(crate) fn keep_deepest<S: Scalar<Real = f32>>(met: &mut Met<S>, mask: S::Mask, meeting: Meeting<S>, body: S) {
    let depth = meeting.depth.max(body.like(LEAST));
    let mask = mask & depth.gt(met.meeting.depth);
    met.meeting.depth = S::select(mask, depth, met.meeting.depth);
    for k in 0..2 {
        met.meeting.out[k] = S::select(mask, meeting.out[k], met.meeting.out[k]);
        met.meeting.point[k] = S::select(mask, meeting.point[k], met.meeting.point[k]);
    }
    met.body = S::select(mask, body, met.body);
}

/// Adds a push out of what was met, in the lanes of the mask.
#[inline(always)]
pub(crate) fn add_push<S: Scalar>(push: &mut [S; 2], mask: S::Mask, meeting: Meeting<S>, by: S) {
    for k in 0..2 {
        push[k] = S::select(mask, push[k] + meeting.out[k] * by, push[k]);
    }
}

/// Stores a word in the lanes of the mask.
#[inline(always)]
fn store_where<S: Scalar<Real = f32>>(simd: S::Simd, words: &mut [f32], index: usize, mask: S::Mask, x: S) {
    let old = load::<S>(simd, words, index);
    store(words, index, S::select(mask, x, old));
}

/// Records the contact of a robot, in the lanes of the mask without a contact so far.
#[inline(always)]
fn record_contact<S: Scalar<Real = f32>>(
    simd: S::Simd,
    model: &Model,
    words: &mut [f32],
    robot: usize,
    mask: S::Mask,
    met: &Met<S>,
) {
    let word = model.robot_word(robot, 0);
    let first = load::<S>(simd, words, word + CONTACT).le(S::splat(simd, 0.0));
    let mask = mask & first;
    let Meeting { depth, out, point } = met.meeting;
    for (k, x) in [depth, out[0], out[1], point[0], point[1]].into_iter().enumerate() {
        store_where(simd, words, word + CONTACT + k, mask, x);
    }
    store_where(simd, words, word + MET, mask, met.body);
}

/// Pushes overlapping robots apart and away from fixed parts.
#[inline(always)]
fn push<S: Scalar<Real = f32>>(simd: S::Simd, model: &Model, words: &mut [f32], work: &mut [f32]) {
    // Jacobi: all pushes of a sweep are found before any robot moves, so that the order of robots does not matter.
    // Overlaps after the last sweep are undone.
    let zero = S::splat(simd, 0.0);
    let one = S::splat(simd, 1.0);
    for _ in 0..SWEEPS {
        let mut moved = false;
        for robot in 0..model.robots.len() {
            let mask = overlaps::<S>(simd, model, words, robot);
            let mut push = [zero; 2];
            if mask.any() {
                moved = true;
                let met = find_overlap(simd, model, words, robot, &mut push);
                record_contact(simd, model, words, robot, mask, &met);
                store_where(simd, work, WORK_WORDS * robot + PUSHED, mask, one);
            }
            store(work, WORK_WORDS * robot + PUSH, push[0]);
            store(work, WORK_WORDS * robot + PUSH + 1, push[1]);
            store(work, WORK_WORDS * robot + SOON, S::select(mask, one, zero));
        }
        if !moved {
            break;
        }
        for robot in 0..model.robots.len() {
            let mask = load::<S>(simd, work, WORK_WORDS * robot + SOON).gt(zero);
            for k in 0..2 {
                let x = load::<S>(simd, words, POSE_WORDS * robot + k);
                let by = load(simd, work, WORK_WORDS * robot + PUSH + k);
                store_where(simd, words, POSE_WORDS * robot + k, mask, x + by);
            }
        }
    }
    // A pushed robot has the velocity of the way that it really went.
    let time_step = S::splat(simd, model.time_step);
    for robot in 0..model.robots.len() {
        let pushed = load::<S>(simd, work, WORK_WORDS * robot + PUSHED).gt(zero);
        if pushed.any() {
            for k in 0..2 {
                let [new, old] =
                    [load::<S>(simd, words, POSE_WORDS * robot + k), load::<S>(simd, work, WORK_WORDS * robot + k)];
                store_where(simd, words, model.robot_word(robot, VELOCITY + k), pushed, (new - old) / time_step);
            }
        }
    }
}

/// Sets back robots that overlap anything, until all others are free.
#[inline(always)]
fn undo<S: Scalar<Real = f32>>(simd: S::Simd, model: &Model, words: &mut [f32], work: &mut [f32]) {
    let zero = S::splat(simd, 0.0);
    let one = S::splat(simd, 1.0);
    let robots = model.robots.len();
    // A robot that is returned may overlap another one that arrived in the meantime, which is returned in the next
    // round. With all robots at their previous places none overlaps. There are at most as many rounds as robots, and
    // one more without an overlap. Each round except the last returns a robot.
    for _ in 0..=robots {
        let mut any = false;
        for robot in 0..robots {
            let back = load::<S>(simd, work, WORK_WORDS * robot + BACK).gt(zero);
            let mask = overlaps::<S>(simd, model, words, robot) & !back;
            if mask.any() {
                any = true;
                let met = find_overlap(simd, model, words, robot, &mut [zero; 2]);
                record_contact(simd, model, words, robot, mask, &met);
            }
            store(work, WORK_WORDS * robot + SOON, S::select(mask, one, zero));
        }
        if !any {
            break;
        }
        for robot in 0..robots {
            let mask = load::<S>(simd, work, WORK_WORDS * robot + SOON).gt(zero);
            if mask.any() {
                for k in 0..POSE_WORDS {
                    let old = load::<S>(simd, work, WORK_WORDS * robot + k);
                    store_where(simd, words, POSE_WORDS * robot + k, mask, old);
                }
                for k in 0..3 {
                    store_where(simd, words, model.robot_word(robot, VELOCITY + k), mask, zero);
                }
                store_where(simd, work, WORK_WORDS * robot + BACK, mask, one);
            }
        }
        // Alone, it is where it was: there is no other to look again for.
        if robots == 1 {
            break;
        }
    }
}

/// Makes one control step of worlds in which no attachment device holds or has a command above 0.5. `words`
/// [`Model::len`] of every lane, `work` [`WORK_WORDS`] of every robot and lane.
#[inline(always)]
pub(crate) fn step<S: Scalar<Real = f32>>(simd: S::Simd, model: &Model, words: &mut [f32], work: &mut [f32]) {
    for robot in 0..model.robots.len() {
        step_without_collisions::<S>(simd, model, words, work, robot);
    }
    if model.collisions == CollisionRule::Circles {
        push::<S>(simd, model, words, work);
    }
    undo::<S>(simd, model, words, work);
}
