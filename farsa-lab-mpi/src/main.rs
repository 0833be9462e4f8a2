//! The `farsa-mpi` command over the reference experiments: `mpirun -n 4 farsa-mpi run ...`.

use std::process::ExitCode;

fn main() -> ExitCode {
    farsa_lab_mpi::main(&farsa_experiments::laboratory())
}
