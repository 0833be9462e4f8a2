//! The network of the manipulation experiment, 29-12-23, from the bits of a random genome.
//!
//! `cargo run --example 02_network_from_a_genome [seed]`

use std::error::Error;

use farsa::evo::words::{GeneRange, decode, randomize};
use farsa::nn::{Controller, Leak, LeakyLayout, LeakyNetwork, LeakyParameter};
use farsa::num::{Domain, Stream};

/// 29 sensors, 12 hidden neurons, 23 motors.
const LAYOUT: LeakyLayout = LeakyLayout::new(29, 12, 23);

fn main() -> Result<(), Box<dyn Error>> {
    let seed: u64 = std::env::args().nth(1).map_or(Ok(1), |text| text.parse())?;

    // A genome: 16 bits for each parameter, drawn from the stream of individual 0 in generation 0.
    let mut genome = [0_u16; LAYOUT.parameter_count()];
    randomize(&mut genome, &mut Stream::new(seed, Domain::InitialGenome, 0, 0, 0));

    // Genes decode to weights and biases in [-6, 6] and leaks in [0, 1].
    let mut ranges = Vec::new();
    for kind in LeakyParameter::ALL {
        let (low, high) = if kind == LeakyParameter::Leak { (0.0, 1.0) } else { (-6.0, 6.0) };
        let count = LAYOUT.range(kind).len();
        println!("{count:>4} x {kind:?} in [{low}, {high}]");
        ranges.push(GeneRange::new(count, low, high)?);
    }
    let mut parameters = [0.0; LAYOUT.parameter_count()];
    decode(&genome, &ranges, &mut parameters)?;
    println!("{} parameters, {} bits, seed {seed}", parameters.len(), 16 * genome.len());

    // The network borrows its parameters and has no heap.
    let mut network = LeakyNetwork::new(LAYOUT, Leak::Filter, &parameters[..], [0.0; LAYOUT.state_len()])?;
    let mut x = [0.5; 29];
    let mut y = [0.0; 23];
    let (mut low, mut high) = (y, [0.0_f32; 23]);
    low.fill(1.0);
    for tick in 0..600 {
        // An elbow that swings once a second.
        x[3] = 0.5 + 0.5 * farsa::num::sin_cos(std::f32::consts::TAU * tick as f32 / 100.0).0;
        network.step(&x, &mut y);
        for i in 0..y.len() {
            low[i] = low[i].min(y[i]);
            high[i] = high[i].max(y[i]);
        }
    }
    println!("hidden neurons after 6 s: {:.3?}", network.hidden());
    println!("the first muscle's activation ranged over [{:.3}, {:.3}]", low[0], high[0]);
    assert!(low.iter().all(|y| *y >= 0.0) && high.iter().all(|y| *y <= 1.0), "outputs are in [0, 1]");
    assert!((0..23).any(|i| high[i] > low[i]), "the outputs follow the elbow");
    Ok(())
}
