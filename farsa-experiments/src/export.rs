//! `farsa export`: an experiment's robot as a file for other simulators.

use clap::ValueEnum;

use crate::error::Error;
use crate::plan::Plan;

/// The formats of model files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ModelFormat {
    /// MuJoCo's own: joints, inertias, contact pairs, actuators, starts
    Mjcf,
    /// The robot alone: joints, inertias, shapes
    Urdf,
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
        ModelFormat::Mjcf => robot.to_mjcf(&setup.mjcf_options()),
        ModelFormat::Urdf => robot.to_urdf(),
    };
    text.map_err(|error| Error::Other(format!("{name}: {error}")))
}
