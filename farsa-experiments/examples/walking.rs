//! The rigid-body walker of `passive-walker` approaches the simplest walking model as its feet lose their mass. `cargo run
//! --release -p farsa-experiments --example walking` takes some minutes. With `quick` it prints one row, in seconds.
//!
//! Lengths are in legs, masses in hips, times in sqrt(leg length / gravity).

use farsa_body::ports::World as _;
use farsa_experiments::walking::WalkingModel;
use farsa_experiments::walking::passive_walker::{Config, Launch, Legs, Rules, Walk, Walker, WalkerEpisode};
use farsa_lab::{Episode as _, EpisodeId};
use farsa_num::Scalar;
use farsa_physics::articulated::World;

/// Damping ratio of the contacts.
const DAMPING: f64 = 10.0;
/// Steps that a walk settles in and is then measured over: the pace is the mean of the last ten.
const STEPS: u32 = 20;

/// Angle, both legs' rates and period of a walk that has settled, or the reason for no such walk.
fn pace(slope: f64, foot_mass: f64, stiffness: f64, [angle, rate, swing]: [f64; 3]) -> Result<[f64; 4], &'static str> {
    let frequency = Scalar::sqrt(stiffness);
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
        ..Config::default()
    };
    let (model, parts) = config.model::<f64>().map_err(|_| "no such body")?;
    let mut world = World::new(model);
    let launch = Launch { angles: [angle, -angle], rates: [rate, swing] };
    let mut episode = WalkerEpisode::new(config.walker, parts, config.walk, launch, None);
    episode.start(&mut world, EpisodeId::default());
    let mut periods = [0.0; 2];
    loop {
        world.step();
        let before = episode.gait().steps();
        if episode.judge(&mut world).is_some() {
            return Err("falls");
        }
        let [last, now] = episode.gait().footfalls();
        if episode.gait().steps() > before {
            periods = [periods[1], now.time - last.time];
        }
        if episode.gait().steps() == STEPS && now.rates.is_some() {
            let pace = episode.pace().ok_or("too few steps")?;
            // A walk whose steps alternate between longer and shorter ones is another gait than the model's.
            let alike = (periods[0] / periods[1] - 1.0).abs() < 0.01;
            return if alike { Ok([pace.angle, pace.rate, pace.swing_rate, pace.period]) } else { Err("limps") };
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
    let slopes: &[f64] = if quick { &[0.009] } else { &[0.009, 0.004, 0.014] };
    let masses: &[f64] = if quick { &[0.001] } else { &[0.001, 0.003, 0.01, 0.03, 0.1] };
    let stiffnesses: &[f64] = if quick { &[3e4] } else { &[4e5, 1.6e6] };
    for &slope in slopes {
        let gait = WalkingModel::new(slope).expect("a slope").gait().expect("a gait");
        let known = [gait.angle, gait.rate, gait.period];
        for &stiffness in stiffnesses {
            println!("\nslope {slope}, stiffness {stiffness:e}\n");
            println!("| feet/hip | theta* | off | theta'* | off | period | off |\n|---|---|---|---|---|---|---|");
            let mut start = [gait.angle, gait.rate, gait.rate - gait.swing_rate];
            let (mut walked, mut found): (Vec<f64>, [Vec<f64>; 4]) = Default::default();
            for (i, &mass) in masses.iter().enumerate() {
                let pace = match pace(slope, mass, stiffness, start) {
                    Ok(pace) => pace,
                    Err(why) => {
                        println!("| {mass} | {why} | | | | | |");
                        break;
                    }
                };
                row(&mass.to_string(), [pace[0], pace[1], pace[3]], known);
                walked.push(mass);
                (0..4).for_each(|k| found[k].push(pace[k]));
                // Heavier feet start where a straight line through the gaits of the last two masses points.
                let ahead = |k: usize| match (found[k].as_slice(), walked.as_slice(), masses.get(i + 1)) {
                    ([.., a, b], [.., x, y], Some(next)) => b + (b - a) * (next - y) / (y - x),
                    _ => pace[k],
                };
                start = [ahead(0), ahead(1), ahead(2)];
            }
            row("0, by a polynomial", [0, 1, 3].map(|k: usize| at_zero(&walked, &found[k])), known);
            row("model", known, known);
        }
    }
}
