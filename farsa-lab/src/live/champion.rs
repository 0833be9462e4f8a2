//! Best individual of a run, with everything that its episodes depend on.

use farsa_evo::Snapshot as _;
use farsa_view::View;

use crate::error::Error;
use crate::evaluation::replay::{Replayable, Selection};
use crate::live::page_run::PageIndividual;
use crate::run::plan::Plan;
use crate::store::directory::Directory;

/// Returns an individual of a generation, by default its best, and its camera. The default generation is the champion's, or the
/// last one for an individual.
///
/// # Errors
/// Errors of [`Replayable::find`].
pub(crate) fn champion(
    plan: &Plan<'_>,
    directory: &Directory,
    [generation, individual]: [Option<u32>; 2],
) -> Result<(PageIndividual, View), Error> {
    let champion = Replayable::find(plan, directory, Selection { generation, individual, ..Selection::default() })?;
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
    let Replayable { generation, individual, genome, parameters, opponents, normalisation, .. } = champion;
    let normalisation = normalisation.map(|statistics| statistics.save());
    let genes = genome.words().map(<[u16]>::to_vec);
    PageIndividual { generation, individual, genes, parameters, opponents, normalisation }
}
