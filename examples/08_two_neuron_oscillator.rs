//! Two continuous-time neurons that oscillate: their period by three integrators, and what makes the oscillation go.
//!
//! `cargo run --example 08_two_neuron_oscillator`

use std::error::Error;

use farsa::nn::{Controller, Ctrnn, CtrnnLayout, Integrator};
use farsa::num::logistic;

const LAYOUT: CtrnnLayout = CtrnnLayout::new(0, 2, 2);

/// Each neuron excites itself. The first inhibits the second, and the second excites the first \[Beer1995\]. From j to i at 2 j + i.
const WEIGHTS: [f32; 4] = [4.5, -1.0, 1.0, 4.5];
/// The biases of the source.
const BIASES: [f32; 2] = [-2.75, -1.75];

/// Simulated time, the second half of which is measured.
const TIME: f64 = 400.0;

/// The middle of every neuron's range where its inputs are at the middle of theirs: minus half the sum of the weights into it.
fn centre_crossing() -> [f32; 2] {
    [0, 1].map(|i| -0.5 * (WEIGHTS[i] + WEIGHTS[2 + i]))
}

/// Returns the mean time between rises of a signal through 0 in its second half, or `None` with fewer than two rises.
fn period(signal: impl Iterator<Item = f64>, time_step: f64) -> Option<f64> {
    let (mut before, mut rises) = (0.0, Vec::new());
    for (step, value) in signal.enumerate() {
        let time = step as f64 * time_step;
        if before < 0.0 && value >= 0.0 && time > 0.5 * TIME {
            rises.push(time - time_step * value / (value - before));
        }
        before = value;
    }
    let [first, .., last] = rises[..] else { return None };
    Some((last - first) / (rises.len() - 1) as f64)
}

/// The state of the first neuron above minus its bias, step by step.
fn simulate(integrator: Integrator, time_step: f32, biases: [f32; 2]) -> Result<Vec<f64>, farsa::nn::Error> {
    let mut parameters = [1.0; LAYOUT.parameter_count()];
    parameters[..4].copy_from_slice(&WEIGHTS);
    parameters[4..6].copy_from_slice(&biases);
    let layout = LAYOUT.with_integrator(integrator);
    let mut network = Ctrnn::new(layout, time_step, parameters, vec![0.0; layout.state_len()])?;
    let steps = (TIME / f64::from(time_step)) as usize;
    let mut y = [0.0; 2];
    let step = |_| {
        network.step(&[], &mut y);
        f64::from(network.states()[0] + biases[0])
    };
    Ok((0..steps).map(step).collect())
}

/// The same in double precision by the classical method of Runge and Kutta at a small step, written out.
fn reference(biases: [f32; 2]) -> Vec<f64> {
    const STEP: f64 = 0.001;
    let (w, b) = (WEIGHTS.map(f64::from), biases.map(f64::from));
    let slope = |y: [f64; 2]| {
        let o = [logistic(y[0] + b[0]), logistic(y[1] + b[1])];
        [0, 1].map(|i| -y[i] + w[i] * o[0] + w[2 + i] * o[1])
    };
    let ahead = |y: [f64; 2], k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
    let mut y = [0.0; 2];
    let step = |_| {
        let k1 = slope(y);
        let k2 = slope(ahead(y, k1, 0.5 * STEP));
        let k3 = slope(ahead(y, k2, 0.5 * STEP));
        let k4 = slope(ahead(y, k3, STEP));
        let k = [0, 1].map(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0);
        y = ahead(y, k, STEP);
        y[0] + b[0]
    };
    (0..(TIME / STEP) as usize).map(step).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("biases of the source {BIASES:?}, centre-crossing biases {:?}", centre_crossing());
    assert_eq!(BIASES, centre_crossing(), "the source's oscillator is a centre-crossing one");

    let known = period(reference(BIASES).into_iter(), 0.001).ok_or("the reference does not oscillate")?;
    println!("period {known:.6} by Runge-Kutta in double precision at a step of 0.001");
    println!("{:>18} {:>8} {:>12} {:>10}", "integrator", "step", "period", "off by");
    for (integrator, order) in [(Integrator::Euler, 1), (Integrator::ExponentialEuler, 1), (Integrator::RungeKutta4, 4)]
    {
        let mut off = Vec::new();
        for time_step in [0.2_f32, 0.1, 0.05] {
            let signal = simulate(integrator, time_step, BIASES)?.into_iter();
            let found = period(signal, time_step.into()).ok_or("it does not oscillate")?;
            off.push((found / known - 1.0).abs());
            let percent = 100.0 * (found / known - 1.0);
            println!("{:>18} {time_step:>8} {found:>12.5} {percent:>8.4} %", format!("{integrator:?}"));
        }
        let falls = off[0] > 1.5 * off[1] && off[1] > 1.5 * off[2];
        assert!(if order == 1 { falls } else { off[2] < 2e-4 }, "{integrator:?}: {off:?}");
    }

    // Away from the centre one neuron is saturated and nothing turns.
    let shifted = BIASES.map(|bias| bias + 1.0);
    let at_rest = simulate(Integrator::RungeKutta4, 0.05, shifted)?;
    let tail = &at_rest[at_rest.len() / 2..];
    let range = tail.iter().fold([f64::MAX, f64::MIN], |[low, high], y| [low.min(*y), high.max(*y)]);
    println!("with biases {shifted:?} the first neuron comes to rest: it moves by {:.1e}", range[1] - range[0]);
    assert!(range[1] - range[0] < 1e-4, "{range:?}");
    Ok(())
}
