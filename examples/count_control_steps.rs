//! A fixed amount of work for counting instructions: `./ci callgrind` runs each case and counts within `measured`.
//!
//! `cargo run --release --example count_control_steps free|grasp|aba7|aba27|network|muscles`

#[path = "../benches/scene/mod.rs"]
mod scene;

use std::error::Error;
use std::hint::black_box;

use farsa::nn::{Controller, Layout};
use scene::{Aba, Loop};

/// Repetitions of every case; counts are divided by it.
const TIMES: usize = 100;

/// The function whose instructions are counted, with what it calls.
#[inline(never)]
fn measured(mut once: impl FnMut()) {
    for _ in 0..TIMES {
        once();
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let case = std::env::args().nth(1).unwrap_or_else(|| "free".into());
    match case.as_str() {
        "free" | "grasp" => {
            let mut whole = if case == "free" { Loop::free()? } else { Loop::grasp()? };
            let [[p0, p1], [n0, n1]] = whole.contacts();
            println!("{case}: {p0} to {p1} pairs touch at {n0} to {n1} points");
            measured(|| whole.control_step());
        }
        "aba7" | "aba27" => {
            let mut aba = Aba::new(if case == "aba7" { 7 } else { 27 })?;
            measured(|| {
                black_box(aba.accelerations());
            });
        }
        "network" => {
            let mut network = scene::network(Layout::new(29, 12, 23))?;
            let (x, mut y) = ([0.5; 29], [0.0; 23]);
            measured(|| network.step(black_box(&x), &mut y));
        }
        "muscles" => {
            let pair = scene::muscles()?;
            measured(|| {
                black_box(pair.effort(black_box(0.3_f32), black_box(-0.2), black_box([0.4, 0.1])));
            });
        }
        other => return Err(format!("no case {other}").into()),
    }
    println!("{case}: {TIMES} times");
    Ok(())
}
