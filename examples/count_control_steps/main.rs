//! A fixed amount of work for counting instructions: `./ci callgrind` runs each case and counts within `measured`.
//!
//! `cargo run --release --example count_control_steps CASE`: free, grasp, free8, grasp8, aba7, aba27, network, muscles, trial,
//! recorded, adapter and direct, or rapier, which times both.

mod adapter;
#[path = "../../benches/scene/mod.rs"]
mod scene;

use std::error::Error;
use std::hint::black_box;

use farsa::nn::{Controller, LeakyLayout};
use farsa::physics::articulated::Batch;
use farsa_experiments::reach_grasp_lift::{Config, evaluator};
use farsa_lab::advanced::Genotype;
use farsa_lab::{EpisodeId, Evaluation, Evaluator as _, Task as _};
use farsa_view::Recording;
use scene::{Aba, Lanes, Loop};

/// Repetitions of every case. Counts are divided by it.
const TIMES: usize = 100;

/// The function whose instructions are counted, with what it calls.
#[inline(never)]
fn measured(mut once: impl FnMut()) {
    for _ in 0..TIMES {
        once();
    }
}

/// The same for what repeats itself.
#[inline(never)]
fn measured_once(once: impl FnOnce()) {
    once();
}

fn main() -> Result<(), Box<dyn Error>> {
    let case = std::env::args().nth(1).unwrap_or_else(|| "free".into());
    match case.as_str() {
        "free" | "grasp" => {
            let mut whole = if case == "free" { Loop::free()? } else { Loop::grasp()? };
            println!("{case}: {}", whole.contacts());
            measured(|| whole.control_step());
        }
        "free8" | "grasp8" => {
            // valgrind runs AVX2, not AVX-512.
            let instructions = Batch::instructions().take(2).last().ok_or("no instructions")?;
            let made = if case == "free8" { Loop::free } else { Loop::grasp };
            let mut together = Lanes::new(made, 8, instructions)?;
            measured(|| together.control_step());
        }
        "aba7" | "aba27" => {
            let mut aba = Aba::new(if case == "aba7" { 7 } else { 27 })?;
            measured(|| {
                black_box(aba.accelerations());
            });
        }
        "trial" | "recorded" => {
            let mut evaluator = evaluator(Config { steps: 6 * TIMES as u32, ..Config::default() })?;
            let genotype = Genotype::new(&evaluator.info().parameters, 16);
            let genes: Vec<u16> = (0..genotype.genes() as u32).map(|i| (i * 40503) as u16).collect();
            let parameters = genotype.decode(&genes).ok_or("other genes")?;
            let evaluation = Evaluation::new(&parameters, EpisodeId::default());
            let mut recording = Recording::new(evaluator.info().schema);
            let recorded = case == "recorded";
            // One episode of as many steps as the other cases have repetitions.
            measured_once(|| {
                if recorded {
                    evaluator.evaluate(evaluation, Some(&mut recording));
                } else {
                    evaluator.evaluate(evaluation, None);
                }
            });
            assert_eq!(recording.times().len(), if recorded { 6 * TIMES } else { 0 });
        }
        "network" => {
            let mut network = scene::network(LeakyLayout::new(29, 12, 23))?;
            let (x, mut y) = ([0.5; 29], [0.0; 23]);
            measured(|| network.step(black_box(&x), &mut y));
        }
        "muscles" => {
            let pair = scene::muscles()?;
            measured(|| {
                black_box(pair.effort(black_box(0.3_f32), black_box(-0.2), black_box([0.4, 0.1])));
            });
        }
        "adapter" | "direct" | "rapier" => return adapter::compare(&case),
        other => return Err(format!("no case {other}").into()),
    }
    println!("{case}: {TIMES} times");
    Ok(())
}
