//! The `farsa` command over the reference experiments.

use std::process::ExitCode;

use farsa_experiments::{
    Aggregation, Braitenberg, Discrimination, DiscriminationCylinders, Foraging, PredatorPrey, ReachGraspLift, cli,
};

fn main() -> ExitCode {
    cli::main(&[
        &ReachGraspLift,
        &Discrimination,
        &DiscriminationCylinders,
        &Braitenberg,
        &Foraging,
        &Aggregation,
        &PredatorPrey,
    ])
}
