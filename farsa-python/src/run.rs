//! Files of a run.

use std::path::PathBuf;

use farsa_lab::advanced::{RunChampion, RunDirectory};
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::exception;
use crate::problem::{dictionary, matrix};

/// Champions as their generation, individuals, fitness and parameters.
type Champion<'py> = (u32, Vec<u32>, Vec<f64>, Bound<'py, PyArray2<f32>>);

/// Directory of a run.
#[pyclass(frozen, module = "farsa_gym")]
pub(crate) struct Run {
    run: RunDirectory<'static>,
}

#[pymethods]
impl Run {
    /// Opens the directory of a run.
    #[new]
    fn new(path: PathBuf) -> PyResult<Self> {
        let run = RunDirectory::open(&path, &farsa_experiments::laboratory());
        Ok(Self { run: run.map_err(|error| exception(&error))? })
    }

    /// Returns a dictionary of experiment, condition, strategy, seed and settings.
    fn about<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let about = PyDict::new(py);
        about.set_item("experiment", self.run.experiment())?;
        about.set_item("condition", self.run.condition())?;
        about.set_item("strategy", self.run.strategy())?;
        about.set_item("seed", self.run.seed())?;
        about.set_item("settings", dictionary(py, self.run.settings())?)?;
        Ok(about)
    }

    /// Returns the complete configuration as TOML.
    fn config(&self) -> PyResult<String> {
        self.run.config().map_err(|error| exception(&error))
    }

    /// Returns best, mean and worst fitness, evaluations and failures of each generation.
    fn curves<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let record = self.run.record().map_err(|error| exception(&error))?;
        let row = |row: &farsa_lab::advanced::LogRow| {
            vec![row.best, row.mean, row.worst, row.evaluations as f64, row.failed as f64]
        };
        matrix(py, 5, record.log().iter().map(row).collect())
    }

    /// Returns the champion of each population: generation, individuals, fitness and parameters.
    fn champion<'py>(&self, py: Python<'py>) -> PyResult<Champion<'py>> {
        let RunChampion { generation, individuals, fitness, parameters, .. } =
            self.run.champion().map_err(|error| exception(&error))?;
        let columns = parameters.first().map_or(0, Vec::len);
        Ok((generation, individuals, fitness, matrix(py, columns, parameters)?))
    }

    /// Returns the parameters of all individuals of a generation.
    fn parameters<'py>(&self, py: Python<'py>, generation: u32) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let rebuild = || self.run.record()?.parameters(generation);
        let parameters = py.detach(rebuild).map_err(|error| exception(&error))?;
        let columns = parameters.first().map_or(0, Vec::len);
        matrix(py, columns, parameters)
    }

    /// Returns the trials of the last test: trial, steps, success and fitness.
    fn tests(&self) -> PyResult<Vec<(u32, u32, bool, f64)>> {
        let trials = self.run.test().map_err(|error| exception(&error))?;
        Ok(trials.into_iter().map(|trial| (trial.trial, trial.steps, trial.success, trial.fitness)).collect())
    }
}
