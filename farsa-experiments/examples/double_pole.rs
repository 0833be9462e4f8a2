//! Evaluations until two poles are balanced, by CMA-ES and by `CoSyNE`:
//! `nice cargo run --release -p farsa-experiments --example double_pole -- [--first SEED] [--seeds N] [--threads N] [WORD...]`.
//!
//! Tasks and criteria are those of [Gomez2008] section 5.5. A task is solved when a network of a generation balances both poles for
//! 100 000 steps. With the number of steps as fitness any network counts, with the damping fitness, which is taken over 1000 steps,
//! the best one. All evaluations of that generation count, the test of 100 000 steps does not. Seeds 1 to 100 are reported.
//! Settings were chosen with seeds from 1001 on. Words choose rows by their names.

use std::error::Error;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use farsa_evo::Strategy;
use farsa_evo::coevolution::{Cosyne, CosyneConfig};
use farsa_evo::covariance::{CmaEsConfig, CmaEsRestarts, CmaEsRestartsConfig, RestartSchedule};
use farsa_experiments::double_pole::{CartEpisode, CartState, Config, neuron_order};

/// Evaluations after which a run counts as not solved.
const LIMIT: usize = 20_000;

/// The search.
#[derive(Clone, Copy)]
enum Search {
    /// Covariance matrix adaptation with IPOP restarts: the first step size, in the unit of the weights.
    CmaEs { sigma: f64 },
    /// `CoSyNE` with the values of [Gomez2008], but for the range of the first weights, which is 10 there.
    Cosyne { range: f64 },
}

/// A row of the table.
struct Row {
    name: &'static str,
    config: Config,
    search: Search,
    published: &'static str,
}

/// The rows: task, network and strategy, and what is published for the strategy and the task.
fn rows() -> Vec<Row> {
    let task = |velocities, damping, hidden| Config { damping, hidden, ..Config::new(velocities) };
    let row = |name, config, search, published| Row { name, config, search, published };
    let (cma, cosyne) = (Search::CmaEs { sigma: 0.5 }, |range| Search::Cosyne { range });
    let (sensed, steps, damping) = (task(true, false, 1), task(false, false, 1), task(false, true, 1));
    vec![
        row("velocities, CMA-ES", task(true, false, 0), cma, "895"),
        row("no-velocities by steps, CMA-ES", steps, cma, "3521"),
        row("no-velocities by damping, CMA-ES", damping, cma, "6061"),
        row("velocities, CoSyNE", sensed, cosyne(10.0), "954"),
        row("no-velocities by steps, CoSyNE", steps, cosyne(10.0), "1249"),
        row("no-velocities by damping, CoSyNE", damping, cosyne(10.0), "3416"),
        row("velocities, CoSyNE from 3", sensed, cosyne(3.0), "954"),
        row("no-velocities by steps, CoSyNE from 3", steps, cosyne(3.0), "1249"),
        row("no-velocities by damping, CoSyNE from 3", damping, cosyne(3.0), "3416"),
    ]
}

/// The result of a seed.
struct Solved {
    /// Evaluations, if it was solved.
    evaluations: Option<usize>,
    /// Starts of the 625 in the generalization test from which the network balances for 1000 steps.
    starts: usize,
}

/// A cart that networks of a task are tried on.
struct Bench {
    episode: CartEpisode,
    /// For each gene the parameter that it is.
    order: Vec<usize>,
    parameters: Vec<f32>,
}

impl Bench {
    fn new(config: Config, order: Vec<usize>) -> Result<Self, farsa_lab::Error> {
        let parameters = vec![0.0; order.len()];
        Ok(Self { episode: CartEpisode::new(config, parameters.clone())?, order, parameters })
    }

    /// Runs a trial from the start to its end.
    fn run(&mut self, genes: &[f64], start: CartState) -> &CartEpisode {
        for (&parameter, gene) in self.order.iter().zip(genes) {
            self.parameters[parameter] = *gene as f32;
        }
        self.episode.set_parameters(&self.parameters).unwrap_or_else(|error| unreachable!("{error}"));
        self.episode.place(start);
        while !self.episode.ended() {
            self.episode.step();
        }
        &self.episode
    }
}

/// Searches with a strategy until the task is solved.
fn solve(strategy: &mut dyn Strategy<f64>, config: Config, order: Vec<usize>) -> Result<Solved, Box<dyn Error>> {
    let short = Config { steps: 1000, ..config };
    let mut fitness = Bench::new(if config.damping { short } else { config }, order.clone())?;
    let (mut test, mut starts) = (Bench::new(config, order.clone())?, Bench::new(short, order)?);
    let mut evaluations = 0;
    while evaluations < LIMIT {
        let population = strategy.ask();
        let mut values = Vec::with_capacity(population.len());
        let mut solver = None;
        for genes in population {
            let episode = fitness.run(genes, config.start());
            if config.damping {
                values.push(episode.damping().iter().sum::<f64>());
            } else {
                values.push(f64::from(episode.steps()));
                solver = solver.or(episode.succeeded().then_some(genes));
            }
        }
        evaluations += values.len();
        if config.damping {
            let best = (0..values.len()).rev().max_by(|a, b| values[*a].total_cmp(&values[*b]));
            let best = best.and_then(|best| population.get(best)).unwrap_or_default();
            solver = test.run(best, config.start()).succeeded().then_some(best);
        }
        if let Some(genes) = solver {
            let from = Config::generalization_starts();
            let starts = from.filter(|start| starts.run(genes, *start).succeeded()).count();
            return Ok(Solved { evaluations: Some(evaluations), starts });
        }
        strategy.tell_values(&values)?;
    }
    Ok(Solved { evaluations: None, starts: 0 })
}

/// A row with a seed.
fn one(row: &Row, seed: u64) -> Result<Solved, Box<dyn Error>> {
    let (order, of_a_neuron) = neuron_order(row.config.velocities, row.config.hidden);
    let genes = order.len();
    let mut strategy: Box<dyn Strategy<f64>> = match row.search {
        Search::CmaEs { sigma } => {
            let first = CmaEsConfig::new(vec![0.0; genes], sigma);
            Box::new(CmaEsRestarts::new(CmaEsRestartsConfig::new(first, RestartSchedule::Ipop), seed)?)
        }
        Search::Cosyne { range } => {
            let segments = vec![of_a_neuron; genes / of_a_neuron];
            Box::new(Cosyne::new(CosyneConfig { segments, range, ..CosyneConfig::new(genes) }, seed)?)
        }
    };
    solve(strategy.as_mut(), row.config, order)
}

/// Runs a row with all seeds and prints the results.
fn report(row: &Row, seeds: std::ops::Range<u64>, threads: u64) {
    let next = AtomicU64::new(seeds.start);
    let found = Mutex::new(Vec::new());
    let start = Instant::now();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if seed >= seeds.end {
                        break;
                    }
                    let solved = one(row, seed).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
                    found.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(solved);
                }
            });
        }
    });
    let found = found.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    let mut counts: Vec<usize> = found.iter().filter_map(|solved| solved.evaluations).collect();
    counts.sort_unstable();
    let count = counts.len().max(1) as f64;
    let mean = counts.iter().sum::<usize>() as f64 / count;
    let deviation = (counts.iter().map(|x| (*x as f64 - mean) * (*x as f64 - mean)).sum::<f64>() / count).sqrt();
    let starts = found.iter().map(|solved| solved.starts).sum::<usize>() as f64 / count;
    println!(
        "| {} | {} of {} | {mean:.0} | {deviation:.0} | {} | {} | {} | {starts:.0} | {:.1} |",
        row.name,
        counts.len(),
        found.len(),
        counts.get(counts.len() / 2).copied().unwrap_or_default(),
        counts.last().copied().unwrap_or_default(),
        row.published,
        start.elapsed().as_secs_f64()
    );
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut first, mut seeds, mut threads, mut words) = (1, 100, 1, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut number =
            || arguments.next().ok_or("a number is missing")?.parse::<u64>().map_err(Box::<dyn Error>::from);
        match argument.as_str() {
            "--first" => first = number()?,
            "--seeds" => seeds = number()?,
            "--threads" => threads = number()?.max(1),
            _ => words.push(argument),
        }
    }
    println!(
        "| task, strategy | solved | mean | deviation | median | most | published mean | of 625 starts | seconds |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for row in rows().iter().filter(|row| words.iter().all(|word| row.name.contains(word.as_str()))) {
        report(row, first..first + seeds, threads);
    }
    Ok(())
}
