#![doc = include_str!("../README.md")]

mod communicator;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

use farsa_lab::Laboratory;
use mpi::environment::{Threading, initialize_with_threading};
use mpi::topology::Communicator as _;

pub use communicator::MpiRanks;

/// What all ranks end with when one panics outside a trial.
const PANICKED: i32 = 101;

/// Runs the command over a laboratory on all ranks of MPI: the whole of a `main`. Without `mpirun` there is one rank.
///
/// The exit code is that of [`Laboratory::main`], on all ranks. A program is to be called like the one of one process, with `-mpi` behind.
pub fn main(laboratory: &Laboratory<'_>) -> ExitCode {
    // Trials run in threads of their own, which know nothing of MPI.
    let Some((universe, _)) = initialize_with_threading(Threading::Funneled) else {
        eprintln!("error: MPI was initialised before");
        return ExitCode::FAILURE;
    };
    let world = universe.world();
    let ranks = MpiRanks::new(world);
    let result = catch_unwind(AssertUnwindSafe(|| laboratory.main_on_ranks(&ranks)));
    result.unwrap_or_else(|_| {
        // The others would wait for this one.
        universe.world().abort(PANICKED)
    })
}
