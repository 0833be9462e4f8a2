//! The champion of a run, with all that its trials depend on.

use farsa_evo::Snapshot as _;
use farsa_view::View;

use crate::error::Error;
use crate::evaluation::replay::{Replayable, Which};
use crate::live::script::Evolved;
use crate::run::plan::Plan;
use crate::store::directory::Directory;

/// The best individual of a generation, by default the run's champion, and from where it is looked at.
///
/// # Errors
/// Those of [`Replayable::find`].
pub(crate) fn champion(
    plan: &Plan<'_>,
    directory: &Directory,
    generation: Option<u32>,
) -> Result<(Evolved, View), Error> {
    let found = Replayable::find(plan, directory, Which { generation, ..Which::default() })?;
    let view = found.schema().view;
    Ok((evolved(found), view))
}

/// The champions of a run, one of each population.
///
/// # Errors
/// Those of [`Replayable::champions`].
pub(crate) fn champions(plan: &Plan<'_>, directory: &Directory) -> Result<Vec<Evolved>, Error> {
    Ok(Replayable::champions(plan, directory)?.into_iter().map(evolved).collect())
}

fn evolved(found: Replayable) -> Evolved {
    let Replayable { generation, individual, parameters, opponents, normalisation, .. } = found;
    let normalisation = normalisation.map(|statistics| statistics.save());
    Evolved { generation, individual, parameters, opponents, normalisation }
}
