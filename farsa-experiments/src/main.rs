//! The `farsa` command over the reference experiments and files.

use std::process::ExitCode;

fn main() -> ExitCode {
    farsa_experiments::laboratory().main()
}
