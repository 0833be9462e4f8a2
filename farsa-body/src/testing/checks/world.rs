//! Checks for worlds that can be simulated step by step.

use alloc::{format, string::String, vec, vec::Vec};

use crate::ports::{Actuated, Contacts, Joints, Kinematics, PairContact, PairId, Snapshot, World};
use crate::pose::Pose;
use crate::testing::probe::Probe;
use crate::testing::promise::{ConformanceError, Promise, ensure};
use crate::testing::trace::{HOLD, Instant, command, pairs, parting, saved, trace};

/// Checks a world while it is stepped. The closure `make` must always create the same world.
///
/// The worlds are simulated with random commands within the ranges of the probe. Equal commands must lead to equal
/// bits, snapshots must be complete, commands must have an effect and remain active, and all ports must be consistent.
/// In nine of ten steps, the mean velocity must not deviate from the velocities at both ends by more than these differ
/// from each other, with a tolerance of [`Probe::slack`].
///
/// # Errors
/// Returns the first promise violated.
pub fn check_world<W>(
    make: impl Fn() -> W,
    probe: &Probe<W::Body, W::Joint, W::Actuator>,
) -> Result<(), ConformanceError>
where
    W: World + Joints + Kinematics + Actuated + Contacts + Snapshot,
    W::Body: PartialEq,
{
    let steps = probe.steps.max(2 * HOLD);
    check_telling(&mut make(), probe, steps)?;
    let run = trace(&mut make(), probe, 0..steps, false);
    let broken = |promise, difference: Option<String>| match difference {
        Some(detail) => Err(ConformanceError { promise, detail }),
        None => Ok(()),
    };
    broken(Promise::Deterministic, parting(&run, &trace(&mut make(), probe, 0..steps, false)))?;
    broken(Promise::CommandHolds, parting(&run, &trace(&mut make(), probe, 0..steps, true)))?;

    // In the middle of the run and of a command, so that the command held must be in the snapshot.
    let middle = steps / 2 / HOLD * HOLD + HOLD / 2;
    let mut world = make();
    trace(&mut world, probe, 0..middle, false);
    check_save(&world)?;
    let snapshot = saved(&world);
    let instant = Instant::from_world(&world, probe);
    let rest = &run[middle..];
    trace(&mut world, probe, middle..steps, false);
    world.restore(&snapshot);
    broken(Promise::SnapshotRestores, instant.difference(&Instant::from_world(&world, probe)))?;
    broken(Promise::SnapshotReplays, parting(rest, &trace(&mut world, probe, middle..steps, false)))?;

    // The other world has another past: nothing of it may shine through.
    let mut other = make();
    trace(&mut other, probe, HOLD..2 * HOLD, false);
    other.restore(&snapshot);
    broken(Promise::SnapshotTravels, instant.difference(&Instant::from_world(&other, probe)))?;
    broken(Promise::SnapshotTravels, parting(rest, &trace(&mut other, probe, middle..steps, false)))?;

    for (index, &(actuator, [low, high])) in probe.actuators.iter().enumerate() {
        // Only the first number differs: equal activations of two muscles cancel.
        let [a, b] = [low, [high[0], low[1]]].map(|value| {
            let mut world = make();
            world.command(actuator, value);
            for _ in 0..HOLD {
                world.step();
            }
            Instant::from_world(&world, probe)
        });
        ensure(a.other_readings(&b).is_some(), Promise::CommandActs, || {
            format!("actuator {index} does the same under {low:?} and {:?}", [high[0], low[1]])
        })?;
    }
    Ok(())
}

/// Saving over two different backgrounds must leave no word of either.
fn check_save<W: Snapshot>(world: &W) -> Result<(), ConformanceError> {
    let [mut a, mut b] = [1.25_f32, -7.5].map(|x| vec![x; world.snapshot_len()]);
    world.save(&mut a);
    world.save(&mut b);
    let unwritten = a.iter().zip(&b).position(|(a, b)| a.to_bits() != b.to_bits());
    ensure(unwritten.is_none(), Promise::SnapshotFilled, || {
        format!("word {} of {} is not written", unwritten.unwrap_or_default(), a.len())
    })
}

/// Steps a world and checks at every step that what its ports report fits together.
fn check_telling<W>(
    world: &mut W,
    probe: &Probe<W::Body, W::Joint, W::Actuator>,
    steps: usize,
) -> Result<(), ConformanceError>
where
    W: World + Joints + Kinematics + Actuated + Contacts,
    W::Body: PartialEq,
{
    let dt = world.time_step();
    ensure(dt.is_finite() && dt > 0.0, Promise::TimeStep, || format!("a time step of {dt} s"))?;
    check_pairs(world, probe)?;
    check_instant(world, probe, 0)?;
    let (mut joint_moves, mut body_moves, mut body_turns) = (Vec::new(), Vec::new(), Vec::new());
    joint_moves.resize(probe.joints.len(), Odd::default());
    body_moves.resize(probe.bodies.len(), Odd::default());
    body_turns.resize(probe.bodies.len(), Odd::default());
    for step in 0..steps {
        let joints: Vec<_> = probe.joints.iter().map(|&(j, _)| (world.position(j), world.speed(j))).collect();
        let bodies: Vec<_> = probe.bodies.iter().map(|&b| (world.pose(b), world.velocity(b))).collect();
        command(world, probe, step);
        world.step();
        check_instant(world, probe, step + 1)?;
        for ((&(joint, _), (position, speed)), odd) in probe.joints.iter().zip(joints).zip(&mut joint_moves) {
            let mean = (world.position(joint) - position) / dt;
            odd.note(step, probe.slack, [mean], [speed], [world.speed(joint)]);
        }
        let odds = body_moves.iter_mut().zip(&mut body_turns);
        for ((&body, (pose, twist)), (moves, turns)) in probe.bodies.iter().zip(bodies).zip(odds) {
            let (next, end) = (world.pose(body), world.velocity(body));
            let mean = [0, 1, 2].map(|i| (next.position[i] - pose.position[i]) / dt);
            moves.note(step, probe.slack, mean, twist.linear, end.linear);
            let turn = turn(&pose, &next).map(|x| x / dt);
            turns.note(step, probe.slack, turn, twist.angular, end.angular);
        }
    }
    let kinds = [
        (joint_moves, Promise::JointSpeed, "joint"),
        (body_moves, Promise::Velocity, "linear velocity of body"),
        (body_turns, Promise::Velocity, "angular velocity of body"),
    ];
    for (odds, promise, part) in kinds {
        for (index, odd) in odds.into_iter().enumerate() {
            ensure(odd.steps * USUAL <= steps, promise, || {
                format!("{part} {index}, in {} of {steps} steps, at first {}", odd.steps, odd.first)
            })?;
        }
    }
    Ok(())
}

/// One step in this number may be odd, because an impact within it leaves no trace in the velocities at its ends.
const USUAL: usize = 10;

/// The steps in which a part's motion differs from its velocities.
#[derive(Clone, Default)]
struct Odd {
    steps: usize,
    first: String,
}

impl Odd {
    /// Counts a step if the mean velocity over it is more than `slack` farther from that of its ends than these differ.
    fn note<const N: usize>(&mut self, step: usize, slack: f32, mean: [f32; N], start: [f32; N], end: [f32; N]) {
        let length = |v: [f32; N]| farsa_num::Scalar::sqrt(v.iter().fold(0.0, |sum, x| sum + x * x));
        let (mut off, mut change) = ([0.0; N], [0.0; N]);
        for i in 0..N {
            off[i] = mean[i] - 0.5 * (start[i] + end[i]);
            change[i] = end[i] - start[i];
        }
        if length(off) - length(change) > slack {
            if self.steps == 0 {
                self.first = format!("step {step}: moves at {mean:?}, reported {start:?} -> {end:?}");
            }
            self.steps += 1;
        }
    }
}

/// The rotation from one pose to the next as a vector [rad], in the world's axes, to third order.
fn turn(from: &Pose, to: &Pose) -> [f32; 3] {
    let [x, y, z, w] = from.rotation;
    let back = Pose { position: [0.0; 3], rotation: [-x, -y, -z, w] };
    let [x, y, z, w] = Pose { position: [0.0; 3], rotation: to.rotation }.compose(&back).rotation;
    let sine = x * x + y * y + z * z;
    let factor = (2.0 + sine / 3.0) * if w < 0.0 { -1.0 } else { 1.0 };
    [x * factor, y * factor, z * factor]
}

fn check_pairs<W>(world: &W, probe: &Probe<W::Body, W::Joint, W::Actuator>) -> Result<(), ConformanceError>
where
    W: Contacts,
    W::Body: PartialEq,
{
    for pair in pairs(world) {
        let [a, b] = world.pair_bodies(pair);
        let listed = [&a, &b].into_iter().flatten().all(|body| probe.bodies.contains(body));
        ensure((a.is_some() || b.is_some()) && listed, Promise::PairBodies, || {
            let which = [&a, &b].map(|body| body.as_ref().map(|body| probe.bodies.iter().position(|b| b == body)));
            format!("pair {}: bodies {which:?}", pair.0)
        })?;
    }
    for beyond in [world.pairs(), world.pairs() + 1, usize::from(u16::MAX)] {
        if let Ok(beyond) = u16::try_from(beyond).map(PairId)
            && beyond.index() >= world.pairs()
        {
            let contact = world.pair_contact(beyond);
            let bodies = world.pair_bodies(beyond);
            let nothing = contact == PairContact::default() && bodies.iter().all(Option::is_none);
            ensure(nothing, Promise::NoSuchPair, || format!("pair {} of {}: {contact:?}", beyond.0, world.pairs()))?;
        }
    }
    Ok(())
}

/// Checks all that the ports report at one instant.
fn check_instant<W>(
    world: &W,
    probe: &Probe<W::Body, W::Joint, W::Actuator>,
    step: usize,
) -> Result<(), ConformanceError>
where
    W: Joints + Kinematics + Contacts,
{
    for (index, &(joint, _)) in probe.joints.iter().enumerate() {
        let motion = [world.position(joint), world.speed(joint)];
        ensure(finite(&motion), Promise::Finite, || format!("step {step}, joint {index}: {motion:?}"))?;
    }
    for (index, &body) in probe.bodies.iter().enumerate() {
        let (pose, twist) = (world.pose(body), world.velocity(body));
        let holds = finite(&pose.position) && finite(&pose.rotation) && finite(&twist.linear) && finite(&twist.angular);
        ensure(holds, Promise::Finite, || format!("step {step}, body {index}: {pose:?}, {twist:?}"))?;
        let length = pose.rotation.iter().fold(0.0, |sum, x| sum + x * x);
        ensure((length - 1.0).abs() < 1e-3, Promise::UnitRotation, || {
            format!("step {step}, body {index}: {:?}", pose.rotation)
        })?;
        let origin = world.origin(body);
        ensure(origin == pose.position, Promise::Origin, || {
            format!("step {step}, body {index}: origin {origin:?}, in the pose {:?}", pose.position)
        })?;
    }
    for pair in pairs(world) {
        let contact = world.pair_contact(pair);
        // A depth of minus infinity means that nothing is near.
        let holds = finite(&contact.force)
            && finite(&contact.point)
            && contact.normal_force.is_finite()
            && contact.depth < f32::INFINITY;
        ensure(holds, Promise::Finite, || format!("step {step}, pair {}: {contact:?}", pair.0))?;
        let holds = if contact.points == 0 {
            contact.normal_force == 0.0 && contact.force == [0.0; 3] && contact.point == [0.0; 3]
        } else {
            contact.normal_force > 0.0
        };
        let holds = holds && world.touches(pair) == (contact.points > 0);
        ensure(holds, Promise::Contact, || format!("step {step}, pair {}: {contact:?}", pair.0))?;
    }
    Ok(())
}

fn finite(values: &[f32]) -> bool {
    values.iter().all(|x| x.is_finite())
}
