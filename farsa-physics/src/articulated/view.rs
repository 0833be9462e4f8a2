//! The ports of a world, read from the words of its state and the places of its links, for one world and a lane.

use farsa_body::ports::{BodyId, JointId, PairContact, PairId};
use farsa_body::robot::JointKind;
use farsa_body::{Pose, Twist};
use farsa_num::Real;

use crate::articulated::link::{Motion, WORLD};
use crate::articulated::model::{Model, Mount, POINT_WORDS, Pair};
use crate::articulated::spatial::{Matrix, Spatial, Vector, add, cross, product, rotate, sub};

/// A world as its ports see it.
pub(crate) trait View<R: Real> {
    /// The constant part.
    fn model(&self) -> &Model<R>;
    /// A word of the state.
    fn word(&self, index: usize) -> R;
    /// Returns whether a point of a pair carries a normal impulse.
    fn touching(&self, index: usize, pair: &Pair<R>) -> bool;
    /// Changes a word of the state.
    fn set_word(&mut self, index: usize, x: R);
    /// Rotation and position of a moving link.
    fn link_frame(&self, link: usize) -> (Matrix<R>, Vector<R>);
    /// Position of a moving link.
    fn link_position(&self, link: usize) -> Vector<R>;
    /// Velocity of a moving link, and the point that its linear part belongs to.
    fn motion(&self, link: usize) -> (Spatial<R>, Vector<R>);
}

/// The unit quaternion [x, y, z, w] of a rotation, w >= 0 where it is not close to 0.
pub(crate) fn quaternion<R: Real>(m: &Matrix<R>) -> [R; 4] {
    let one = R::from_f64(1.0);
    let half = R::from_f64(0.5);
    let trace = m[0][0] + m[1][1] + m[2][2];
    if trace > R::from_f64(0.0) {
        let s = (trace + one).sqrt();
        let k = half / s;
        return [(m[2][1] - m[1][2]) * k, (m[0][2] - m[2][0]) * k, (m[1][0] - m[0][1]) * k, s * half];
    }
    if m[0][0] >= m[1][1] && m[0][0] >= m[2][2] {
        quaternion_about::<R, 0>(m)
    } else if m[1][1] >= m[2][2] {
        quaternion_about::<R, 1>(m)
    } else {
        quaternion_about::<R, 2>(m)
    }
}

/// The quaternion of a rotation whose largest component is that of axis `I`.
#[inline(always)]
fn quaternion_about<R: Real, const I: usize>(m: &Matrix<R>) -> [R; 4] {
    let (i, j, k) = (I, (I + 1) % 3, (I + 2) % 3);
    let half = R::from_f64(0.5);
    let s = (m[i][i] - m[j][j] - m[k][k] + R::from_f64(1.0)).sqrt();
    let t = half / s;
    let mut q = [R::from_f64(0.0); 4];
    q[i] = s * half;
    q[j] = (m[j][i] + m[i][j]) * t;
    q[k] = (m[k][i] + m[i][k]) * t;
    q[3] = (m[k][j] - m[j][k]) * t;
    q
}

/// Pose of a body's frame. The identity for a body that does not exist.
#[inline]
pub(crate) fn pose<R: Real>(world: &impl View<R>, body: BodyId) -> Pose<R> {
    let Some(mount) = world.model().mounts.get(body.index()) else { return Pose::identity() };
    if mount.link == WORLD {
        return Pose { position: mount.position, rotation: quaternion(&mount.rotation) };
    }
    let (rotation, position) = world.link_frame(usize::from(mount.link));
    Pose {
        position: add(position, rotate(&rotation, mount.position)),
        rotation: quaternion(&product(&rotation, &mount.rotation)),
    }
}

/// Where the origin of a body's frame is. The world's origin for a body that does not exist.
pub(crate) fn origin<R: Real>(world: &impl View<R>, body: BodyId) -> Vector<R> {
    world.model().mounts.get(body.index()).map_or([R::from_f64(0.0); 3], |mount| place(world, mount))
}

/// Where a mount's origin is.
pub(crate) fn place<R: Real>(world: &impl View<R>, mount: &Mount<R>) -> Vector<R> {
    if mount.link == WORLD {
        return mount.position;
    }
    let link = usize::from(mount.link);
    if mount.position == [R::from_f64(0.0); 3] {
        // The nine words of the rotation need not be read.
        return add(world.link_position(link), mount.position);
    }
    let (rotation, position) = world.link_frame(link);
    add(position, rotate(&rotation, mount.position))
}

/// Velocity of a body's origin and its angular velocity.
pub(crate) fn velocity<R: Real>(world: &impl View<R>, body: BodyId) -> Twist<R> {
    let Some(mount) = world.model().mounts.get(body.index()) else { return Twist::default() };
    if mount.link == WORLD {
        return Twist::default();
    }
    let link = usize::from(mount.link);
    let (rotation, position) = world.link_frame(link);
    let (velocity, reference) = world.motion(link);
    let origin = add(position, rotate(&rotation, mount.position));
    Twist { linear: velocity.at(sub(origin, reference)), angular: velocity.angular }
}

/// Angle or displacement of a joint, or 0 for one that has none.
#[inline]
pub(crate) fn joint_position<R: Real>(world: &impl View<R>, joint: JointId) -> f32 {
    world.model().joint_index(joint).map_or(0.0, |(q, _)| world.word(q).to_f64() as f32)
}

/// Speed of a joint, or 0 for one that has none.
#[inline]
pub(crate) fn joint_speed<R: Real>(world: &impl View<R>, joint: JointId) -> f32 {
    let model = world.model();
    model.joint_index(joint).map_or(0.0, |(_, v)| world.word(model.positions + v).to_f64() as f32)
}

/// Sets the command of an actuator.
#[inline]
pub(crate) fn command<R: Real>(world: &mut impl View<R>, actuator: usize, value: [f32; 2]) {
    if actuator < world.model().actuators.len() {
        let at = world.model().first_command() + 2 * actuator;
        world.set_word(at, R::from_f64(f64::from(value[0])));
        world.set_word(at + 1, R::from_f64(f64::from(value[1])));
    }
}

/// Returns whether a point of a pair carries a normal impulse in a state.
#[inline]
pub(crate) fn is_touching<R: Real>(model: &Model<R>, pair: &Pair<R>, state: &[R]) -> bool {
    let first = model.first_point() + POINT_WORDS * pair.point;
    let points = state[first..first + POINT_WORDS * pair.points].chunks_exact(POINT_WORDS);
    points.into_iter().any(|point| point[3] > R::from_f64(0.0))
}

/// Returns whether a point of a pair carries a normal force.
#[inline]
pub(crate) fn touches<R: Real>(world: &impl View<R>, pair: PairId) -> bool {
    let model = world.model();
    let index = pair.index();
    let Some(pair) = model.pairs.get(index) else { return false };
    world.touching(index, pair)
}

/// Returns the contact of a pair.
pub(crate) fn pair_contact<R: Real>(world: &impl View<R>, pair: PairId) -> PairContact {
    let model = world.model();
    let Some(pair) = model.pairs.get(pair.index()) else { return PairContact::default() };
    let mut contact = PairContact { depth: f32::NEG_INFINITY, ..PairContact::default() };
    let (mut force, mut normal, mut moment) = ([0.0; 3], 0.0, [0.0; 3]);
    let per_second = 1.0 / model.h.to_f64();
    for point in pair.point..pair.point + pair.points {
        let w = |k: usize| world.word(model.first_point() + POINT_WORDS * point + k).to_f64();
        contact.depth = contact.depth.max(-w(7) as f32);
        if w(3) > 0.0 {
            contact.points += 1;
            let f = w(3) * per_second;
            normal += f;
            for k in 0..3 {
                force[k] += w(k) * per_second;
                moment[k] += w(4 + k) * f;
            }
        }
    }
    if contact.points > 0 {
        // The points are of the first collider in the model's order.
        let sign = if pair.flipped { -1.0 } else { 1.0 };
        contact.force = force.map(|x| (sign * x) as f32);
        contact.normal_force = normal as f32;
        contact.point = moment.map(|x| (x / normal) as f32);
    }
    contact
}

/// Puts a joint somewhere.
pub(crate) fn place_joint<R: Real>(world: &mut impl View<R>, joint: JointId, position: f32, speed: f32) {
    let first_speed = world.model().positions;
    if let Some((q, v)) = world.model().joint_index(joint) {
        world.set_word(q, R::from_f64(f64::from(position)));
        world.set_word(first_speed + v, R::from_f64(f64::from(speed)));
    }
}

/// Puts a floating body somewhere, nothing happens to another.
pub(crate) fn place_body<R: Real>(world: &mut impl View<R>, body: BodyId, pose: Pose, twist: Twist) {
    let model = world.model();
    let Some(link) = model.link_of(body) else { return };
    let link = &model.links[link];
    if link.motion != Motion::Floating || model.joints[body.index()] != JointKind::Floating {
        return;
    }
    let (q, v) = (usize::from(link.q), model.positions + usize::from(link.dof));
    let pose: Pose<R> = pose.cast();
    let [angular, linear] = [twist.angular, twist.linear].map(|a| a.map(|x| R::from_f64(f64::from(x))));
    let rotation = pose.rotation;
    let length =
        (rotation[0] * rotation[0] + rotation[1] * rotation[1] + rotation[2] * rotation[2] + rotation[3] * rotation[3])
            .sqrt();
    let centre = add(linear, cross(angular, pose.rotate(link.centre)));
    for k in 0..3 {
        world.set_word(q + k, pose.position[k]);
        world.set_word(v + k, angular[k]);
        world.set_word(v + 3 + k, centre[k]);
    }
    for k in 0..4 {
        world.set_word(q + 3 + k, rotation[k] / length);
    }
}
