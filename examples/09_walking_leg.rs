//! A central pattern generator for a leg: three continuous-time neurons evolve to walk without a sensor.
//!
//! `cargo run --example 09_walking_leg [generations]`

use std::error::Error;
use std::f64::consts::FRAC_PI_6;

use farsa::evo::words::{GaConfig, GeneRange, TruncationGa, decode};
use farsa::evo::{EvoError, Fitness, Statistics, Strategy};
use farsa::nn::{Controller, Ctrnn, CtrnnLayout};
use farsa::num::{atan2, sin_cos};

/// Foot, push forward, push backward, without inputs.
const LAYOUT: CtrnnLayout = CtrnnLayout::new(0, 3, 3);
const STEP: f64 = 0.1;
const STEPS: u32 = 2500;

/// A body on one leg in stance or swing. \[Beer1999\]
#[derive(Default)]
struct Walker {
    place: f64,
    velocity: f64,
    /// Position of the foot: along the ground, and below the hip.
    foot: Option<[f64; 2]>,
    /// Angle of the leg, from straight down to the front \[rad\].
    angle: f64,
    turning: f64,
}

impl Walker {
    const LEG: f64 = 15.0;
    const FORCE: f64 = 0.05;
    const TORQUE: f64 = 0.5;
    /// The largest distance of the body ahead of its foot. Beyond it the body stops.
    const REACH: f64 = 20.0;

    /// Advances by outputs in [0, 1]. The foot is down from 1/2 on. Else the body stops and a backward push swings the leg forward.
    fn step(&mut self, [foot, forwards, backwards]: [f64; 3]) {
        let force = Self::FORCE * (forwards - backwards);
        if foot > 0.5 {
            let (sine, cosine) = sin_cos(self.angle);
            let [foot, height] = *self.foot.get_or_insert([self.place + Self::LEG * sine, Self::LEG * cosine]);
            // Outside its range the leg pushes only back into it.
            let pushes = self.angle.abs() <= FRAC_PI_6 || (self.angle < 0.0) == (force < 0.0);
            self.velocity = (self.velocity + if pushes { STEP * force } else { 0.0 }).clamp(-6.0, 6.0);
            self.place += STEP * self.velocity;
            (self.angle, self.turning) = (atan2(foot - self.place, height), 0.0);
            self.velocity = if self.place - foot > Self::REACH { 0.0 } else { self.velocity };
        } else {
            (self.foot, self.velocity) = (None, 0.0);
            self.turning = (self.turning - STEP * Self::TORQUE * force).clamp(-1.0, 1.0);
            let turned = self.angle + STEP * self.turning;
            self.angle = turned.clamp(-FRAC_PI_6, FRAC_PI_6);
            self.turning = if self.angle == turned { self.turning } else { 0.0 };
        }
    }

    /// Walks from rest and returns the mean velocity and how often the foot came down.
    fn walk(steps: u32, mut outputs: impl FnMut(&Self) -> [f64; 3]) -> (f64, u32) {
        let mut walker = Self { angle: FRAC_PI_6, ..Self::default() };
        let mut footfalls = 0;
        for _ in 0..steps {
            let (up, outputs) = (walker.foot.is_none(), outputs(&walker));
            walker.step(outputs);
            footfalls += u32::from(up && walker.foot.is_some());
        }
        (walker.place / (f64::from(steps) * STEP), footfalls)
    }
}

/// The optimal outputs: push to the end of the leg's range, glide to the end of its reach, swing at full force.
fn optimal(walker: &Walker) -> [f64; 3] {
    match walker.foot {
        Some([foot, _]) if walker.place - foot <= Walker::REACH => [1.0, 1.0, 0.0],
        None if walker.angle >= FRAC_PI_6 => [1.0, 1.0, 0.0],
        _ => [0.0, 0.0, 1.0],
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let generations: u32 = std::env::args().nth(1).map_or(Ok(120), |text| text.parse())?;
    // Weights, offsets from the center-crossing biases, time constants.
    let ranges = [GeneRange::new(9, -16.0, 16.0)?, GeneRange::new(3, -4.0, 4.0)?, GeneRange::new(3, 0.5, 10.0)?];
    let mut network = Ctrnn::new(LAYOUT, STEP as f32, [1.0; LAYOUT.parameter_count()], [0.0; LAYOUT.state_len()])?;
    let mut walk = |genes: &[u16]| -> Result<(f64, u32), Box<dyn Error>> {
        let (mut values, mut parameters) = ([0.0; 15], [1.0; LAYOUT.parameter_count()]);
        decode(genes, &ranges, &mut values)?;
        let (weights, others) = values.split_at(9);
        for i in 0..3 {
            parameters[9 + i] = others[i] - 0.5 * weights.iter().skip(i).step_by(3).sum::<f32>();
        }
        parameters[..9].copy_from_slice(weights);
        parameters[15..].copy_from_slice(&others[3..]);
        network.copy_parameters(&parameters)?;
        network.reset();
        let mut y = [0.0; 3];
        Ok(Walker::walk(STEPS, |_| {
            network.step(&[], &mut y);
            y.map(f64::from)
        }))
    };
    let best = Walker::walk(200_000, optimal).0;
    println!("the best possible mean velocity of this body is {best:.3}");
    // Closed form: 15 at an acceleration of 0.05, then 12.5 at constant velocity, and a turn of pi/3 at 0.025.
    assert!((best - 27.5 / (24.495 + 10.206 + 9.153)).abs() < 5e-3);
    let mut evolution = TruncationGa::new(GaConfig::new(15), 1)?;
    for generation in 0..generations {
        let walks: Result<Vec<_>, _> = evolution.ask().iter().map(&mut walk).collect();
        let fitness: Vec<Fitness> = walks?.iter().map(|(velocity, _)| Fitness::nan_as_failed(*velocity)).collect();
        let summary = Statistics::from_fitness(&fitness).ok_or(EvoError::NoBest { generation: 0 })?;
        if generation % generations.div_ceil(8) == 0 || generation + 1 == generations {
            let (velocity, footfalls) = walk(evolution.ask().get(summary.best_index).unwrap_or_default())?;
            println!("generation {generation:>3}: mean velocity {velocity:.3}, {footfalls} footfalls");
            let walks = velocity > 0.45 && footfalls >= 4 && velocity <= best;
            assert!(walks || generation + 1 < generations || generations < 100, "it does not walk");
        }
        evolution.tell(&fitness)?;
    }
    Ok(())
}
