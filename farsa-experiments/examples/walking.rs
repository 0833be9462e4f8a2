//! How the rigid-body walker of `passive-walker` goes to the simplest walking model as its feet lose their mass:
//! `cargo run --release -p farsa-experiments --example walking`, some minutes; with `quick` one row, in seconds.
//!
//! Lengths are in legs, masses in hips, times in sqrt(leg length / gravity).

use farsa_body::World as _;
use farsa_experiments::Job;
use farsa_experiments::Life as _;
use farsa_experiments::WalkingModel;
use farsa_experiments::passive_walker::{Config, Launch, Legs, Rules, Walk, Walker, WalkerLife};

/// Damping ratio of the contacts.
const DAMPING: f64 = 10.0;
/// Steps that a walk settles in and is then measured over: the pace is the mean of the last ten.
const STEPS: u32 = 24;

/// Angle, rate and period of a walk that has settled; `None` for a fall.
fn pace(slope: f64, foot_mass: f64, stiffness: f64, start: [f64; 2]) -> Option<[f64; 3]> {
    let frequency = stiffness.sqrt();
    // Two and a half steps within the shortest time of a contact.
    let time_step = 0.4 / (2.0 * DAMPING * frequency);
    let rules = Rules { settling: 10.0 / frequency, ..Rules::default() };
    let legs = Legs { length: 1.0, mass: 0.0, foot_mass, foot_radius: 1e-5 };
    let config = Config {
        trials: 1,
        substeps: 1,
        walk: Walk { slope, gravity: 1.0, time_step, steps: u32::MAX, noise: 0.0, rules },
        walker: Walker {
            legs: [legs; 2],
            hip_mass: 1.0,
            friction: 2.0,
            stiffness,
            damping_ratio: DAMPING,
            ..Walker::default()
        },
    };
    let (mut world, parts) = config.world().ok()?;
    // The swing leg starts as the walking model's.
    let [angle, rate] = start;
    let launch = Launch { angles: [angle, -angle], rates: [rate, rate * (2.0 * angle).cos()] };
    let mut life = WalkerLife::new(config.walker, parts, config.walk, launch, None);
    life.start(&mut world, Job::default());
    loop {
        world.step();
        if life.judge(&mut world).is_some() {
            return None;
        }
        if life.gait().steps() == STEPS && life.gait().footfalls()[1].rate.is_some() {
            let pace = life.pace()?;
            return Some([pace.angle, pace.rate, pace.period]);
        }
    }
}

/// The value at 0 of the polynomial through these points, by Neville's scheme.
fn at_zero(x: &[f64], y: &[f64]) -> f64 {
    let mut values = y.to_vec();
    for width in 1..x.len() {
        for i in 0..x.len() - width {
            let (a, b) = (x[i], x[i + width]);
            values[i] = (b * values[i] - a * values[i + 1]) / (b - a);
        }
    }
    values[0]
}

fn row(name: &str, found: [f64; 3], known: [f64; 3]) {
    let cells: Vec<String> =
        (0..3).map(|k| format!("{:.5} | {:+.3} %", found[k], 100.0 * (found[k] / known[k] - 1.0))).collect();
    println!("| {name} | {} |", cells.join(" | "));
}

fn main() {
    let quick = std::env::args().any(|word| word == "quick");
    let slopes: &[f64] = if quick { &[0.009] } else { &[0.004, 0.009, 0.014] };
    let masses: &[f64] = if quick { &[0.001] } else { &[0.001, 0.003, 0.01, 0.03, 0.1] };
    let stiffnesses: &[f64] = if quick { &[1e4] } else { &[1e5, 4e5] };
    for &slope in slopes {
        let gait = WalkingModel::new(slope).expect("a slope").gait().expect("a gait");
        let known = [gait.angle, gait.rate, gait.period];
        for &stiffness in stiffnesses {
            println!("\nslope {slope}, stiffness {stiffness:.0e}\n");
            println!("| feet/hip | theta* | off | theta'* | off | period | off |\n|---|---|---|---|---|---|---|");
            let mut start = [gait.angle, gait.rate];
            let (mut walked, mut found): (Vec<f64>, [Vec<f64>; 3]) = Default::default();
            for &mass in masses {
                let Some(pace) = pace(slope, mass, stiffness, start) else {
                    println!("| {mass} | fell | | | | | |");
                    break;
                };
                row(&mass.to_string(), pace, known);
                // Heavier feet start from the gait of the lighter ones.
                start = [pace[0], pace[1]];
                walked.push(mass);
                (0..3).for_each(|k| found[k].push(pace[k]));
            }
            row("0, by a polynomial", [0, 1, 2].map(|k| at_zero(&walked, &found[k])), known);
            row("model", known, known);
        }
    }
}
