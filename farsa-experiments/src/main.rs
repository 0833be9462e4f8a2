//! The `farsa` command with the reference experiments.

use std::process::ExitCode;

fn main() -> ExitCode {
    farsa_experiments::laboratory().main()
}
