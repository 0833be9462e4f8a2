//! The ports of a planar world, read from its words, for one world and a lane.

use farsa_body::ports::{ActuatorId, BodyId, Hit, JointId, Lamp, NearbySurface, PairContact, PairId, PlanarHit};
use farsa_body::{Pose, Twist};
use farsa_num::{Scalar, sin_cos};

use crate::arena::model::{CONTACT, HELD, MET, Model, NOTHING, POSE_WORDS, SHOWN, VELOCITY, WHEELS, pose_words};
use crate::arena::solid::{cast_to_solid, is_near, ray_to_solid, to_solid};
use crate::arena::surface::{ray_to_disc, ray_to_wall, to_wall};

/// A planar world as its ports see it.
pub(crate) trait View {
    /// The constant part.
    fn model(&self) -> &Model;
    /// A word of the state.
    fn word(&self, index: usize) -> f32;
    /// Changes a word of the state.
    fn set_word(&mut self, index: usize, x: f32);
    /// Visits every robot and cylinder whose center may be in the rectangle [m], and perhaps others, in any order.
    fn visit(&self, low: [f32; 2], high: [f32; 2], tell: impl FnMut(usize));
    /// Returns whether small rectangles are faster.
    fn gridded(&self) -> bool;
}

/// Numbers of bodies in ascending order, as many as usually are near.
struct Sorted {
    bodies: [u16; 64],
    count: usize,
}

impl Sorted {
    /// Sorts the bodies whose centers may be in the rectangle. Returns false if there are too many.
    #[inline]
    fn fill(&mut self, world: &impl View, low: [f32; 2], high: [f32; 2]) -> bool {
        world.visit(low, high, |body| {
            let mut at = self.count;
            self.count += 1;
            if at < self.bodies.len() {
                while at > 0 && usize::from(self.bodies[at - 1]) > body {
                    self.bodies[at] = self.bodies[at - 1];
                    at -= 1;
                }
                self.bodies[at] = body as u16;
            }
        });
        self.count <= self.bodies.len()
    }
}

/// Visits the robots and cylinders whose centers may be in the rectangle [m], in their order.
#[inline]
pub(crate) fn in_order(world: &impl View, low: [f32; 2], high: [f32; 2], mut tell: impl FnMut(usize)) {
    let mut sorted = Sorted { bodies: [0; 64], count: 0 };
    if sorted.fill(world, low, high) {
        sorted.bodies[..sorted.count].iter().for_each(|body| tell(usize::from(*body)));
    } else {
        (0..world.model().round_bodies()).for_each(tell);
    }
}

#[inline]
fn place(world: &impl View, body: usize) -> [f32; 2] {
    [world.word(POSE_WORDS * body), world.word(POSE_WORDS * body + 1)]
}

fn axis(world: &impl View, body: usize) -> [f32; 2] {
    [world.word(POSE_WORDS * body + 3), world.word(POSE_WORDS * body + 4)]
}

fn robot_word(world: &impl View, robot: usize, word: usize) -> f32 {
    world.word(world.model().robot_word(robot, word))
}

/// Pose of a body. The identity for one that does not exist.
pub(crate) fn pose(world: &impl View, body: BodyId) -> Pose {
    let body = body.index();
    if body >= world.model().bodies() {
        return Pose::identity();
    }
    let [x, y] = place(world, body);
    let (sine, cosine) = sin_cos(0.5 * world.word(POSE_WORDS * body + 2));
    Pose { position: [x, y, 0.0], rotation: [0.0, 0.0, sine, cosine] }
}

/// Velocity of a robot, or zero for everything else.
pub(crate) fn velocity(world: &impl View, body: BodyId) -> Twist {
    let robot = body.index();
    if robot >= world.model().robots.len() {
        return Twist::default();
    }
    let [x, y, spin] = [0, 1, 2].map(|k| robot_word(world, robot, VELOCITY + k));
    Twist { linear: [x, y, 0.0], angular: [0.0, 0.0, spin] }
}

/// Where a joint's word is: its position, or its speed.
fn wheel(model: &Model, joint: JointId, speed: bool) -> Option<usize> {
    let (robot, side) = (joint.index() / 2, joint.index() % 2);
    (robot < model.robots.len()).then(|| model.robot_word(robot, WHEELS + 2 * usize::from(speed) + side))
}

pub(crate) fn joint_position(world: &impl View, joint: JointId) -> f32 {
    wheel(world.model(), joint, false).map_or(0.0, |at| world.word(at))
}

pub(crate) fn joint_speed(world: &impl View, joint: JointId) -> f32 {
    wheel(world.model(), joint, true).map_or(0.0, |at| world.word(at))
}

pub(crate) fn command(world: &mut impl View, actuator: ActuatorId, value: f32) {
    if actuator.index() < world.model().actuators {
        world.set_word(world.model().first_command() + actuator.index(), value);
    }
}

pub(crate) fn pair_bodies(world: &impl View, pair: PairId) -> [Option<BodyId>; 2] {
    if pair.index() >= world.model().robots.len() {
        return [None; 2];
    }
    [Some(BodyId(pair.0)), body_of(robot_word(world, pair.index(), MET))]
}

fn body_of(word: f32) -> Option<BodyId> {
    (word >= 0.0).then_some(BodyId(word as u16))
}

pub(crate) fn touches(world: &impl View, pair: PairId) -> bool {
    pair.index() < world.model().robots.len() && robot_word(world, pair.index(), CONTACT) > 0.0
}

pub(crate) fn pair_contact(world: &impl View, pair: PairId) -> PairContact {
    if !touches(world, pair) {
        return PairContact::default();
    }
    let [depth, u, v, x, y] = [0, 1, 2, 3, 4].map(|k| robot_word(world, pair.index(), CONTACT + k));
    PairContact { points: 1, force: [u, v, 0.0], normal_force: 1.0, point: [x, y, 0.0], depth }
}

/// Returns the color of a robot or cylinder.
fn color(world: &impl View, body: usize) -> [f32; 3] {
    let model = world.model();
    if let Some(round) = body.checked_sub(model.robots.len()) {
        return model.rounds[round].color;
    }
    let shown = [0, 1, 2].map(|k| robot_word(world, body, SHOWN + k));
    if shown.iter().any(|x| *x > 0.0) { shown } else { model.kind(body).color }
}

fn signal(world: &impl View, body: usize) -> Option<f32> {
    let model = world.model();
    (body < model.robots.len() && model.kind(body).robot.signal).then(|| robot_word(world, body, SHOWN + 3))
}

/// See [`farsa_body::ports::Sight::query_near`].
pub(crate) fn query_near(world: &impl View, from: [f32; 2], range: f32, mut tell: impl FnMut(NearbySurface<BodyId>)) {
    let model = world.model();
    for slab in &model.slabs {
        if !slab.within_reach(from, range) {
            continue;
        }
        let [x, y] = to_wall(slab, from);
        let distance = Scalar::sqrt(x * x + y * y);
        if distance <= range {
            let point = [from[0] + x, from[1] + y];
            tell(NearbySurface { body: None, point, distance, radius: 0.0, color: slab.color, signal: None });
        }
    }
    // Farther than the range, so that rounding leaves out nothing that is within it.
    for solid in model.solids.iter().filter(|solid| is_near(solid, from, 2.0 * range.max(solid.around[0]))) {
        let [x, y] = to_solid(solid, from);
        let distance = Scalar::sqrt(x * x + y * y);
        if distance <= range {
            let point = [from[0] + x, from[1] + y];
            tell(NearbySurface { body: None, point, distance, radius: 0.0, color: solid.color, signal: None });
        }
    }
    let reach = range + model.largest;
    let (low, high) = ([from[0] - reach, from[1] - reach], [from[0] + reach, from[1] + reach]);
    in_order(world, low, high, |body| {
        let centre = place(world, body);
        let radius = model.radius(body);
        let [x, y] = [from[0] - centre[0], from[1] - centre[1]];
        let (square, most) = (x * x + y * y, range + radius);
        if square > most * most || most < 0.0 {
            return;
        }
        let away = Scalar::sqrt(square);
        let out = if away > 0.0 { [x / away, y / away] } else { [1.0, 0.0] };
        tell(NearbySurface {
            body: Some(BodyId(body as u16)),
            point: [centre[0] + radius * out[0], centre[1] + radius * out[1]],
            distance: away - radius,
            radius,
            color: color(world, body),
            signal: signal(world, body),
        });
    });
}

/// Pieces of a ray, at most.
const PIECES: usize = 64;

/// Goes along a ray in the plane and tries each body that may lie on it. `way` need not be a unit vector.
///
/// `try_body` returns how far the nearest thing found so far is, in lengths of `way`.
fn along(
    world: &impl View,
    from: [f32; 2],
    way: [f32; 2],
    range: f32,
    mut found: f32,
    mut try_body: impl FnMut(usize) -> f32,
) {
    let reach = world.model().largest;
    let length = Scalar::max(way[0].abs(), way[1].abs());
    // Pieces of a few bodies' length, so that those far beyond what is met are not asked. Then the rest at once.
    let piece = if world.gridded() && length > 0.0 { 8.0 * reach / length } else { range };
    let mut start = 0.0;
    for i in 1..=PIECES {
        let end = if i < PIECES { (start + piece).min(range) } else { range };
        let ends = [start, end].map(|t| [0, 1].map(|k| if way[k] == 0.0 { from[k] } else { from[k] + t * way[k] }));
        let rim = |pick: fn(f32, f32) -> f32, by: f32| [0, 1].map(|k: usize| pick(ends[0][k], ends[1][k]) + by);
        let (low, high) = (rim(f32::min, -1.01 * reach), rim(f32::max, 1.01 * reach));
        world.visit(low, high, |body| {
            let [x, y] = place(world, body);
            if x >= low[0] && x <= high[0] && y >= low[1] && y <= high[1] {
                found = found.min(try_body(body));
            }
        });
        if end >= range || found <= end {
            return;
        }
        start = end;
    }
}

/// See [`farsa_body::ports::Sight::cast_planar`].
pub(crate) fn cast_planar(
    world: &impl View,
    from: [f32; 2],
    direction: [f32; 2],
    range: f32,
    but: Option<BodyId>,
) -> Option<PlanarHit<BodyId>> {
    let model = world.model();
    let mut sight: Option<PlanarHit<BodyId>> = None;
    let mut nearest = range;
    for slab in &model.slabs {
        if let Some(distance) = ray_to_wall(slab, from, direction)
            && (distance < nearest || sight.is_none() && distance <= nearest)
        {
            nearest = distance;
            sight = Some(PlanarHit { distance, body: None, color: slab.color });
        }
    }
    for solid in &model.solids {
        if let Some(distance) = ray_to_solid(solid, from, direction)
            && (distance < nearest || sight.is_none() && distance <= nearest)
        {
            nearest = distance;
            sight = Some(PlanarHit { distance, body: None, color: solid.color });
        }
    }
    let mut met: Option<(f32, usize)> = None;
    along(world, from, direction, range, nearest, |body| {
        let [x, y] = place(world, body);
        if but.is_none_or(|but| but.index() != body)
            && let Some(distance) = ray_to_disc([from[0] - x, from[1] - y], direction, model.radius(body))
            && distance <= range
            && met.is_none_or(|met| (distance, body) < met)
        {
            met = Some((distance, body));
        }
        met.map_or(nearest, |(distance, _)| distance)
    });
    match met {
        Some((distance, body)) if distance < nearest || sight.is_none() => {
            Some(PlanarHit { distance, body: Some(BodyId(body as u16)), color: color(world, body) })
        }
        _ => sight,
    }
}

/// Returns the distance and outward normal at which a ray enters an upright cylinder on the ground. Rays that begin
/// inside hit nothing.
fn ray_to_cylinder(o: [f32; 3], d: [f32; 3], radius: f32, height: f32) -> Option<(f32, [f32; 3])> {
    let a = d[0] * d[0] + d[1] * d[1];
    let beside = o[0] * o[0] + o[1] * o[1] - radius * radius;
    if beside >= 0.0 && a > 0.0 {
        let flat = Scalar::sqrt(a);
        let distance = ray_to_disc([o[0], o[1]], [d[0] / flat, d[1] / flat], radius)? / flat;
        let z = o[2] + distance * d[2];
        if (0.0..=height).contains(&z) {
            let out = [o[0] + distance * d[0], o[1] + distance * d[1]];
            let length = Scalar::sqrt(out[0] * out[0] + out[1] * out[1]);
            return Some((distance, [out[0] / length, out[1] / length, 0.0]));
        }
    }
    let (end, up) = if o[2] > height { (height, 1.0) } else { (0.0, -1.0) };
    if (o[2] - end) * up < 0.0 || d[2] * up >= 0.0 {
        return None;
    }
    let distance = (end - o[2]) / d[2];
    let [x, y] = [o[0] + distance * d[0], o[1] + distance * d[1]];
    (x * x + y * y <= radius * radius).then_some((distance, [0.0, 0.0, up]))
}

/// See [`farsa_body::ports::Rays::cast`].
pub(crate) fn cast(world: &impl View, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<BodyId>> {
    let model = world.model();
    let mut hit: Option<Hit<BodyId>> = None;
    let mut nearest = range;
    let mut meet = |distance: f32, normal: [f32; 3]| {
        if distance < nearest || hit.is_none() && distance <= nearest {
            nearest = distance;
            hit = Some(Hit { distance, normal, body: None });
        }
    };
    // A hair farther than the ray, for rounding.
    let reach = 1.001 * range;
    if origin[2] >= 0.0 && direction[2] < 0.0 {
        meet(origin[2] / -direction[2], [0.0, 0.0, 1.0]);
    }
    for slab in model.slabs.iter().filter(|slab| slab.within_reach([origin[0], origin[1]], reach)) {
        let [c, s] = slab.axis;
        let turn = |x: f32, y: f32| [x * c + y * s, y * c - x * s];
        let [x, y] = turn(origin[0] - slab.centre[0], origin[1] - slab.centre[1]);
        let [u, v] = turn(direction[0], direction[1]);
        let up = 0.5 * slab.height;
        let half = [slab.half[0], slab.half[1], up];
        if let Some((distance, [a, b, n])) =
            crate::articulated::ray::block([x, y, origin[2] - up], [u, v, direction[2]], half)
        {
            meet(distance, [a * c - b * s, a * s + b * c, n]);
        }
    }
    for solid in &model.solids {
        if let Some((distance, normal)) = cast_to_solid(solid, origin, direction) {
            meet(distance, normal);
        }
    }
    let mut met: Option<(f32, usize, [f32; 3])> = None;
    along(world, [origin[0], origin[1]], [direction[0], direction[1]], range, nearest, |body| {
        let [x, y] = place(world, body);
        let from = [origin[0] - x, origin[1] - y, origin[2]];
        if let Some((distance, normal)) = ray_to_cylinder(from, direction, model.radius(body), model.height(body))
            && distance <= range
            && met.is_none_or(|met| (distance, body) < (met.0, met.1))
        {
            met = Some((distance, body, normal));
        }
        met.map_or(nearest, |met| met.0)
    });
    match met {
        Some((distance, body, normal)) if distance < nearest || hit.is_none() => {
            Some(Hit { distance, normal, body: Some(BodyId(body as u16)) })
        }
        _ => hit,
    }
}

/// The color of the ground at a place.
pub(crate) fn ground(world: &impl View, at: [f32; 2]) -> [f32; 3] {
    let model = world.model();
    for (i, patch) in model.patches.iter().enumerate().rev() {
        let body = model.round_bodies() + i;
        let [[cx, cy], [c, s]] = [place(world, body), axis(world, body)];
        let [x, y] = [at[0] - cx, at[1] - cy];
        let within = if patch.disc {
            x * x + y * y <= patch.half[0] * patch.half[0]
        } else {
            (x * c + y * s).abs() <= patch.half[0] && (y * c - x * s).abs() <= patch.half[1]
        };
        if within {
            return patch.color;
        }
    }
    model.ground
}

pub(crate) fn lamps(world: &impl View, mut tell: impl FnMut(Lamp<BodyId>)) {
    let model = world.model();
    for (i, round) in model.rounds.iter().enumerate().filter(|(_, round)| round.lamp > 0.0) {
        let body = model.robots.len() + i;
        tell(Lamp { body: BodyId(body as u16), position: place(world, body), intensity: round.lamp });
    }
}

pub(crate) fn attached(world: &impl View, robot: BodyId) -> Option<BodyId> {
    (robot.index() < world.model().robots.len()).then(|| body_of(robot_word(world, robot.index(), HELD)))?
}

/// Returns whether an attachment device holds or has a command above 0.5.
pub(crate) fn holds(world: &impl View) -> bool {
    let model = world.model();
    let wants = |robot: usize| {
        let device = model.kind(robot).robot.attachment.is_some();
        let last = model.kind(robot).robot.actuators() - 1;
        robot_word(world, robot, HELD) >= 0.0 || device && world.word(model.command(robot, last)) > 0.5
    };
    model.attachments && (0..model.robots.len()).any(wants)
}

pub(crate) fn clear(world: &mut impl View) {
    for i in 0..world.model().len() {
        world.set_word(i, world.model().initial[i]);
    }
}

pub(crate) fn place_joint(world: &mut impl View, joint: JointId, position: f32, speed: f32) {
    for (x, is_speed) in [(position, false), (speed, true)] {
        if let Some(at) = wheel(world.model(), joint, is_speed) {
            world.set_word(at, x);
        }
    }
}

/// Puts a body down by its place and heading. A robot there is at rest, touches nothing and holds nothing.
pub(crate) fn place_body(world: &mut impl View, body: BodyId, pose: Pose) {
    let body = body.index();
    if body >= world.model().bodies() {
        return;
    }
    let heading = pose.heading();
    for (k, x) in pose_words([pose.position[0], pose.position[1]], heading).into_iter().enumerate() {
        world.set_word(POSE_WORDS * body + k, x);
    }
    if body < world.model().robots.len() {
        let first = world.model().robot_word(body, 0);
        (VELOCITY..VELOCITY + 3).chain(CONTACT..CONTACT + 5).for_each(|k| world.set_word(first + k, 0.0));
        for k in [MET, HELD] {
            world.set_word(first + k, NOTHING);
        }
        for holder in 0..world.model().robots.len() {
            let held = world.model().robot_word(holder, HELD);
            if world.model().attachments && world.word(held) == body as f32 {
                world.set_word(held, NOTHING);
            }
        }
    }
}
