//! A lane of a batch is the world alone, bit for bit: the whole scene at every instruction set of this machine.
#![allow(missing_docs, clippy::unwrap_used)]

mod common;

use common::{Babble, commands, first_point, model, points_of, scene, start};
use farsa_body::{ArmAndHand, Arrange, Robot, ServoRange, World as _};
use farsa_num::fearless_simd::{Level, f32x8};
use farsa_num::{Digest, Domain, Scalar, Stream};
use farsa_physics::articulated::{Model, Options, Scratch, World, step};

const STEPS: usize = 2000;
const WORLDS: usize = 16;
/// Lanes are refilled every so often, but not together: each begins in another phase.
const LIFE: usize = 600;
/// The lane that loses a joint, and when.
const LOST: (usize, usize) = (3, 700);

/// What a lane does before step `t`: the number of the life that begins there, if one does.
fn begins(lane: usize, t: usize) -> Option<u32> {
    let shifted = t + 37 * lane;
    (t == 0 || shifted.is_multiple_of(LIFE)).then_some((lane + WORLDS * (shifted / LIFE)) as u32)
}

/// The state in which a life begins: the first lives of the lanes some way on, so that phases differ from the first step.
fn beginning(robot: &Robot, world: &mut World<f32>, groups: &[Vec<ServoRange>; 9], life: u32) -> (Vec<f32>, Babble) {
    start(robot, world, &mut Stream::new(5, Domain::Start, life, 0, 0), life as usize);
    let mut babble = Babble::new(5, life);
    for _ in 0..13 * (life as usize % 8) {
        common::drive(world, &commands(groups, babble.next()));
        world.step();
    }
    (world.state().to_vec(), babble)
}

fn digest(state: &[f32]) -> Digest {
    let mut d = Digest::new();
    d.add_f32s(state);
    d
}

/// Fingerprints of the state after every step of one lane, the last state, and the number of steps with hand contacts.
struct Truth {
    digests: Vec<Digest>,
    last: Vec<f32>,
    contacts: usize,
}

fn alone(robot: &Robot, model: &Model<f32>, groups: &[Vec<ServoRange>; 9], lane: usize) -> Truth {
    let mut world = World::new(model.clone());
    let mut other = world.clone();
    let mut babble = Babble::new(0, 0);
    let mut truth = Truth { digests: Vec::new(), last: Vec::new(), contacts: 0 };
    let table = robot.pair("sphere", "table").unwrap().index();
    let first = first_point(robot, model);
    let of_table: usize = first + 8 * (0..table).map(|p| points_of(robot, p)).sum::<usize>();
    let points: usize = (0..robot.pairs.len()).map(|p| points_of(robot, p)).sum();
    for t in 0..STEPS {
        if let Some(life) = begins(lane, t) {
            let (state, new) = beginning(robot, &mut other, groups, life);
            world.state_mut().copy_from_slice(&state);
            world.arranged();
            babble = new;
        }
        if (lane, t) == LOST {
            world.state_mut()[4] = f32::NAN;
            world.arranged();
        }
        common::drive(&mut world, &commands(groups, babble.next()));
        world.step();
        let state = world.state();
        truth.digests.push(digest(state));
        let touch = |at: usize| state[at + 3] > 0.0;
        truth.contacts += usize::from((0..points).map(|p| first + 8 * p).any(|at| at != of_table && touch(at)));
    }
    truth.last = world.state().to_vec();
    truth
}

#[inline(always)]
fn together<S: Scalar<Real = f32>>(
    simd: S::Simd,
    name: &str,
    robot: &Robot,
    model: &Model<f32>,
    groups: &[Vec<ServoRange>; 9],
    truths: &[Truth],
) {
    let mut other = World::new(model.clone());
    let mut state = vec![S::splat(simd, 0.0); model.state_len()];
    let mut scratch = Scratch::new(simd, model);
    let mut babbles = vec![Babble::new(0, 0); S::LANES];
    let command = model.positions() + model.dofs();
    let mut own = vec![0.0; model.state_len()];
    for t in 0..STEPS {
        let mut changed = false;
        for lane in 0..S::LANES {
            if let Some(life) = begins(lane, t) {
                let (start, new) = beginning(robot, &mut other, groups, life);
                for (x, w) in state.iter_mut().zip(start) {
                    x.set_lane(lane, w);
                }
                babbles[lane] = new;
                changed = true;
            }
            if (lane, t) == LOST {
                state[4].set_lane(lane, f32::NAN);
                changed = true;
            }
            for (i, c) in commands(groups, babbles[lane].next()).into_iter().enumerate() {
                state[command + 2 * i].set_lane(lane, c[0]);
                state[command + 2 * i + 1].set_lane(lane, c[1]);
            }
        }
        if changed {
            scratch.place(simd, model, &state);
        }
        step(simd, model, &mut state, &mut scratch);
        for lane in 0..S::LANES {
            for (o, x) in own.iter_mut().zip(&state) {
                *o = x.lane(lane);
            }
            assert!(digest(&own) == truths[lane].digests[t], "{name}: lane {lane} differs after step {t}");
        }
    }
    for lane in 0..S::LANES {
        for (k, (x, truth)) in state.iter().zip(&truths[lane].last).enumerate() {
            let x = x.lane(lane);
            assert!(x.to_bits() == truth.to_bits() || x.is_nan() && truth.is_nan(), "{name}: lane {lane} word {k}");
        }
    }
    println!("{name}: {} lanes x {STEPS} control steps, equal bits", S::LANES);
}

#[test]
fn every_lane_has_the_bits_of_the_world_alone() {
    let robot = scene();
    let model = model(&robot, Options::default());
    let groups = ArmAndHand::default().servo_groups();
    let truths: Vec<Truth> = (0..WORLDS).map(|lane| alone(&robot, &model, &groups, lane)).collect();
    let contacts: Vec<usize> = truths.iter().map(|t| t.contacts).collect();
    println!("steps with contacts of the hand: {contacts:?}");
    assert!(contacts.iter().enumerate().all(|(lane, n)| lane == LOST.0 || *n > STEPS / 20));
    // The lost lane forgets when it is refilled.
    assert!(truths[LOST.0].last.iter().all(|x| x.is_finite()));
    in_lanes(&robot, &model, &groups, &truths);
}

/// The narrowest and the usual instruction set of x86-64: every instance of the step takes the compiler a minute or more,
/// so SSE4.2, AVX-512 and sixteen lanes are left to the benchmarks of lanes.
#[cfg(target_arch = "x86_64")]
fn in_lanes(robot: &Robot, model: &Model<f32>, groups: &[Vec<ServoRange>; 9], truths: &[Truth]) {
    use farsa_num::fearless_simd::Simd;
    if let Some(simd) = Level::new().as_sse2() {
        simd.vectorize(
            #[inline(always)]
            || together::<f32x8<_>>(simd, "SSE2", robot, model, groups, truths),
        );
    }
    if let Some(simd) = Level::new().as_avx2() {
        simd.vectorize(
            #[inline(always)]
            || together::<f32x8<_>>(simd, "AVX2", robot, model, groups, truths),
        );
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn in_lanes(robot: &Robot, model: &Model<f32>, groups: &[Vec<ServoRange>; 9], truths: &[Truth]) {
    farsa_num::fearless_simd::dispatch!(Level::new(), simd => together::<f32x8<_>>(simd, "8", robot, model, groups, truths));
}
