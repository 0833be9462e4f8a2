//! NSGA-II on ZDT1 to 4 and 6: the hypervolume of the front after 25 000 evaluations.
//!
//! `cargo run --release -p farsa-evo --example zdt` prints a line of comma-separated values for each problem and seed;
//! `benches/zdt_pymoo.py` prints the same of pymoo and compares them.

use std::time::Instant;

use farsa_evo::pareto::{Nsga2, Nsga2Config, hypervolume};
use farsa_evo::{EvoError, Strategy};

mod problems;
use problems::{REFERENCE, Zdt};

fn main() -> Result<(), EvoError> {
    println!("problem,seed,hypervolume,largest,seconds");
    for problem in Zdt::ALL {
        let largest = problem.largest_hypervolume();
        for seed in 1..=11 {
            let start = Instant::now();
            let mut search = Nsga2::new(Nsga2Config::new(problem.bounds(), 2), seed)?;
            search.evolve(250, |genes, row| problem.judge(genes, row))?;
            let seconds = start.elapsed().as_secs_f64();
            let points: Vec<[f64; 2]> = search.front().map(|(_, objectives)| [objectives[0], objectives[1]]).collect();
            let volume = hypervolume(&points, REFERENCE);
            println!("{},{seed},{volume:.6},{largest:.6},{seconds:.4}", problem.name());
        }
    }
    Ok(())
}
