//! An experiment with settings.

use std::sync::Mutex;

use farsa_lab::advanced::{Evaluated, Problem as LabProblem, ProblemOptions, Value};
use farsa_lab::{EpisodeId, Note, Outcome};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString};

use crate::errors::{check_process, exception, in_use};

/// Settings of Python by their keys.
pub(crate) type Settings<'py> = Option<Bound<'py, PyDict>>;

/// Name of these objects in messages.
const WHAT: &str = "the problem";

/// Converts settings into values.
pub(crate) fn values(settings: &Settings<'_>) -> PyResult<Vec<(String, Value)>> {
    let Some(settings) = settings else { return Ok(Vec::new()) };
    settings.iter().map(|(key, value)| Ok((key.extract()?, of_python(&value)?))).collect()
}

/// Converts a value of Python.
fn of_python(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if value.is_instance_of::<PyBool>() {
        return Ok(Value::Flag(value.extract()?));
    }
    // Integers of numpy, too.
    if value.is_instance_of::<PyInt>() || value.hasattr("__index__")? {
        return Ok(Value::Whole(value.extract()?));
    }
    if value.is_instance_of::<PyString>() {
        return Ok(Value::Word(value.extract()?));
    }
    if let Ok(number) = value.extract::<f64>() {
        return Ok(Value::Number(number));
    }
    let why = || PyTypeError::new_err(format!("a setting is a {}, not a flag, number, text or list", value.get_type()));
    value.extract().map(Value::Numbers).map_err(|_| why())
}

/// Converts a value of a setting.
pub(crate) fn to_python<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Flag(flag) => PyBool::new(py, *flag).to_owned().into_any(),
        Value::Whole(number) => number.into_pyobject(py)?.into_any(),
        Value::Number(number) => PyFloat::new(py, *number).into_any(),
        Value::Word(word) => PyString::new(py, word).into_any(),
        Value::Numbers(numbers) => PyList::new(py, numbers)?.into_any(),
    })
}

/// Builds a dictionary of all settings.
pub(crate) fn dictionary<'py>(py: Python<'py>, settings: &farsa_lab::Settings) -> PyResult<Bound<'py, PyDict>> {
    let dictionary = PyDict::new(py);
    for setting in settings.table() {
        let value = settings.get(setting.key()).map_err(|error| exception(&error))?;
        dictionary.set_item(setting.key(), to_python(py, value)?)?;
    }
    Ok(dictionary)
}

/// Copies a matrix into rows.
pub(crate) fn rows<T: numpy::Element + Copy>(matrix: &PyReadonlyArray2<'_, T>) -> Vec<Vec<T>> {
    matrix.as_array().outer_iter().map(|row| row.iter().copied().collect()).collect()
}

/// Builds a matrix of rows of equal length.
pub(crate) fn matrix<T: numpy::Element>(
    py: Python<'_>,
    columns: usize,
    rows: Vec<Vec<T>>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = rows.len();
    PyArray1::from_vec(py, rows.into_iter().flatten().collect()).reshape([count, columns])
}

/// A trial as terms, steps, success and notes.
type Trial<'py> = (Vec<f64>, u32, bool, Bound<'py, PyDict>);
/// An individual as scores, the reason of its failure and trials.
type Individual<'py> = (Vec<f64>, Option<String>, Vec<Trial<'py>>);

fn trial(py: Python<'_>, outcome: Outcome) -> PyResult<Trial<'_>> {
    let notes = PyDict::new(py);
    for (name, note) in outcome.notes {
        match note {
            Note::Number(number) => notes.set_item(name, number)?,
            Note::Text(text) => notes.set_item(name, text)?,
        }
    }
    Ok((outcome.terms, outcome.steps, outcome.success, notes))
}

/// An experiment with settings, which evaluates, steps and searches.
#[pyclass(frozen, module = "farsa_gym")]
pub(crate) struct Problem {
    problem: Mutex<LabProblem<'static>>,
    process: u32,
}

impl Problem {
    /// Calls a function with the experiment, unless another thread uses it.
    pub(crate) fn with<T>(&self, call: impl FnOnce(&mut LabProblem<'static>) -> PyResult<T>) -> PyResult<T> {
        check_process(WHAT, self.process)?;
        call(&mut *self.problem.try_lock().map_err(|_| in_use(WHAT))?)
    }
}

#[pymethods]
impl Problem {
    /// Prepares an experiment by its name or file.
    #[new]
    #[pyo3(signature = (experiment, condition=None, settings=None, strategy=None, seed=1, threads=0, lanes=None))]
    fn new(
        py: Python<'_>,
        experiment: &str,
        condition: Option<String>,
        settings: Settings<'_>,
        strategy: Option<String>,
        seed: u64,
        threads: usize,
        lanes: Option<usize>,
    ) -> PyResult<Self> {
        let options = ProblemOptions { condition, strategy, seed, settings: values(&settings)?, threads, lanes };
        let problem = py.detach(|| farsa_experiments::laboratory().problem(experiment, &options));
        let problem = Mutex::new(problem.map_err(|error| exception(&error))?);
        Ok(Self { problem, process: std::process::id() })
    }

    /// Returns a dictionary that describes the experiment.
    fn about<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.with(|problem| {
            let info = problem.info().map_err(|error| exception(&error))?;
            let about = PyDict::new(py);
            about.set_item("experiment", problem.experiment())?;
            about.set_item("condition", problem.condition())?;
            about.set_item("strategy", problem.strategy())?;
            about.set_item("settings", dictionary(py, problem.settings())?)?;
            let parameters = info.parameters.iter().map(|parameter| (parameter.name.clone(), parameter.ends));
            about.set_item(
                "parameters",
                parameters.map(|(name, [a, b])| (name, a.min(b), a.max(b))).collect::<Vec<_>>(),
            )?;
            about.set_item("trials", info.trials)?;
            about.set_item("terms", info.terms)?;
            about.set_item("populations", info.populations)?;
            about.set_item("has_success", info.has_success)?;
            about.set_item("steps", info.description.steps)?;
            about.set_item("step_seconds", info.description.step_seconds)?;
            let names = |channels: &[farsa_lab::advanced::Channel]| -> Vec<String> {
                channels.iter().map(|channel| channel.name.clone()).collect()
            };
            about.set_item("sensors", names(&info.schema.sensors))?;
            about.set_item("motors", names(&info.schema.outputs))?;
            Ok(about)
        })
    }

    /// Evaluates rows of parameters in all trials. Returns the fitness and each individual.
    #[pyo3(signature = (parameters, seed=1, generation=0, individual=0))]
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        parameters: PyReadonlyArray2<'py, f32>,
        seed: u64,
        generation: u32,
        individual: u32,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Vec<Individual<'py>>)> {
        if parameters.shape()[0] == 0 {
            return Err(PyValueError::new_err("parameters have the shape (0, n): there is no individual"));
        }
        let rows = rows(&parameters);
        let id = EpisodeId { seed, generation, individual, trial: 0 };
        let evaluated =
            self.with(|problem| py.detach(|| problem.evaluate(&rows, id)).map_err(|error| exception(&error)))?;
        let fitness = PyArray1::from_vec(py, evaluated.iter().map(Evaluated::fitness).collect());
        let individual = |evaluated: Evaluated| -> PyResult<Individual<'py>> {
            let Evaluated { scores, trials, failure } = evaluated;
            let why =
                failure.map(|(trial, why)| trial.map_or_else(|| why.clone(), |trial| format!("trial {trial}: {why}")));
            Ok((scores, why, trials.into_iter().map(|outcome| trial(py, outcome)).collect::<PyResult<_>>()?))
        };
        Ok((fitness, evaluated.into_iter().map(individual).collect::<PyResult<_>>()?))
    }

    /// Decodes rows of real genes into parameters.
    fn decode<'py>(&self, py: Python<'py>, genes: PyReadonlyArray2<'py, f64>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let columns = genes.shape()[1];
        let decoded = self.with(|problem| problem.decode(&rows(&genes)).map_err(|error| exception(&error)))?;
        matrix(py, columns, decoded)
    }
}
