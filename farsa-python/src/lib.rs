//! The compiled part of the Python package `farsa_gym`.

mod chunk;
mod errors;
mod problem;
mod run;
mod search;
mod worker;
mod worlds;

use pyo3::prelude::*;

/// Compiled part of `farsa_gym`.
#[pymodule]
mod _farsa_gym {
    use std::ffi::OsString;

    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::problem::Problem;
    #[pymodule_export]
    use crate::run::Run;
    #[pymodule_export]
    use crate::search::Search;
    #[pymodule_export]
    use crate::worlds::Worlds;

    /// Lists the names and summaries of the built-in experiments.
    #[pyfunction]
    fn experiments() -> Vec<(String, String)> {
        let listed = |experiment: &&dyn farsa_lab::Experiment| (experiment.name().into(), experiment.summary().into());
        farsa_experiments::laboratory().experiments().iter().map(listed).collect()
    }

    /// Lists the names and summaries of all strategies.
    #[pyfunction]
    fn strategies() -> Vec<(String, String)> {
        let laboratory = farsa_experiments::laboratory();
        laboratory.strategies().iter().map(|strategy| (strategy.name().into(), strategy.summary().into())).collect()
    }

    /// Runs the command `farsa` with these words and returns its exit code.
    #[pyfunction]
    fn main(py: Python<'_>, words: Vec<OsString>) -> u8 {
        py.detach(|| farsa_experiments::laboratory().command(words))
    }
}
