//! One leaky neuron answers to a step: how fast, and what the three readings of its leak make of it.
//!
//! `cargo run --example 01_one_neuron [ticks]`

use std::error::Error;

use farsa::nn::{Controller, Leak, LeakyLayout, LeakyNetwork};

/// One sensor, one hidden neuron, one output.
const LAYOUT: LeakyLayout = LeakyLayout::new(1, 1, 1);

/// Weight of the sensor, of the neuron on itself and on the output, bias, and the leak, which weights the new value.
static PARAMETERS: [f32; LAYOUT.parameter_count()] = [6.0, 0.0, 6.0, 0.0, 0.1];

fn main() -> Result<(), Box<dyn Error>> {
    let ticks: usize = std::env::args().nth(1).map_or(Ok(60), |text| text.parse())?;
    let mut responses = Vec::new();
    for leak in Leak::ALL {
        let mut neuron = LeakyNetwork::new(LAYOUT, leak, &PARAMETERS, [0.0; LAYOUT.state_len()])?;
        let mut output = [0.0];
        let response: Vec<f32> = (0..ticks)
            .map(|_| {
                neuron.step(&[1.0], &mut output);
                neuron.hidden()[0]
            })
            .collect();
        responses.push(response);
    }

    println!("activation after a step of the sensor from 0 to 1, leak 0.1");
    println!("{:>10} {:>8} {:>8} {:>8}", "time [ms]", Leak::ALL[0], Leak::ALL[1], Leak::ALL[2]);
    for tick in (0..ticks).step_by(ticks.div_ceil(12)) {
        print!("{:>10}", 10 * (tick + 1));
        for response in &responses {
            print!(" {:>8.4}", response[tick]);
        }
        println!();
    }

    // The filter is a first-order low pass: H(t) = y (1 - 0.9^t), with y = 1 / (1 + exp(-0.2 * 6)).
    let y = farsa::num::logistic(0.2_f32 * 6.0);
    let mut left = 1.0_f32;
    for (tick, activation) in responses[0].iter().enumerate() {
        left *= 0.9;
        assert!((activation - y * (1.0 - left)).abs() < 1e-6, "tick {tick}: {activation}");
    }
    println!("the filter rises to {y:.4} with a time constant of {:.0} ms", -10.0 / farsa::num::ln(0.9_f32));
    Ok(())
}
