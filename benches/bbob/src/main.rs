//! Evaluations until COCO's final target (10^-8) is hit, by covariance matrix adaptation with IPOP restarts.
//!
//! `farsa-bbob BUDGET DIMENSION...` prints a line for each of the functions 1, 2 and 5 to 18 and the instances 1 to 15.
//! The columns are dimension, function, instance, evaluations, and success. `pycma.py` prints the lines of pycma. Both
//! begin at the origin with a step size of 2, seed 1 + instance, and stop after BUDGET times the dimension.

use std::process::ExitCode;

use coco_rs::{LogLevel, Suite, suite};
use farsa_evo::covariance::{CmaEsConfig, CmaEsRestarts, CmaEsRestartsConfig, RestartSchedule};
use farsa_evo::{EvoError, Fitness, Strategy};

const FUNCTIONS: &str = "1-2,5-18";

fn main() -> ExitCode {
    let numbers: Option<Vec<u64>> = std::env::args().skip(1).map(|text| text.parse().ok()).collect();
    let numbers = numbers.unwrap_or_default();
    let [budget, dimensions @ ..] = numbers.as_slice() else {
        eprintln!("usage: farsa-bbob BUDGET DIMENSION...");
        return ExitCode::from(2);
    };
    // It speaks on the standard output otherwise.
    LogLevel::Warning.set();
    println!("dimension,function,instance,evaluations,hit");
    for dimension in dimensions {
        if let Err(error) = solve_all(*dimension, *budget) {
            eprintln!("farsa-bbob: {error}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn solve_all(dimension: u64, budget: u64) -> Result<(), String> {
    let options = format!("dimensions: {dimension} function_indices: {FUNCTIONS} instance_indices: 1-15");
    let suite = Suite::new(suite::Name::Bbob, "instances: 1-15", &options);
    let mut suite = suite.ok_or_else(|| format!("no functions of {dimension} dimensions"))?;
    while let Some(mut problem) = suite.next_problem(None) {
        let id = problem.id().to_owned();
        let number = |mark: &str| id.split('_').find_map(|part| part.strip_prefix(mark)?.parse::<u64>().ok());
        let (function, instance) = (number("f").unwrap_or(0), number("i").unwrap_or(0));
        let most = budget * dimension;
        let solved = solve(&mut problem, 1 + instance, most).map_err(|error| format!("{id}: {error}"))?;
        println!("{dimension},{function},{instance},{},{}", problem.evaluations(), u8::from(solved));
    }
    Ok(())
}

/// Searches until the target is hit, which is detected immediately, or the evaluations are used up.
fn solve(problem: &mut coco_rs::Problem<'_>, seed: u64, most: u64) -> Result<bool, EvoError> {
    let first = CmaEsConfig::new(vec![0.0; problem.dimension()], 2.0);
    let mut search = CmaEsRestarts::new(CmaEsRestartsConfig::new(first, RestartSchedule::Ipop), seed)?;
    let mut value = [0.0];
    loop {
        let mut fitness = Vec::with_capacity(search.ask().len());
        for genes in search.ask() {
            problem.evaluate_function(genes, &mut value);
            if problem.final_target_hit() {
                return Ok(true);
            }
            if problem.evaluations() >= most {
                return Ok(false);
            }
            fitness.push(Fitness::nan_as_failed(-value[0]));
        }
        search.tell(&fitness)?;
    }
}
