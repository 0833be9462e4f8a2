//! Strategies by ask and tell.

use std::sync::Mutex;

use farsa_lab::advanced::{ProblemOptions, Search as LabSearch};
use numpy::{PyArray2, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::{exception, in_use};
use crate::problem::{Problem, Settings, matrix, rows, values};

/// A strategy that proposes individuals and takes their scores.
#[pyclass(frozen, module = "farsa_gym")]
pub(crate) struct Search {
    search: Mutex<LabSearch>,
}

impl Search {
    fn with<T>(&self, call: impl FnOnce(&mut LabSearch) -> PyResult<T>) -> PyResult<T> {
        call(&mut *self.search.try_lock().map_err(|_| in_use("the strategy"))?)
    }
}

#[pymethods]
impl Search {
    /// Starts a strategy over this number of genes.
    #[new]
    #[pyo3(signature = (strategy, genes, seed=1, settings=None))]
    fn new(strategy: &str, genes: usize, seed: u64, settings: Settings<'_>) -> PyResult<Self> {
        let options = ProblemOptions { seed, settings: values(&settings)?, ..ProblemOptions::default() };
        let search = farsa_experiments::laboratory().search(strategy, genes, &options);
        Ok(Self { search: Mutex::new(search.map_err(|error| exception(&error))?) })
    }

    /// Starts the strategy of an experiment.
    #[staticmethod]
    fn of(problem: &Problem) -> PyResult<Self> {
        let search = problem.with(|problem| problem.search().map_err(|error| exception(&error)))?;
        Ok(Self { search: Mutex::new(search) })
    }

    /// The number of the next generation, from 0.
    #[getter]
    fn generation(&self) -> PyResult<u32> {
        self.with(|search| Ok(search.generation()))
    }

    /// The numbers of individuals and of genes.
    #[getter]
    fn shape(&self) -> PyResult<(usize, usize)> {
        self.with(|search| Ok(search.shape().into()))
    }

    /// The numbers of objectives and of measures.
    #[getter]
    fn score_shape(&self) -> PyResult<(usize, usize)> {
        self.with(|search| Ok((search.score_shape().objectives, search.score_shape().measures)))
    }

    /// Returns the parameters of the generation, or its genes without an experiment.
    fn ask<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        self.with(|search| matrix(py, search.shape()[1], search.ask().map_err(|error| exception(&error))?))
    }

    /// Returns the genes of the generation.
    fn genes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.with(|search| matrix(py, search.shape()[1], search.genes()))
    }

    /// Takes the scores of the generation and advances.
    fn tell(&self, py: Python<'_>, scores: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let scores_of = rows(&scores);
        self.with(|search| {
            let (individuals, width) = (search.shape()[0], search.score_shape().width());
            if scores.shape() != [individuals, width] {
                let why = format!("scores have the shape {:?}, not [{individuals}, {width}]", scores.shape());
                return Err(PyValueError::new_err(why));
            }
            let values = scores_of.into_iter().flatten().collect();
            py.detach(|| search.tell(values)).map_err(|error| exception(&error))
        })
    }

    /// Saves the state.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let none = || PyValueError::new_err("this strategy has no saved states");
        self.with(|search| Ok(PyBytes::new(py, &search.save().ok_or_else(none)?)))
    }

    /// Restores a saved state.
    fn restore(&self, state: &[u8]) -> PyResult<()> {
        self.with(|search| search.restore(state).map_err(|error| exception(&error)))
    }

    /// Returns the members of the archive or front: generation, individual, objectives and measures.
    fn members<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.with(|search| {
            let columns = 2 + search.score_shape().width();
            search.members().map(|members| matrix(py, columns, members)).transpose()
        })
    }
}
