//! The `farsa` command over the reference experiments.

use std::process::ExitCode;

use farsa_experiments::{ReachGraspLift, cli};

fn main() -> ExitCode {
    cli::main(&[&ReachGraspLift])
}
