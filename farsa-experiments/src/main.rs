//! The `farsa` command over the reference experiments.

use std::process::ExitCode;

use farsa_experiments::{Braitenberg, Discrimination, DiscriminationCylinders, ReachGraspLift, cli};

fn main() -> ExitCode {
    cli::main(&[&ReachGraspLift, &Discrimination, &DiscriminationCylinders, &Braitenberg])
}
