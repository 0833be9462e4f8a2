//! Evolution by ask and tell on a toy: the minimum of a function of eight variables with many local ones.
//!
//! `cargo run --example 05_evolve_a_function [generations]`

use std::error::Error;

use farsa::evo::words::{GaConfig, GeneRange, RandomSearch, TruncationGa, decode};
use farsa::evo::{EvoError, Fitness, Population, Record, Statistics, Strategy};
use farsa::num::sin_cos;

const VARIABLES: usize = 8;

/// Rastrigin's function, negated: 0 at the origin, a local maximum near every point of whole numbers.
fn fitness(x: &[f32; VARIABLES]) -> Fitness {
    let mut sum = 0.0;
    for x in x {
        let x = f64::from(*x);
        sum += 10.0 + x * x - 10.0 * sin_cos(std::f64::consts::TAU * x).1;
    }
    Fitness::nan_as_failed(-sum)
}

fn evaluate(genomes: &Population, ranges: &[GeneRange]) -> Result<Vec<Fitness>, EvoError> {
    let mut x = [0.0; VARIABLES];
    genomes.iter().map(|genes| decode(genes, ranges, &mut x).map(|()| fitness(&x))).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let generations: u32 = std::env::args().nth(1).map_or(Ok(300), |text| text.parse())?;
    let ranges = [GeneRange::new(VARIABLES, -5.12, 5.12)?];

    // The best 20 of 100 make five copies each, four of them mutated. For comparison, the same number of random genomes.
    let fresh = || TruncationGa::new(GaConfig::new(VARIABLES), 1);
    let mut evolution = fresh()?;
    let mut record = Record::new(&mut evolution)?;
    let mut guesses = RandomSearch::new(VARIABLES, 100, 1)?;
    let mut guessed = f64::NEG_INFINITY;
    let mut last = None;
    for generation in 0..generations {
        let values = evaluate(evolution.ask(), &ranges)?;
        record.tell(&mut evolution, &values)?;
        let random = evaluate(guesses.ask(), &ranges)?;
        guesses.tell(&random)?;
        let summary = Statistics::from_fitness(&values).ok_or(EvoError::NoBest { generation: 0 })?;
        guessed = Statistics::from_fitness(&random).map_or(guessed, |random| guessed.max(random.best));
        if generation % generations.div_ceil(10) == 0 || generation + 1 == generations {
            println!(
                "generation {generation:>4}: best {:>8.3}, mean {:>8.3}; best of as many guesses {guessed:>8.3}",
                summary.best, summary.mean
            );
        }
        last = Some(summary);
    }

    let summary = last.ok_or("no generations")?;
    // The record rebuilds any generation without evaluating anything.
    let rebuilt = record.genomes(&mut fresh()?, generations - 1)?;
    let champion = rebuilt.get(summary.best_index).ok_or(EvoError::NoBest { generation: 0 })?;
    let mut x = [0.0; VARIABLES];
    decode(champion, &ranges, &mut x)?;
    println!("the champion stands at {x:.3?}");
    assert_eq!(fitness(&x).get(), summary.best, "the genome is rebuilt exactly");
    assert!(generations < 50 || summary.best > guessed, "selection is worth something");
    Ok(())
}
