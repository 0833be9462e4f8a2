//! Checks for worlds that can be prepared for a new episode.

use alloc::format;

use crate::ports::{Actuated, Arrange, Contacts, Joints, Kinematics, Snapshot, World};
use crate::pose::{Pose, Twist};
use crate::testing::probe::Probe;
use crate::testing::promise::{ConformanceError, Promise, ensure};
use crate::testing::trace::{HOLD, Instant, parting, saved, trace};

/// The tolerance between a reading and the placed value. A world may keep other coordinates.
const NEAR: f32 = 1e-4;

/// Checks the port [`Arrange`] of a world. The closure `make` must always create the same world.
///
/// A world must not depend on its past after it was cleared. Joints, floating bodies and planar bodies must be where
/// they were placed. After [`Arrange::finish_placement`], the ports must report the same values as after a snapshot was
/// restored.
///
/// # Errors
/// Returns the first promise violated.
pub fn check_arrange<W>(
    make: impl Fn() -> W,
    probe: &Probe<W::Body, W::Joint, W::Actuator>,
) -> Result<(), ConformanceError>
where
    W: World + Joints + Kinematics + Actuated + Contacts + Snapshot + Arrange,
    W::Body: PartialEq,
{
    let forgets = |difference| match difference {
        Some(detail) => Err(ConformanceError { promise: Promise::ClearForgets, detail }),
        None => Ok(()),
    };
    let (mut fresh, mut used) = (make(), make());
    trace(&mut used, probe, 0..3 * HOLD + 1, false);
    for world in [&mut fresh, &mut used] {
        world.clear();
        world.finish_placement();
    }
    forgets(Instant::from_world(&fresh, probe).difference(&Instant::from_world(&used, probe)))?;
    for (index, &(joint, _)) in probe.joints.iter().enumerate() {
        let speed = fresh.speed(joint);
        ensure(speed == 0.0, Promise::ClearForgets, || format!("joint {index} is cleared to a speed of {speed}"))?;
    }

    for world in [&mut fresh, &mut used] {
        place(world, probe);
        world.finish_placement();
    }
    check_joints(&fresh, probe)?;
    check_bodies(&mut fresh, probe)?;

    let instant = Instant::from_world(&fresh, probe);
    let mut restored = make();
    restored.restore(&saved(&fresh));
    let difference = instant.difference(&Instant::from_world(&restored, probe));
    ensure(difference.is_none(), Promise::Arranged, || difference.unwrap_or_default())?;

    // After the same setting up the same episode, whatever went before.
    let [a, b] = [&mut fresh, &mut used].map(|world| trace(world, probe, 1..2 * HOLD, false));
    forgets(parting(&a, &b))
}

/// A place within a joint's range, another for each.
fn joint_place(index: usize, [low, high]: [f32; 2]) -> [f32; 2] {
    let part = 0.25 + 0.125 * (index % 5) as f32;
    [low + (high - low) * part, 0.1 * (index % 3) as f32 - 0.1]
}

/// A place and a velocity for a floating body, another for each, far from everything.
fn body_place(index: usize) -> (Pose, Twist) {
    let i = index as f32;
    (
        Pose { position: [10.0 + i, -20.0, 30.0], rotation: [0.5, -0.5, 0.5, 0.5] },
        Twist { linear: [0.1, 0.2 + i, -0.3], angular: [-0.4, 0.5, 0.6] },
    )
}

/// A place on the plane, another for each, far from everything.
fn planar_place(index: usize) -> Pose {
    let i = index as f32;
    let (sine, cosine) = farsa_num::sin_cos(0.5 * (0.3 + i));
    Pose { position: [10.0 + i, -20.0, 0.0], rotation: [0.0, 0.0, sine, cosine] }
}

fn place<W: Arrange>(world: &mut W, probe: &Probe<W::Body, W::Joint, W::Actuator>) {
    for (index, &(joint, range)) in probe.joints.iter().enumerate() {
        let [position, speed] = joint_place(index, range);
        world.place_joint(joint, position, speed);
    }
    for (index, &body) in probe.floating.iter().enumerate() {
        let (pose, twist) = body_place(index);
        world.place_body(body, pose, twist);
    }
    for (index, &body) in probe.planar.iter().enumerate() {
        world.place_body(body, planar_place(index), Twist::default());
    }
}

fn check_joints<W: Joints>(world: &W, probe: &Probe<W::Body, W::Joint, W::Actuator>) -> Result<(), ConformanceError> {
    for (index, &(joint, range)) in probe.joints.iter().enumerate() {
        let placed = joint_place(index, range);
        let measured = [world.position(joint), world.speed(joint)];
        ensure(near(&placed, &measured), Promise::JointPlaced, || {
            format!("joint {index}: {measured:?} instead of {placed:?}")
        })?;
    }
    Ok(())
}

fn check_bodies<W>(world: &mut W, probe: &Probe<W::Body, W::Joint, W::Actuator>) -> Result<(), ConformanceError>
where
    W: Joints + Kinematics + Contacts + Snapshot + Arrange,
    W::Body: PartialEq,
{
    for (index, &body) in probe.floating.iter().enumerate() {
        let (pose, twist) = body_place(index);
        let (measured, moving) = (world.pose(body), world.velocity(body));
        let holds = near(&pose.position, &measured.position)
            && same_turn(&pose, &measured)
            && near(&twist.linear, &moving.linear)
            && near(&twist.angular, &moving.angular);
        ensure(holds, Promise::BodyPlaced, || format!("floating body {index}: {measured:?}, {moving:?}"))?;
    }
    for (index, &body) in probe.planar.iter().enumerate() {
        let (pose, measured, moving) = (planar_place(index), world.pose(body), world.velocity(body));
        let holds =
            near(&pose.position, &measured.position) && same_turn(&pose, &measured) && moving == Twist::default();
        ensure(holds, Promise::BodyPlaced, || format!("planar body {index}: {measured:?}, {moving:?}"))?;
    }
    let before = Instant::from_world(world, probe);
    let placed = |body| probe.floating.contains(body) || probe.planar.contains(body);
    for &body in probe.bodies.iter().filter(|body| !placed(body)) {
        world.place_body(body, Pose::at([1.0, 2.0, 3.0]), Twist::default());
    }
    world.finish_placement();
    let difference = before.difference(&Instant::from_world(world, probe));
    ensure(difference.is_none(), Promise::BodyPlaced, || {
        format!("a body on a joint was placed: {}", difference.unwrap_or_default())
    })
}

/// Returns whether two orientations are the same, either quaternion will do.
fn same_turn(a: &Pose, b: &Pose) -> bool {
    let same: f32 = a.rotation.iter().zip(b.rotation).fold(0.0, |sum, (a, b)| sum + a * b);
    same.abs() > 1.0 - NEAR
}

fn near(a: &[f32], b: &[f32]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= NEAR * (1.0 + a.abs()))
}
