//! The phases in many worlds at once, one in a lane, each some steps ahead of its neighbor.

use std::time::Instant;

use farsa::body::ports::World as _;
use farsa::num::Scalar;
use farsa::num::fearless_simd::{Level, Simd, f32x8, f32x16};
use farsa::physics::articulated::{Model, Scratch, World, step};
use farsa_experiments::reach_grasp_lift::Scene;

use crate::phase::{Failure, MUSCLES, Phase, command, model};

/// The control steps by which a lane is ahead of its neighbor.
const AHEAD: usize = 5;

/// Measures microseconds per world and control step: eight lanes at AVX2, sixteen at AVX-512, or nothing where they do
/// not run.
pub(crate) fn time(scene: &Scene, phase: &Phase, substeps: u32, seconds: f64, lanes: &str) -> Result<(), Failure> {
    let model = model::<f32>(scene, substeps, phase.contacts)?;
    match lanes {
        "8" => {
            if let Some(simd) = Level::new().as_avx2() {
                let measured = simd.vectorize(
                    #[inline(always)]
                    || together::<f32x8<_>>(simd, &model, phase, seconds),
                );
                println!("{measured:.4}");
            }
        }
        "16" => {
            if let Some(simd) = Level::new().as_avx512() {
                let measured = simd.vectorize(
                    #[inline(always)]
                    || together::<f32x16<_>>(simd, &model, phase, seconds),
                );
                println!("{measured:.4}");
            }
        }
        _ => return Err("8 or 16 lanes".into()),
    }
    Ok(())
}

/// The state of every lane where it begins: the phase's own, further on for each.
fn begin<S: Scalar<Real = f32>>(simd: S::Simd, model: &Model<f32>, phase: &Phase) -> Vec<S> {
    let mut world = World::new(model.clone());
    phase.place(&mut world);
    let mut state = vec![S::splat(simd, 0.0); model.state_len()];
    for lane in 0..S::LANES {
        for (x, word) in state.iter_mut().zip(world.state()) {
            x.set_lane(lane, *word);
        }
        for words in &phase.commands[AHEAD * lane..AHEAD * (lane + 1)] {
            command(&mut world, words);
            world.step();
        }
    }
    state
}

#[inline(always)]
fn together<S: Scalar<Real = f32>>(simd: S::Simd, model: &Model<f32>, phase: &Phase, seconds: f64) -> f64 {
    let start = begin::<S>(simd, model, phase);
    let mut scratch = Scratch::new(simd, model);
    let commands = model.positions() + model.dofs();
    let ticks = phase.commands.len() - AHEAD * S::LANES;
    // As in one world: the least of a control step's repetitions is its own time.
    let mut least = vec![f64::INFINITY; ticks];
    let begin = Instant::now();
    while begin.elapsed().as_secs_f64() < seconds {
        let mut state = start.clone();
        scratch.forward_kinematics(simd, model, &state);
        for (tick, least) in least.iter_mut().enumerate() {
            let begin = Instant::now();
            for lane in 0..S::LANES {
                for (i, word) in phase.commands[tick + AHEAD * lane].iter().enumerate() {
                    let at = if i < 2 * MUSCLES { i } else { 2 * (i - MUSCLES) };
                    state[commands + at].set_lane(lane, *word);
                }
            }
            step(simd, model, &mut state, &mut scratch);
            *least = least.min(begin.elapsed().as_secs_f64());
        }
    }
    least.iter().sum::<f64>() / (ticks * S::LANES) as f64 * 1e6
}
