//! Evolved robots against hand-written and random ones, on 100 starts that no run has met.
//!
//! `cargo run --release -p farsa-experiments --example swarm_baselines -- RUN...` takes directories of runs of `foraging`,
//! `aggregation` and `predator-prey` and prints tables: means with 95 % confidence intervals (Student's t), those in
//! docs/results/swarm.md. All run the same starts, so that differences are taken start by start.

mod by_hand;

use std::path::Path;
use std::process::ExitCode;

use farsa_evo::words::randomize;
use farsa_experiments::{AGGREGATION, FORAGING, PREDATOR_PREY};
use farsa_lab::advanced::{Genotype, RunDirectory};
use farsa_lab::{EpisodeId, Error, Evaluation, Evaluator, Laboratory, Note, Outcome};
use farsa_num::{Domain, Stream};

use by_hand::{Aim, beacon_seeker, chaser, homing_forager};

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
    let (experiment, reflex) = match run.experiment() {
        "foraging" => (&FORAGING, homing_forager(condition, settings)?),
        _ => (&AGGREGATION, beacon_seeker(condition)),
    };
    let robots = (0..settings.count("team.robots")?).map(|robot| (robot, reflex.clone())).collect();
    let mut team = experiment.prepare_with(condition, settings, robots)?;
    let by_hand: Vec<Outcome> = ids().map(|id| team.evaluate(Evaluation::new(&parameters[0], id), None)).collect();
    let names: Vec<&str> = evolved[0].notes.iter().map(|(name, _)| *name).collect();
    println!("| controller | fitness | evolved more by | {} |", names.join(" | "));
    println!("|---|---|---|{}", "---|".repeat(names.len()));
    for (who, outcomes) in [("evolved", &evolved), ("hand-written", &by_hand), ("random genomes", &random)] {
        println!("{}", row(who, outcomes, &evolved));
    }
    Ok(())
}

const WHO: [&str; 3] = ["evolved", "hand-written", "random genomes"];

fn pair(run: &RunDirectory<'_>, parameters: &[Vec<f32>]) -> Result<(), Error> {
    let (condition, settings) = (run.condition(), run.settings());
    let genotype = genotype(run.evaluator()?.as_ref());
    let network = |who: usize, robot: usize, id: EpisodeId| match who {
        0 => parameters[robot].clone(),
        _ => random(&genotype, id, robot as u32),
    };
    let mut rewards = vec![vec![Vec::new(); 3]; 3];
    let mut captures = [[0; 3]; 3];
    for predator in 0..3 {
        for prey in 0..3 {
            let mut reflexes = Vec::new();
            for (robot, who, aim) in [(0, predator, Aim::To), (1, prey, Aim::From)] {
                if who == 1 {
                    reflexes.push((robot, chaser(aim, settings)?));
                }
            }
            let mut evaluator = PREDATOR_PREY.prepare_with(condition, settings, reflexes)?;
            for id in ids() {
                let [own, other] = [network(predator, 0, id), network(prey, 1, id)];
                let opponents = [&other[..]];
                let evaluation = Evaluation { opponents: &opponents, ..Evaluation::new(&own, id) };
                let outcome = evaluator.evaluate(evaluation, None);
                rewards[predator][prey].push(outcome.terms[0]);
                captures[predator][prey] += u32::from(outcome.success);
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
    let laboratory = Laboratory::new(&[&FORAGING, &AGGREGATION, &PREDATOR_PREY]);
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
