//! Recorded runs of a world, compared bit by bit.

use alloc::{format, string::String, vec, vec::Vec};
use core::ops::Range;

use farsa_num::{Domain, Stream};

use crate::ports::{Actuated, Contacts, Joints, Kinematics, PairId, Snapshot, World};
use crate::testing::probe::Probe;

/// Number of steps between two commands of the script.
pub(crate) const HOLD: usize = 8;

/// All bits of a world at one instant: what its ports report and its snapshot.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Instant {
    readings: Vec<u32>,
    snapshot: Vec<u32>,
    joints: usize,
    bodies: usize,
}

const JOINT_WORDS: usize = 2;
const BODY_WORDS: usize = 13;
const PAIR_WORDS: usize = 9;

impl Instant {
    pub(crate) fn from_world<W>(world: &W, probe: &Probe<W::Body, W::Joint, W::Actuator>) -> Self
    where
        W: Joints + Kinematics + Contacts + Snapshot,
    {
        let mut readings = Vec::new();
        for &(joint, _) in &probe.joints {
            readings.extend([world.position(joint), world.speed(joint)].map(f32::to_bits));
        }
        for &body in &probe.bodies {
            let (pose, twist) = (world.pose(body), world.velocity(body));
            readings.extend(pose.position.map(f32::to_bits));
            readings.extend(pose.rotation.map(f32::to_bits));
            readings.extend(twist.linear.map(f32::to_bits));
            readings.extend(twist.angular.map(f32::to_bits));
        }
        for pair in pairs(world) {
            let contact = world.pair_contact(pair);
            readings.push(contact.points);
            readings.extend(contact.force.map(f32::to_bits));
            readings.push(contact.normal_force.to_bits());
            readings.extend(contact.point.map(f32::to_bits));
            readings.push(contact.depth.to_bits());
        }
        let snapshot = saved(world).into_iter().map(f32::to_bits).collect();
        Self { readings, snapshot, joints: probe.joints.len(), bodies: probe.bodies.len() }
    }

    /// Returns the first difference between the ports' readings, or `None` for equal ones.
    pub(crate) fn other_readings(&self, other: &Self) -> Option<String> {
        if self.readings.len() != other.readings.len() {
            return Some(format!("{} readings and {}", self.readings.len(), other.readings.len()));
        }
        let at = self.readings.iter().zip(&other.readings).position(|(a, b)| a != b)?;
        let (joint_words, body_words) = (self.joints * JOINT_WORDS, self.bodies * BODY_WORDS);
        let (part, index, words) = if at < joint_words {
            ("joint", at, JOINT_WORDS)
        } else if at < joint_words + body_words {
            ("body", at - joint_words, BODY_WORDS)
        } else {
            ("pair", at - joint_words - body_words, PAIR_WORDS)
        };
        let [a, b] = [self, other].map(|instant| f32::from_bits(instant.readings[at]));
        Some(format!("{part} {}, word {}: {a:e} and {b:e}", index / words, index % words))
    }

    /// Returns the first difference, or `None` for equal runs.
    pub(crate) fn difference(&self, other: &Self) -> Option<String> {
        if let Some(difference) = self.other_readings(other) {
            return Some(difference);
        }
        if self.snapshot.len() != other.snapshot.len() {
            return Some(format!("snapshots of {} and {} words", self.snapshot.len(), other.snapshot.len()));
        }
        let at = self.snapshot.iter().zip(&other.snapshot).position(|(a, b)| a != b)?;
        Some(format!("word {at} of the snapshot: {:#010x} and {:#010x}", self.snapshot[at], other.snapshot[at]))
    }
}

/// The pairs of a world.
pub(crate) fn pairs<W: Contacts>(world: &W) -> impl Iterator<Item = PairId> + use<W> {
    (0..world.pairs()).map(|i| PairId(i as u16))
}

/// A snapshot of a world.
pub(crate) fn saved<W: Snapshot>(world: &W) -> Vec<f32> {
    let mut words = vec![0.0; world.snapshot_len()];
    world.save(&mut words);
    words
}

/// Gives every actuator a new random command in the ticks divisible by [`HOLD`], and in the others none.
pub(crate) fn command<W: Actuated>(world: &mut W, probe: &Probe<W::Body, W::Joint, W::Actuator>, tick: usize) {
    if tick.is_multiple_of(HOLD) {
        recommand(world, probe, tick);
    }
}

/// Gives every actuator the command that holds in this tick.
fn recommand<W: Actuated>(world: &mut W, probe: &Probe<W::Body, W::Joint, W::Actuator>, tick: usize) {
    let mut stream = Stream::new(0, Domain::Motor, (tick / HOLD) as u32, 0, 0);
    for &(actuator, [low, high]) in &probe.actuators {
        let value = [0, 1].map(|i| low[i] + (high[i] - low[i]) * stream.uniform());
        world.command(actuator, value);
    }
}

/// Runs a world through some ticks of the script. Returns one instant after each.
pub(crate) fn trace<W>(
    world: &mut W,
    probe: &Probe<W::Body, W::Joint, W::Actuator>,
    ticks: Range<usize>,
    repeat_commands: bool,
) -> Vec<Instant>
where
    W: World + Joints + Kinematics + Actuated + Contacts + Snapshot,
{
    ticks
        .map(|tick| {
            if repeat_commands {
                recommand(world, probe, tick);
            } else {
                command(world, probe, tick);
            }
            world.step();
            Instant::from_world(world, probe)
        })
        .collect()
}

/// Where two runs part, or `None` if they have the same bits.
pub(crate) fn parting(a: &[Instant], b: &[Instant]) -> Option<String> {
    let steps = a.iter().zip(b).enumerate();
    steps.into_iter().find_map(|(step, (a, b))| Some(format!("step {step}: {}", a.difference(b)?)))
}
