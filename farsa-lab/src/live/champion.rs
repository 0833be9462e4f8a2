//! Best individual of a run, with everything that its episodes depend on.

use farsa_evo::Snapshot as _;
use farsa_view::View;

use crate::error::Error;
use crate::evaluation::replay::{Replayable, Selection};
use crate::live::page_run::PageIndividual;
use crate::run::plan::Plan;
use crate::store::directory::Directory;

/// Returns the best individual of a generation, by default the run's champion, and its camera.
///
/// # Errors
/// Errors of [`Replayable::find`].
pub(crate) fn champion(
    plan: &Plan<'_>,
    directory: &Directory,
    generation: Option<u32>,
) -> Result<(PageIndividual, View), Error> {
    let champion = Replayable::find(plan, directory, Selection { generation, ..Selection::default() })?;
    let view = champion.schema().view;
    Ok((saved(champion), view))
}

/// Reads the champions of a run, one of each population.
///
/// # Errors
/// Errors of [`Replayable::champions`].
pub(crate) fn champions(plan: &Plan<'_>, directory: &Directory) -> Result<Vec<PageIndividual>, Error> {
    Ok(Replayable::champions(plan, directory)?.into_iter().map(saved).collect())
}

fn saved(champion: Replayable) -> PageIndividual {
    let Replayable { generation, individual, parameters, opponents, normalisation, .. } = champion;
    let normalisation = normalisation.map(|statistics| statistics.save());
    PageIndividual { generation, individual, parameters, opponents, normalisation }
}
