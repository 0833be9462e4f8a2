#![doc = include_str!("../README.md")]

mod communicator;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

use farsa_lab::Laboratory;
use mpi::environment::{Threading, initialize_with_threading};
use mpi::topology::Communicator as _;

pub use communicator::MpiRanks;

/// The exit code of all ranks after a panic outside a trial.
const PANICKED: i32 = 101;

/// Runs the command over a laboratory on all MPI ranks, as the body of a `main`. Without `mpirun` there is one rank.
///
/// The exit code is that of [`Laboratory::main`] on all ranks. Name the program like that of one process, with `-mpi` at the end.
pub fn main(laboratory: &Laboratory<'_>) -> ExitCode {
    // Trials run in other threads, which make no MPI calls.
    let Some((universe, _)) = initialize_with_threading(Threading::Funneled) else {
        eprintln!("error: MPI was initialised before");
        return ExitCode::FAILURE;
    };
    let world = universe.world();
    let ranks = MpiRanks::new(world);
    let result = catch_unwind(AssertUnwindSafe(|| laboratory.main_on_ranks(&ranks)));
    result.unwrap_or_else(|_| {
        // The other ranks would wait for this one.
        universe.world().abort(PANICKED)
    })
}
