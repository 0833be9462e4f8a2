//! The `farsa` command over the reference experiments.

use std::process::ExitCode;

use farsa_lab::cli;

fn main() -> ExitCode {
    cli::main(&farsa_experiments::all())
}
