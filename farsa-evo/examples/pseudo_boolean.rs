//! `OneMax`, `LeadingOnes` and deceptive traps on 100 bits: the evaluations that the searches over integer genes take to the optimum.
//!
//! `cargo run --release -p farsa-evo --example pseudo_boolean` prints the table of docs/results/strategies.md: medians of 20
//! seeds, next to the expected times of the (1+1) evolutionary algorithm \[Droste2002\], \[Boettcher2010\]. The traps are
//! those of \[Deb1993\].

use farsa_evo::words::{GaConfig, Mutation, OnePlusOne, OnePlusOneConfig, TruncationGa};
use farsa_evo::{EvoError, Strategy};

/// Bits, one gene each.
const BITS: usize = 100;
/// Bits of a trap.
const TRAP: usize = 5;
const SEEDS: u64 = 20;
/// Evaluations after which a search has failed.
const MOST: usize = 200_000;

/// A function of bits, and its largest value.
struct Problem {
    name: &'static str,
    value: fn(&[u16]) -> usize,
    /// The expected number of evaluations of the (1+1) evolutionary algorithm.
    expected: &'static str,
}

const PROBLEMS: [Problem; 3] = [
    Problem { name: "OneMax", value: one_max, expected: "about e n ln n = 1252" },
    Problem { name: "LeadingOnes", value: leading_ones, expected: "about 0.86 n^2 = 8600" },
    Problem { name: "20 traps of 5 bits", value: traps, expected: "more than n^5 = 10^10" },
];

/// Counts the ones.
fn one_max(bits: &[u16]) -> usize {
    bits.iter().filter(|bit| **bit == 1).count()
}

/// Counts the ones in front of the first zero.
fn leading_ones(bits: &[u16]) -> usize {
    bits.iter().take_while(|bit| **bit == 1).count()
}

/// A trap of ones is worth its bits, any other trap one less than its zeros. Hill climbing therefore ends at all zeros.
fn traps(bits: &[u16]) -> usize {
    let value = |trap: &[u16]| match one_max(trap) {
        TRAP => TRAP,
        ones => TRAP - 1 - ones,
    };
    bits.chunks(TRAP).map(value).sum()
}

/// Returns the evaluations up to the first optimum, or the budget, and the best value. The first `copies` individuals of
/// each generation need no evaluation.
fn search(mut strategy: impl Strategy, copies: usize, value: fn(&[u16]) -> usize) -> Result<(usize, usize), EvoError> {
    let (mut evaluations, mut best) = (0, 0);
    loop {
        let values: Vec<usize> = strategy.ask().iter().map(value).collect();
        let first = if strategy.generation() == 0 { 0 } else { copies };
        for value in &values[first..] {
            evaluations += 1;
            best = best.max(*value);
            if best == BITS || evaluations == MOST {
                return Ok((evaluations, best));
            }
        }
        strategy.tell_values(&values.iter().map(|value| *value as f64).collect::<Vec<_>>())?;
    }
}

/// Prints the solved runs and the medians over all seeds of evaluations and best value.
fn row(name: &str, problem: &Problem, run: impl Fn(u64) -> Result<(usize, usize), EvoError>) -> Result<(), EvoError> {
    let runs = (1..=SEEDS).map(run).collect::<Result<Vec<_>, _>>()?;
    let solved = runs.iter().filter(|(_, best)| *best == BITS).count();
    let median = |mut values: Vec<usize>| {
        values.sort_unstable();
        let [low, high] = [values.len() / 2 - 1, values.len() / 2].map(|place| values[place] as f64);
        0.5 * (low + high)
    };
    let evaluations = median(runs.iter().map(|run| run.0).collect());
    let best = median(runs.iter().map(|run| run.1).collect());
    let evaluations = if solved > 10 { format!("{evaluations:.0}") } else { "-".into() };
    println!("| {} | {name} | {solved} | {evaluations} | {best:.0} | {} |", problem.name, problem.expected);
    Ok(())
}

fn main() -> Result<(), EvoError> {
    println!("| function | search | solved | evaluations | best value | (1+1), theory |");
    println!("|---|---|---|---|---|---|");
    let rate = 1.0 / BITS as f64;
    for problem in &PROBLEMS {
        let config =
            OnePlusOneConfig { gene_bits: 1, first_rate: rate, last_rate: rate, ..OnePlusOneConfig::new(BITS) };
        row("`OnePlusOne`", problem, |seed| search(OnePlusOne::new(config, seed)?, 1, problem.value))?;
        let config = GaConfig { gene_bits: 1, mutation_rate: rate, mutation: Mutation::Flip, ..GaConfig::new(BITS) };
        row("`TruncationGa`, 20 of 100", problem, |seed| search(TruncationGa::new(config, seed)?, 0, problem.value))?;
    }
    Ok(())
}
