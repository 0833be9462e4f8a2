//! `farsa export`: robots, controllers, genotypes and starts as files for other programs.

use std::path::PathBuf;

use farsa_evo::ObservationStatistics;
use farsa_models::mjcf::{self, MjcfOptions};
use farsa_models::urdf;
use farsa_num::Scalar;
use serde::Serialize;

use crate::error::Error;
use crate::evaluation::populations::Populations;
use crate::evaluation::{genotypes, trials};
use crate::experiment::controller_export::{ControllerExport, StartExport};
use crate::experiment::evaluator::{Evaluator, Exports};
use crate::experiment::normalized_controller::LIMIT;
use crate::export::controller_formats;
use crate::export::keyframe::start_of_trial;
use crate::json::pretty;
use crate::run::plan::Plan;
use crate::run::records::{Best, Champions};
use crate::store::directory::Directory;
use crate::strategy::any_strategy::Genome;
use crate::strategy::settings::NORMALISE;

/// Formats of model files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ModelFormat {
    /// MuJoCo's format.
    Mjcf,
    /// Robot only.
    Urdf,
}

/// Formats of controllers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ControllerFormat {
    /// Names and numbers, including the body.
    Json,
    /// Network for the flash memory of a board.
    Bytes,
    /// Network as constants of a Rust program.
    Rust,
    /// Network as tables for Python.
    Safetensors,
    /// Network as a header and a source in C.
    C,
    /// Network in integers as a header and a source in C.
    CIntegers,
}

/// Content for standard output, or new files.
pub(crate) enum Exported {
    Text(Vec<u8>),
    Files(Vec<(PathBuf, Vec<u8>)>),
}

impl Exported {
    /// Content for a file, or for standard output without its path.
    pub(crate) fn of(content: impl Into<Vec<u8>>, out: Option<PathBuf>) -> Self {
        match out {
            None => Self::Text(content.into()),
            Some(path) => Self::Files(vec![(path, content.into())]),
        }
    }
}

/// Returns the robot of an experiment under a condition and its settings.
///
/// With the directory of a run it is the robot of the population's champion where bodies evolve.
///
/// # Errors
/// [`Error::Usage`] for an experiment without bodies and errors of [`controller`] for the champion of a run.
pub(crate) fn robot(
    plan: &Plan<'_>,
    run: Option<(&Directory, Option<&str>)>,
    format: ModelFormat,
) -> Result<String, Error> {
    let mut evaluator = plan.evaluator()?;
    let (name, names) = (plan.experiment.name(), evaluator.info().populations);
    let parameters = match (run, evaluator.bodies()) {
        (Some((directory, population)), Some(_)) => {
            let champion = Champion::read(plan, directory, evaluator.as_ref(), population)?;
            Some(champion.parameters(plan, directory, evaluator.as_ref())?)
        }
        // All populations have the same robot.
        (Some((_, population @ Some(_))), None) => {
            Populations { experiment: name, names: &names }.one("--population", population)?;
            None
        }
        _ => None,
    };
    let robot = evaluator.exports().and_then(|exports| exports.robot(parameters.as_deref()));
    let recorded = || match (&parameters, evaluator.bodies()) {
        (Some(parameters), Some(bodies)) => bodies.schema_with(parameters).robot,
        _ => evaluator.info().schema.robot,
    };
    // The control step of a planar robot is not a step of dynamics.
    let step = if robot.is_some() { 0.0 } else { evaluator.info().description.step_seconds };
    let robot = robot.or_else(recorded).ok_or_else(|| Error::Usage(format!("{name} has no robot to export")))?;
    let text = match format {
        ModelFormat::Mjcf => {
            let mut options = mjcf_options(evaluator.as_ref(), step);
            if options.keyframes.is_empty() {
                options.keyframes.extend(start_of_trial(evaluator.as_mut(), &robot, parameters.as_deref()));
            }
            mjcf::write(&robot, &options)
        }
        ModelFormat::Urdf => urdf::write(&robot),
    };
    text.map_err(|error| Error::Other(format!("{name}: {error}")))
}

/// Champion of a population of a run.
struct Champion {
    generation: u32,
    individual: u32,
    population: usize,
    genes: Genome,
    normalisation: Option<ObservationStatistics>,
}

impl Champion {
    /// Reads the champion of the given population.
    fn read(
        plan: &Plan<'_>,
        directory: &Directory,
        evaluator: &dyn Evaluator,
        population: Option<&str>,
    ) -> Result<Self, Error> {
        let Champions { generation, mut best, normalisation, .. } =
            Champions::read_checked(plan, directory, evaluator)?;
        let (experiment, names) = (plan.experiment.name(), evaluator.info().populations);
        let population = Populations { experiment, names: &names }.one("--population", population)?;
        if population >= best.len() {
            return Err(Error::damaged(&directory.champion(), "it has champions of other populations"));
        }
        let Best { individual, genes, .. } = best.swap_remove(population);
        Ok(Self { generation, individual, population, genes, normalisation })
    }

    /// Computes the parameters of its genes.
    fn parameters(&self, plan: &Plan<'_>, directory: &Directory, evaluator: &dyn Evaluator) -> Result<Vec<f32>, Error> {
        let damaged = || Error::damaged(&directory.champion(), "its genome is not one of the experiment");
        self.genes.decode(&plan.genotype(evaluator)).ok_or_else(damaged)
    }
}

/// Returns the options of a MuJoCo model: those of the experiment, otherwise the given time step [s] and gravity 9.81 m/s2.
fn mjcf_options(evaluator: &dyn Evaluator, step: f64) -> MjcfOptions {
    let options = evaluator.exports().and_then(Exports::mjcf_options);
    options.unwrap_or_else(|| {
        let plain = MjcfOptions::default();
        MjcfOptions { time_step: if step > 0.0 { step } else { plain.time_step }, ..plain }
    })
}

/// A controller with its origin.
#[derive(Serialize)]
struct ChampionController<'a> {
    /// Version of the meaning of fields.
    format: u32,
    experiment: &'a str,
    condition: &'a str,
    seed: u64,
    generation: u32,
    individual: u32,
    /// Population, where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    population: Option<String>,
    #[serde(flatten)]
    controller: ControllerExport,
    /// Normalization of the inputs before they reach the network.
    #[serde(skip_serializing_if = "Option::is_none")]
    normalization: Option<Normalization>,
}

/// Normalization of inputs: (x - mean) / deviation, or 0 for a channel with a deviation below 1e-7, at most `limit` from 0.
#[derive(Serialize)]
struct Normalization {
    mean: Vec<f64>,
    deviation: Vec<f64>,
    limit: f32,
}

impl Normalization {
    /// The numbers of statistics, unless there are too few observations to change anything.
    fn from_statistics(statistics: &ObservationStatistics) -> Option<Self> {
        let deviation = statistics.variance().map(Scalar::sqrt).collect();
        let normalization = Self { mean: statistics.mean().to_vec(), deviation, limit: LIMIT };
        (statistics.count() > 1).then_some(normalization)
    }
}

impl ChampionController<'_> {
    fn text(&self) -> String {
        let Self { experiment, condition, seed, generation, individual, population, .. } = self;
        let population = population.as_ref().map(|name| format!(" ({name})")).unwrap_or_default();
        let variant = if condition.is_empty() { String::new() } else { format!(", {condition}") };
        format!(
            "The champion of `{experiment}`{population}{variant}, seed {seed}: generation {generation}, individual \
             {individual}"
        )
    }
}

/// Starts of the trials of a test.
#[derive(Serialize)]
struct Trials<'a> {
    format: u32,
    experiment: &'a str,
    condition: &'a str,
    /// Seed of the test, not of the run.
    seed: u64,
    starts: Vec<StartExport>,
}

/// Refuses champions with normalized observations.
fn as_they_are(normalisation: Option<&ObservationStatistics>, directory: &Directory) -> Result<(), Error> {
    match normalisation {
        None => Ok(()),
        Some(_) => Err(Error::Usage(format!(
            "{}: its champion's observations are normalized (`{NORMALISE}`), which this format cannot describe: export \
             the controller as `json`, or test and replay it here",
            directory.path().display()
        ))),
    }
}

/// Returns the champion's genes as a `.gen` file, or real parameters as a list.
///
/// # Errors
/// [`Error::Usage`] or [`Error::Setting`] for the population, [`Error::Usage`] for normalized observations, and [`Error::File`].
pub(crate) fn genotype(plan: &Plan<'_>, directory: &Directory, population: Option<&str>) -> Result<String, Error> {
    let evaluator = plan.evaluator()?;
    let Champion { generation, individual, genes, normalisation, .. } =
        Champion::read(plan, directory, evaluator.as_ref(), population)?;
    as_they_are(normalisation.as_ref(), directory)?;
    let experiment = plan.experiment.name();
    let (seed, condition) = (plan.seed, plan.condition.as_str());
    let variant = if condition.is_empty() { String::new() } else { format!(" {condition}") };
    let name = format!("{experiment}{variant}, seed {seed}, generation {generation}, individual {individual}");
    Ok(match genes {
        Genome::Words(genes) => genotypes::written(&name, &genes),
        Genome::Reals(genes) => genotypes::written_reals(&genes),
    })
}

/// Reads the controller of the champion.
///
/// # Errors
/// [`Error::Usage`] for a controller that cannot be exported, [`Error::Usage`] or [`Error::Setting`] for the population, and
/// [`Error::File`].
fn champion_controller<'a>(
    plan: &'a Plan<'_>,
    directory: &Directory,
    population: Option<&str>,
    format: ControllerFormat,
) -> Result<ChampionController<'a>, Error> {
    let evaluator = plan.evaluator()?;
    let name = plan.experiment.name();
    let champion = Champion::read(plan, directory, evaluator.as_ref(), population)?;
    if format != ControllerFormat::Json {
        as_they_are(champion.normalisation.as_ref(), directory)?;
    }
    let normalization = champion.normalisation.as_ref().and_then(Normalization::from_statistics);
    let parameters = champion.parameters(plan, directory, evaluator.as_ref())?;
    let names = evaluator.info().populations;
    let exports = evaluator.exports();
    let controller = exports.and_then(|exports| exports.controller_of(champion.population, &parameters));
    let controller = controller.ok_or_else(|| {
        Error::Usage(format!(
            "{name}: its controllers cannot be exported, because they are no networks of this program: `farsa export \
             genotype` writes the champion's parameters"
        ))
    })?;
    let Champion { generation, individual, .. } = champion;
    let population = names.get(champion.population).filter(|_| names.len() > 1).cloned();
    let (seed, condition) = (plan.seed, plan.condition.as_str());
    Ok(ChampionController {
        format: 1,
        experiment: name,
        condition,
        seed,
        generation,
        individual,
        population,
        controller,
        normalization,
    })
}

/// Returns the files of the champion's controller: the content for standard output, or named files. `out` is the path
/// that the user requests.
///
/// # Errors
/// Errors of [`champion_controller`], and [`Error::Usage`] for an invalid name.
pub(crate) fn controller(
    plan: &Plan<'_>,
    directory: &Directory,
    population: Option<&str>,
    format: ControllerFormat,
    out: Option<PathBuf>,
) -> Result<Exported, Error> {
    let champion = champion_controller(plan, directory, population, format)?;
    let content = match format {
        ControllerFormat::Json => pretty(&champion)?.into_bytes(),
        ControllerFormat::Bytes => controller_formats::bytes(&champion.controller)?,
        ControllerFormat::Rust => controller_formats::rust(&champion.controller, &champion.text())?.into_bytes(),
        ControllerFormat::Safetensors => {
            let about = serde_json::to_value(&champion).map_err(|error| Error::Other(error.to_string()))?;
            controller_formats::safetensors(&champion.controller, about)?
        }
        ControllerFormat::C | ControllerFormat::CIntegers => return c_files(&champion, format, out),
    };
    Ok(Exported::of(content, out))
}

/// Returns the header and the source, named after the requested path or `controller`.
fn c_files(
    champion: &ChampionController<'_>,
    format: ControllerFormat,
    out: Option<PathBuf>,
) -> Result<Exported, Error> {
    let out = out.unwrap_or_else(|| PathBuf::from("controller.c"));
    if out.extension().is_some_and(|extension| extension != "c" && extension != "h") {
        return Err(Error::Usage(format!(
            "--out {}: the format c writes a header and a source, for example {}",
            out.display(),
            out.with_extension("c").display()
        )));
    }
    let name = out.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let (controller, about) = (&champion.controller, champion.text());
    let files = match format {
        ControllerFormat::CIntegers => controller.c_integers(&name, &about)?,
        _ => controller.c(&name, &about)?,
    };
    let [header, source] = [("h", files.header), ("c", files.source)];
    Ok(Exported::Files([header, source].map(|(end, text)| (out.with_extension(end), text.into_bytes())).into()))
}

/// Returns the starts of the trials of `farsa test`.
///
/// # Errors
/// [`Error::Usage`] for an experiment whose starts cannot be exported.
pub(crate) fn starts(plan: &Plan<'_>, trials: usize, seed: u64) -> Result<String, Error> {
    let evaluator = plan.evaluator()?;
    let name = plan.experiment.name();
    let start = |trial| evaluator.exports()?.start(trials::episode(trial, evaluator.info().trials, seed));
    let starts: Option<Vec<_>> = (0..trials).map(start).collect();
    let starts = starts.ok_or_else(|| Error::Usage(format!("{name}: its starts cannot be exported")))?;
    pretty(&Trials { format: 1, experiment: name, condition: &plan.condition, seed, starts })
}
