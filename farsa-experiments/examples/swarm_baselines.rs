//! Evolved robots against hand-written and random ones, on 100 starts that no run has met.
//!
//! `cargo run --release -p farsa-experiments --example swarm_baselines -- RUN...` takes directories of runs of `foraging`,
//! `aggregation` and `predator-prey` and prints tables: means with 95 % confidence intervals (Student's t), those in
//! docs/results/swarm.md. All run the same starts, so that differences are taken start by start.

use std::path::Path;
use std::process::ExitCode;

use farsa_evo::words::randomize;
use farsa_experiments::aggregation::{AggregationConfig, AggregationEpisode, BeaconSeeker, aggregate};
use farsa_experiments::foraging::{ForagingConfig, ForagingEpisode, HomingForager, forage};
use farsa_experiments::predator_prey::{Chaser, PredatorPreyConfig, PredatorPreyEpisode, chase};
use farsa_experiments::{Aggregation, Foraging, PredatorPrey};
use farsa_lab::advanced::{Genotype, OwnedNetwork, RunDirectory};
use farsa_lab::{EpisodeId, Error, Evaluation, Evaluator, Laboratory, Note, Outcome};
use farsa_nn::Controller;
use farsa_num::{Domain, Stream};

/// The first of the seeds of the starts. Runs have small ones.
const FIRST: u64 = 1_000_001;
const COUNT: usize = 100;
/// The 97.5 % quantile of Student's t with 99 degrees of freedom.
const T: f64 = 1.984;

/// Mean and half the 95 % confidence interval.
fn interval(values: &[f64]) -> [f64; 2] {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
    [mean, T * farsa_num::Scalar::sqrt(variance / n)]
}

fn cell(values: &[f64]) -> String {
    let [mean, half] = interval(values);
    format!("{mean:.2} ± {half:.2}")
}

fn ids() -> impl Iterator<Item = EpisodeId> {
    (FIRST..).take(COUNT).map(|seed| EpisodeId { seed, ..EpisodeId::default() })
}

/// The parameters of another genome for every start.
fn random(genotype: &Genotype, id: EpisodeId, which: u32) -> Vec<f32> {
    let mut genes = vec![0; genotype.genes()];
    randomize(&mut genes, &mut Stream::new(id.seed, Domain::InitialGenome, which, 0, 0));
    genotype.decode(&genes).unwrap_or_default()
}

/// The genotype of all these experiments: genes of 16 bits.
fn genotype(evaluator: &dyn Evaluator) -> Genotype {
    Genotype::new(&evaluator.info().parameters, 16)
}

fn earned(outcomes: &[Outcome]) -> Vec<f64> {
    outcomes.iter().map(|outcome| outcome.terms.iter().sum()).collect()
}

/// A row: the controllers, their fitness, by how much the evolved ones exceed it, and the notes.
fn row(who: &str, outcomes: &[Outcome], evolved: &[Outcome]) -> String {
    let differences: Vec<f64> = earned(evolved).iter().zip(earned(outcomes)).map(|(a, b)| a - b).collect();
    let more = if who == "evolved" { String::new() } else { cell(&differences) };
    let mut cells = vec![who.to_owned(), cell(&earned(outcomes)), more];
    for k in 0..evolved[0].notes.len() {
        let number = |outcome: &Outcome| match &outcome.notes[k].1 {
            Note::Number(x) => *x,
            Note::Text(_) => f64::NAN,
        };
        cells.push(cell(&outcomes.iter().map(number).collect::<Vec<_>>()));
    }
    format!("| {} |", cells.join(" | "))
}

fn team(run: &RunDirectory<'_>, parameters: &[Vec<f32>]) -> Result<(), Error> {
    let (condition, settings) = (run.condition(), run.settings());
    let mut evaluator = run.evaluator()?;
    let genotype = genotype(evaluator.as_ref());
    let mut evaluate = |parameters: &[f32], id| evaluator.evaluate(Evaluation::new(parameters, id), None);
    let evolved: Vec<Outcome> = ids().map(|id| evaluate(&parameters[0], id)).collect();
    let random: Vec<Outcome> = ids().map(|id| evaluate(&random(&genotype, id, 0), id)).collect();
    let by_hand: Vec<Outcome> = if run.experiment() == "foraging" {
        let config = ForagingConfig::for_condition(condition).read(settings)?;
        let mut world = config.world()?;
        let robots = vec![HomingForager::new(&config); config.team.robots];
        let mut episode = ForagingEpisode::new(config, robots)?;
        ids().map(|id| forage(&mut episode, &mut world, id)).collect()
    } else {
        let config = AggregationConfig::for_condition(condition).read(settings)?;
        let mut world = config.world()?;
        let robots = vec![BeaconSeeker::new(&config); config.team.robots];
        let mut episode = AggregationEpisode::new(config, robots)?;
        ids().map(|id| aggregate(&mut episode, &mut world, id)).collect()
    };
    let names: Vec<&str> = evolved[0].notes.iter().map(|(name, _)| *name).collect();
    println!("| controller | fitness | evolved more by | {} |", names.join(" | "));
    println!("|---|---|---|{}", "---|".repeat(names.len()));
    for (who, outcomes) in [("evolved", &evolved), ("hand-written", &by_hand), ("random genomes", &random)] {
        println!("{}", row(who, outcomes, &evolved));
    }
    Ok(())
}

/// The controller of a robot.
enum Mind {
    Network(OwnedNetwork),
    ByHand(Chaser),
}

impl Controller for Mind {
    fn inputs(&self) -> usize {
        match self {
            Self::Network(network) => network.inputs(),
            Self::ByHand(chaser) => chaser.inputs(),
        }
    }
    fn outputs(&self) -> usize {
        match self {
            Self::Network(network) => network.outputs(),
            Self::ByHand(chaser) => chaser.outputs(),
        }
    }
    fn reset(&mut self) {
        match self {
            Self::Network(network) => network.reset(),
            Self::ByHand(chaser) => chaser.reset(),
        }
    }
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        match self {
            Self::Network(network) => network.step(x, y),
            Self::ByHand(chaser) => chaser.step(x, y),
        }
    }
}

const WHO: [&str; 3] = ["evolved", "hand-written", "random genomes"];

fn pair(run: &RunDirectory<'_>, parameters: &[Vec<f32>]) -> Result<(), Error> {
    let config = PredatorPreyConfig::default().read(run.settings())?;
    let genotype = genotype(run.evaluator()?.as_ref());
    let mut world = config.world()?;
    let mind = |who: usize, robot: usize, id: EpisodeId| {
        Ok::<Mind, Error>(match (who, robot) {
            (0, robot) => Mind::Network(config.network(&parameters[robot])?),
            (1, 0) => Mind::ByHand(Chaser::predator(&config)),
            (1, _) => Mind::ByHand(Chaser::prey(&config)),
            (_, robot) => Mind::Network(config.network(&random(&genotype, id, robot as u32))?),
        })
    };
    let mut rewards = vec![vec![Vec::new(); 3]; 3];
    let mut captures = [[0; 3]; 3];
    for predator in 0..3 {
        for prey in 0..3 {
            for id in ids() {
                let minds = [mind(predator, 0, id)?, mind(prey, 1, id)?];
                let mut episode = PredatorPreyEpisode::new(config.clone(), minds)?;
                rewards[predator][prey].push(chase(&mut episode, &mut world, id).terms[0]);
                captures[predator][prey] += u32::from(episode.captured());
            }
        }
    }
    println!("Reward of the predator (that of the prey is the rest of 1); captures of {COUNT}:\n");
    println!("| predator | evolved prey | hand-written prey | prey of random genomes |\n|---|---|---|---|");
    for predator in 0..3 {
        let cells: Vec<String> =
            (0..3).map(|prey| format!("{}; {}", cell(&rewards[predator][prey]), captures[predator][prey])).collect();
        println!("| {} | {} |", WHO[predator], cells.join(" | "));
    }
    println!("\nHow much more the evolved one earns than the other, against the same opponents:\n");
    println!(
        "| role | instead of | evolved opponent | hand-written opponent | opponent of random genomes | mean of the three |"
    );
    println!("|---|---|---|---|---|---|");
    for other in 1..3 {
        let more = |opponent: usize, prey: bool| -> Vec<f64> {
            let of = |who: usize| if prey { &rewards[opponent][who] } else { &rewards[who][opponent] };
            let sign = if prey { -1.0 } else { 1.0 };
            of(0).iter().zip(of(other)).map(|(a, b)| sign * (a - b)).collect()
        };
        for (role, prey) in [("predator", false), ("prey", true)] {
            let differences: Vec<Vec<f64>> = (0..3).map(|opponent| more(opponent, prey)).collect();
            let means: Vec<f64> =
                (0..COUNT).map(|start| differences.iter().map(|d| d[start]).sum::<f64>() / 3.0).collect();
            let cells: Vec<String> = differences.iter().chain([&means]).map(|d| cell(d)).collect();
            println!("| {role} | {} | {} |", WHO[other], cells.join(" | "));
        }
    }
    Ok(())
}

fn compare(directory: &Path) -> Result<(), Error> {
    let laboratory = Laboratory::new(&[&Foraging, &Aggregation, &PredatorPrey]);
    let run = RunDirectory::open(directory, &laboratory)?;
    let champion = run.champion()?;
    let (experiment, condition, seed, generation) =
        (run.experiment(), run.condition(), run.seed(), champion.generation);
    println!("\n{experiment} {condition}, run of seed {seed}, best of generation {generation}:\n");
    if champion.parameters.len() > 1 { pair(&run, &champion.parameters) } else { team(&run, &champion.parameters) }
}

fn main() -> ExitCode {
    let mut failed = false;
    for directory in std::env::args_os().skip(1) {
        if let Err(error) = compare(Path::new(&directory)) {
            eprintln!("{error}");
            failed = true;
        }
    }
    if failed || std::env::args_os().len() < 2 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
