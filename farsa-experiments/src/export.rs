//! `farsa export`: robots, controllers, genotypes and starts as files for other programs.

use clap::ValueEnum;
use serde::Serialize;

use crate::controller_export::{ControllerExport, StartExport};
use crate::controller_formats;
use crate::directory::Directory;
use crate::error::Error;
use crate::exam;
use crate::genotypes;
use crate::info::pretty;
use crate::plan::Plan;
use crate::populations::Populations;
use crate::records::{Best, Champions};

/// The formats of model files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ModelFormat {
    /// MuJoCo's own: joints, inertias, contact pairs, actuators, starts
    Mjcf,
    /// The robot alone: joints, inertias, shapes
    Urdf,
}

/// The formats of controllers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ControllerFormat {
    /// Names and numbers, of the body too
    Json,
    /// The network for a board's flash: checked and used where it lies
    Bytes,
    /// The network as constants of a Rust program
    Rust,
    /// The network as tables for Python
    Safetensors,
}

/// The formats of starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DataFormat {
    /// Names and numbers
    Json,
}

/// The robot of an experiment under a condition and its settings.
///
/// # Errors
/// [`Error::Usage`] for an experiment without bodies.
pub(crate) fn robot(plan: &Plan<'_>, format: ModelFormat) -> Result<String, Error> {
    let setup = plan.setup()?;
    let name = plan.experiment.name();
    let robot = setup.stage().robot.ok_or_else(|| Error::Usage(format!("{name} has no robot to export")))?;
    let text = match format {
        ModelFormat::Mjcf => farsa_models::mjcf::write(&robot, &setup.mjcf_options()),
        ModelFormat::Urdf => farsa_models::urdf::write(&robot),
    };
    text.map_err(|error| Error::Other(format!("{name}: {error}")))
}

/// Whose controller it is.
#[derive(Serialize)]
struct Whose<'a> {
    /// Grows when the meaning of a field changes.
    format: u32,
    experiment: &'a str,
    condition: &'a str,
    seed: u64,
    generation: u32,
    individual: u32,
    #[serde(flatten)]
    controller: ControllerExport,
}

impl Whose<'_> {
    fn text(&self) -> String {
        let Self { experiment, condition, seed, generation, individual, .. } = self;
        format!(
            "The champion of `{experiment}`, {condition}, seed {seed}: generation {generation}, individual {individual}"
        )
    }
}

/// How the trials of a test start.
#[derive(Serialize)]
struct Trials<'a> {
    format: u32,
    experiment: &'a str,
    condition: &'a str,
    /// The test's, not the run's.
    seed: u64,
    starts: Vec<StartExport>,
}

/// The champion's genes as a `.gen` file; of several populations that of the one named.
///
/// # Errors
/// [`Error::Usage`] or [`Error::Unknown`] for the population, [`Error::Damaged`], [`Error::OtherConfiguration`].
pub(crate) fn genotype(plan: &Plan<'_>, directory: &Directory, population: Option<&str>) -> Result<String, Error> {
    let setup = plan.setup()?;
    let Champions { generation, best, .. } = Champions::of(plan, directory, setup.as_ref())?;
    let (experiment, names) = (plan.experiment.name(), setup.population_names());
    let population = Populations { experiment, names: &names }.one("--population", population)?;
    let Some(Best { individual, genes, .. }) = best.get(population) else {
        return Err(Error::damaged(&directory.champion(), "it has champions of other populations"));
    };
    let (seed, condition) = (plan.seed, plan.condition.as_str());
    let variant = if condition.is_empty() { String::new() } else { format!(" {condition}") };
    let name = format!("{experiment}{variant}, seed {seed}, generation {generation}, individual {individual}");
    Ok(genotypes::written(&name, genes))
}

/// The champion's controller of a run, as the content of a file.
///
/// # Errors
/// [`Error::Usage`] for an experiment whose controllers cannot be exported, [`Error::Damaged`], [`Error::OtherConfiguration`].
pub(crate) fn controller(plan: &Plan<'_>, directory: &Directory, format: ControllerFormat) -> Result<Vec<u8>, Error> {
    let setup = plan.setup()?;
    let Champions { generation, best, .. } = Champions::of(plan, directory, setup.as_ref())?;
    let name = plan.experiment.name();
    let [Best { individual, genes, .. }] = best.as_slice() else {
        return Err(Error::Usage(format!("{name}: controllers of {} populations cannot be exported", best.len())));
    };
    let controller = match (setup.controller(genes), setup.ctrnn(genes)) {
        (Some(controller), _) => controller,
        // Its body is none that the other formats could tell.
        (None, Some(network)) if format == ControllerFormat::Bytes => return controller_formats::ctrnn_bytes(&network),
        (None, Some(_)) => return Err(Error::Usage(format!("{name}: its controllers are exported as bytes only"))),
        (None, None) => return Err(Error::Usage(format!("{name}: its controllers cannot be exported"))),
    };
    let (seed, condition) = (plan.seed, plan.condition.as_str());
    let individual = *individual;
    let whose = Whose { format: 1, experiment: name, condition, seed, generation, individual, controller };
    match format {
        ControllerFormat::Json => pretty(&whose).map(String::into_bytes),
        ControllerFormat::Bytes => controller_formats::bytes(&whose.controller),
        ControllerFormat::Rust => controller_formats::rust(&whose.controller, &whose.text()).map(String::into_bytes),
        ControllerFormat::Safetensors => {
            let about = serde_json::to_value(&whose).map_err(|error| Error::Other(error.to_string()))?;
            controller_formats::safetensors(&whose.controller, about)
        }
    }
}

/// How the trials of `farsa test` start.
///
/// # Errors
/// [`Error::Usage`] for an experiment whose starts cannot be told.
pub(crate) fn starts(plan: &Plan<'_>, trials: usize, seed: u64) -> Result<String, Error> {
    let setup = plan.setup()?;
    let name = plan.experiment.name();
    let starts = (0..trials).map(|trial| setup.start(exam::job(trial, setup.trials(), seed)));
    let starts: Option<Vec<_>> = starts.collect();
    let starts = starts.ok_or_else(|| Error::Usage(format!("{name}: its starts cannot be exported")))?;
    pretty(&Trials { format: 1, experiment: name, condition: &plan.condition, seed, starts })
}
