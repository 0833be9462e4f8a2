//! Environments of an experiment, stepped in lanes and threads.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;

use farsa_lab::Error;
use farsa_lab::advanced::{Lanes, Recording, Schema};
use farsa_view::Camera;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use crate::chunk::{Autoreset, Chunk, Ended, Episodes, Job, Order};
use crate::errors::{check_process, exception, in_use};
use crate::problem::Problem;
use crate::worker::{Ran, Worker, run};

/// Name of these objects in messages.
const WHAT: &str = "the environment";
/// Most environments at once.
const MAX_ENVIRONMENTS: usize = 1 << 20;

/// Chunks between two calls, and the threads of all but the first.
struct State {
    chunks: Vec<Option<Box<Chunk>>>,
    workers: Vec<Worker>,
    /// True after the first reset of all environments.
    begun: bool,
    /// Message of a panic, after which nothing can be stepped.
    broken: Option<String>,
}

impl State {
    /// Runs the jobs of all chunks.
    fn run(&mut self) -> Result<(), String> {
        let Self { chunks, workers, .. } = self;
        let Some((first, others)) = chunks.split_first_mut() else { return Ok(()) };
        let mut sent = Vec::with_capacity(workers.len());
        for (worker, place) in workers.iter().zip(others.iter_mut()) {
            sent.push(place.take().map_or_else(|| Err("a chunk is missing".into()), |chunk| worker.send(chunk)));
        }
        let mut fault = None;
        let mut put = |place: &mut Option<Box<Chunk>>, ran: Ran| match ran {
            Ok(chunk) => *place = Some(chunk),
            Err(why) => fault = Some(why),
        };
        if let Some(chunk) = first.take() {
            put(first, run(chunk));
        }
        for ((worker, place), sent) in workers.iter().zip(others).zip(sent) {
            put(place, sent.and_then(|()| worker.receive()));
        }
        let failed = self.chunks().find_map(|chunk| chunk.failure.clone());
        fault.map(|why| format!("panicked: {why}")).or(failed).map_or(Ok(()), Err)
    }

    fn chunks(&self) -> impl Iterator<Item = &Chunk> {
        self.chunks.iter().filter_map(Option::as_deref)
    }

    fn chunks_mut(&mut self) -> impl Iterator<Item = &mut Chunk> {
        self.chunks.iter_mut().filter_map(Option::as_deref_mut)
    }
}

/// Result of a step: rewards, terminations, truncations and the episodes that ended.
type Stepped<'py> =
    (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<bool>>, Bound<'py, PyArray1<bool>>, Option<Vec<Finished<'py>>>);

/// An ended episode: environment, fitness, steps, success, failure, terms and the last observation.
type Finished<'py> = (usize, f64, u32, bool, bool, Vec<f64>, Option<Bound<'py, PyArray1<f32>>>);

/// Environments of an experiment.
#[pyclass(frozen, module = "farsa_gym")]
pub(crate) struct Worlds {
    /// None after `close`.
    state: Mutex<Option<State>>,
    process: u32,
    count: usize,
    channels: [usize; 2],
    observations: Py<PyArray2<f32>>,
    /// Worlds of each batch, and threads.
    #[pyo3(get)]
    lanes: usize,
    #[pyo3(get)]
    threads: usize,
    mode: Autoreset,
    schema: Schema,
}

/// Chooses the lanes of each batch.
fn lanes_for(count: usize, wanted: Option<usize>, threads: usize, has_lanes: bool) -> Result<Lanes, Error> {
    let best = Lanes::best();
    match wanted {
        Some(lanes) => Lanes::new(lanes, best.instructions()),
        // A batch costs as much as about three worlds.
        None if !has_lanes || count < 4 => Ok(Lanes::one()),
        None if count < best.count() * threads => Lanes::new(8, best.instructions()),
        None => Ok(best),
    }
}

/// Chooses the threads, at most one for each batch.
fn threads_for(wanted: usize) -> usize {
    if wanted == 0 { std::thread::available_parallelism().map_or(1, usize::from) } else { wanted }
}

impl Worlds {
    /// Runs the prepared jobs without the interpreter's lock, and copies the observations into the array.
    fn run(&self, py: Python<'_>, state: &mut State) -> PyResult<()> {
        if let Err(why) = py.detach(|| state.run()) {
            let error = PyRuntimeError::new_err(format!("a step of {} environments failed: {why}", self.count));
            state.broken = Some(why);
            return Err(error);
        }
        let mut view = self.observations.bind(py).try_readwrite()?;
        let rows = view.as_slice_mut()?;
        let [inputs, _] = self.channels;
        for chunk in state.chunks() {
            rows[chunk.first * inputs..(chunk.first + chunk.count()) * inputs].copy_from_slice(&chunk.observations);
        }
        Ok(())
    }

    /// Calls a function with the state, unless the environment is closed, in use, broken or of another process.
    fn with<T>(&self, call: impl FnOnce(&mut State) -> PyResult<T>) -> PyResult<T> {
        check_process(WHAT, self.process)?;
        let mut guard = self.state.try_lock().map_err(|_| in_use(&format!("{WHAT} of {} worlds", self.count)))?;
        let closed = || PyRuntimeError::new_err(format!("{WHAT} of {} worlds is closed", self.count));
        let state = guard.as_mut().ok_or_else(closed)?;
        if let Some(why) = &state.broken {
            return Err(PyRuntimeError::new_err(format!("{WHAT} failed before: {why}")));
        }
        call(state)
    }
}

#[pymethods]
impl Worlds {
    /// Builds the worlds.
    #[new]
    #[pyo3(signature = (problem, num_envs, lanes=None, threads=1, autoreset="Disabled"))]
    fn new(
        py: Python<'_>,
        problem: &Problem,
        num_envs: usize,
        lanes: Option<usize>,
        threads: usize,
        autoreset: &str,
    ) -> PyResult<Self> {
        if !(1..=MAX_ENVIRONMENTS).contains(&num_envs) {
            return Err(PyValueError::new_err(format!(
                "{num_envs} environments: there must be 1 to {MAX_ENVIRONMENTS}"
            )));
        }
        let mode = match autoreset {
            "SameStep" => Autoreset::SameStep,
            "NextStep" => Autoreset::NextStep,
            "Disabled" => Autoreset::Disabled,
            other => {
                let why = format!("autoreset {other:?} is not \"SameStep\", \"NextStep\" or \"Disabled\"");
                return Err(PyValueError::new_err(why));
            }
        };
        let threads = threads_for(threads);
        let (lanes, steppers, info) = problem.with(|problem| {
            // The closure takes the exclusive reference, because evaluators cannot be shared.
            py.detach(move || {
                let lanes = lanes_for(num_envs, lanes, threads, problem.has_lanes()?)?;
                let steppers = (0..num_envs.div_ceil(lanes.count())).map(|_| problem.stepper(lanes));
                Ok((lanes.count(), steppers.collect::<Result<Vec<_>, Error>>()?, problem.info()?))
            })
            .map_err(|error: Error| exception(&error))
        })?;
        let channels = steppers.first().map_or([0; 2], |stepper| stepper.channels());
        let (batches, threads) = (steppers.len(), threads.min(steppers.len()));
        let mut rest = steppers.into_iter();
        let mut chunks = Vec::new();
        for thread in 0..threads {
            let [first, end] = [thread, thread + 1].map(|thread| thread * batches / threads);
            let (from, to) = (first * lanes, (end * lanes).min(num_envs));
            let own = rest.by_ref().take(end - first).collect();
            chunks.push(Some(Box::new(Chunk::new((from, to - from), own, lanes, mode, info.trials))));
        }
        let workers = (1..threads).map(Worker::start).collect::<Result<Vec<_>, _>>()?;
        let state = State { chunks, workers, begun: false, broken: None };
        let observations = PyArray2::zeros(py, [num_envs, channels[0]], false).unbind();
        let (state, process) = (Mutex::new(Some(state)), std::process::id());
        Ok(Self { state, process, count: num_envs, channels, observations, lanes, threads, mode, schema: info.schema })
    }

    /// The number of observed channels.
    #[getter]
    fn observation_size(&self) -> usize {
        self.channels[0]
    }

    /// The number of actions.
    #[getter]
    fn action_size(&self) -> usize {
        self.channels[1]
    }

    /// The array of all observations, which each call overwrites.
    #[getter]
    fn observations<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f32>> {
        self.observations.bind(py).clone()
    }

    /// Starts episodes in the environments of the mask. Each start is a seed, an individual and the number of the next
    /// episode, or None for the next episode of the environment.
    fn reset(&self, py: Python<'_>, mask: Vec<bool>, starts: Vec<Option<(u64, u32, u64)>>) -> PyResult<()> {
        self.with(|state| {
            if [mask.len(), starts.len()] != [self.count; 2] {
                let why =
                    format!("a mask of {} and {} starts for {} environments", mask.len(), starts.len(), self.count);
                return Err(PyValueError::new_err(why));
            }
            if !state.begun && mask.contains(&false) {
                return Err(PyRuntimeError::new_err("the first reset needs all environments"));
            }
            for chunk in state.chunks_mut() {
                chunk.job = Job::Reset;
                for place in 0..chunk.count() {
                    let number = chunk.first + place;
                    let start = |(seed, individual, next)| Order::From(Episodes { seed, individual, next });
                    let order = starts[number].map_or(Order::Next, start);
                    chunk.orders[place] = if mask[number] { order } else { Order::Keep };
                }
            }
            self.run(py, state)?;
            state.begun = true;
            Ok(())
        })
    }

    /// Steps all environments by the rows of actions.
    fn step<'py>(&self, py: Python<'py>, actions: PyReadonlyArray2<'py, f32>) -> PyResult<Stepped<'py>> {
        self.with(|state| {
            let [_, outputs] = self.channels;
            if actions.shape() != [self.count, outputs] {
                let why = format!("actions have the shape {:?}, not [{}, {outputs}]", actions.shape(), self.count);
                return Err(PyValueError::new_err(why));
            }
            let values = actions.as_slice()?;
            if let Some(place) = values.iter().position(|value| value.is_nan()) {
                let (environment, channel) = (place / outputs, place % outputs);
                return Err(PyValueError::new_err(format!("action {channel} of environment {environment} is NaN")));
            }
            if !state.begun {
                return Err(PyRuntimeError::new_err(format!("{WHAT} must be reset before its first step")));
            }
            if self.mode == Autoreset::Disabled
                && let Some(number) = state.chunks().flat_map(|chunk| &chunk.waits).position(|waits| *waits)
            {
                let why = format!("the episode of environment {number} has ended and must be reset");
                return Err(PyRuntimeError::new_err(why));
            }
            for chunk in state.chunks_mut() {
                chunk.job = Job::Step;
                let range = chunk.first * outputs..(chunk.first + chunk.count()) * outputs;
                chunk.actions.copy_from_slice(&values[range]);
            }
            self.run(py, state)?;
            let mut rewards = Vec::with_capacity(self.count);
            let mut ends = [Vec::with_capacity(self.count), Vec::with_capacity(self.count)];
            for result in state.chunks().flat_map(|chunk| &chunk.results) {
                rewards.push(result.reward);
                ends[0].push(result.terminated);
                ends[1].push(result.truncated);
            }
            let finished = |ended: &Ended| {
                let Ended { environment, fitness, steps, success, failed, ref terms, ref observation } = *ended;
                let last = observation.as_ref().map(|row| PyArray1::from_slice(py, row));
                (environment, fitness, steps, success, failed, terms.clone(), last)
            };
            let finished: Vec<_> = state.chunks().flat_map(|chunk| &chunk.ended).map(finished).collect();
            let [terminated, truncated] = ends.map(|flags| PyArray1::from_vec(py, flags));
            let finished = (!finished.is_empty()).then_some(finished);
            Ok((PyArray1::from_vec(py, rewards), terminated, truncated, finished))
        })
    }

    /// Draws an environment as rows of red, green and blue bytes.
    #[pyo3(signature = (environment, width=480, height=320, camera=None))]
    fn render<'py>(
        &self,
        py: Python<'py>,
        environment: usize,
        width: u32,
        height: u32,
        camera: Option<&str>,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        if ![width, height].iter().all(|side| (16..=8192).contains(side)) {
            return Err(PyValueError::new_err(format!(
                "a picture of {width} x {height}: each side is 16 to 8192 pixels"
            )));
        }
        let view = self.schema.view;
        let camera = camera.map_or(Ok(Camera::for_view(view)), Camera::named);
        let camera = camera.map_err(|error| PyValueError::new_err(error.to_string()))?;
        let pixels = self.with(|state| {
            let count = self.count;
            if !state.begun {
                return Err(PyRuntimeError::new_err(format!("{WHAT} must be reset before it is drawn")));
            }
            let chunk =
                state.chunks_mut().find(|chunk| (chunk.first..chunk.first + chunk.count()).contains(&environment));
            let none = || PyValueError::new_err(format!("environment {environment} of {count}, from 0"));
            let chunk = chunk.ok_or_else(none)?;
            let mut recording = Recording::new(self.schema.clone());
            chunk.record(environment - chunk.first, &mut recording);
            let picture = recording.picture(0).ok_or_else(|| PyRuntimeError::new_err("there is no body to draw"))?;
            let draw = AssertUnwindSafe(|| picture.rgb(camera, [width, height]));
            let drawn = py.detach(|| catch_unwind(draw).ok());
            drawn.ok_or_else(|| {
                PyRuntimeError::new_err(format!("the state of environment {environment} cannot be drawn"))
            })
        })?;
        PyArray1::from_vec(py, pixels).reshape([height as usize, width as usize, 3])
    }

    /// Ends the threads and frees the worlds. Further calls do nothing.
    fn close(&self) -> PyResult<()> {
        let mut state = self.state.try_lock().map_err(|_| in_use(&format!("{WHAT} of {} worlds", self.count)))?;
        *state = None;
        Ok(())
    }
}
