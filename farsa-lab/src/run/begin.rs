//! Creates the directory of a run and restores a search from its checkpoint.

use std::path::Path;

use farsa_evo::{EvoError, Record};

use crate::error::Error;
use crate::experiment::genotype::Genotype;
use crate::run::config_file;
use crate::run::plan::Plan;
use crate::run::record_file::{RunRecord, RunRecordWriter};
use crate::run::records::Checkpoint;
use crate::run::search_state::SearchState;
use crate::store::append_log::Mark;
use crate::store::directory::Directory;
use crate::store::lineage::HEADER;
use crate::store::log;
use crate::store::manifest::Manifest;
use crate::store::replace::replace;
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::history::History;
use crate::strategy::opponents::HallOfFame;

/// Creates the directory of a new run, ready for its first generation.
pub(crate) fn create(plan: &Plan<'_>, path: &Path) -> Result<Directory, Error> {
    let mut strategy = plan.strategy()?;
    let refused = |error: EvoError| Error::Usage(format!("{}: {error}", plan.definition().name()));
    strategy.record().map_err(refused)?;
    let (text, identity, populations) = (plan.to_toml()?, plan.identity()?, plan.evaluator()?.info().populations);
    let state = strategy.snapshot().map(|strategy| strategy.save());
    let bytes = state.as_ref().map_or(0, Vec::len);
    let limit = plan.limits.state_bytes;
    if bytes as u64 > limit {
        let (name, individuals, genes) = (plan.definition().name(), strategy.individuals(), strategy.genes());
        return Err(Error::Usage(format!(
            "`{name}`: a state of {individuals} individuals of {genes} genes has {bytes} bytes; a checkpoint keeps at most \
             {limit}"
        )));
    }
    if text.len() as u64 > config_file::MAX_BYTES {
        return Err(Error::too_large(&path.join("config.toml"), text.len() as u64, config_file::MAX_BYTES));
    }
    Directory::create(path, |directory| {
        replace(&directory.config(), text.as_bytes())?;
        Manifest::new(&identity).write(&directory.manifest())?;
        replace(&directory.log(), log::header(&populations).as_bytes())?;
        let lineage = if strategy.genealogy().is_some() {
            replace(&directory.lineage(), HEADER.as_bytes())?;
            Mark::of(HEADER.as_bytes())
        } else {
            Mark::default()
        };
        let record = RunRecordWriter::create(&directory.record(), &identity, plan.definition().name())?;
        let failures = Mark::default();
        Checkpoint { identity, generation: 0, record, lineage, failures, state }.write(&directory.checkpoint())
    })
}

/// Restores the strategy of a run from its checkpoint.
pub(crate) fn resumed(
    plan: &Plan<'_>,
    directory: &Directory,
    checkpoint: &Checkpoint,
    record: &Record,
) -> Result<AnyStrategy, Error> {
    let path = directory.record();
    let mut strategy = plan.strategy()?;
    match (&checkpoint.state, strategy.snapshot()) {
        (Some(state), Some(strategy)) => {
            strategy.restore(state).map_err(|error| Error::damaged(&directory.checkpoint(), error))?;
        }
        _ => strategy.rebuild(record, checkpoint.generation).map_err(|error| Error::damaged(&path, error))?,
    }
    if strategy.generation() != checkpoint.generation {
        let (found, expected) = (strategy.generation(), checkpoint.generation);
        let why = format!("a strategy at generation {found} where {expected} are finished");
        return Err(Error::damaged(&directory.checkpoint(), why));
    }
    Ok(strategy)
}

/// Restores the search of a run from its checkpoint, with the opponents of previous generations.
///
/// # Errors
/// The errors of [`resumed`] and of [`HallOfFame::before`].
pub(crate) fn search_state(
    plan: &Plan<'_>,
    directory: &Directory,
    checkpoint: &Checkpoint,
    run_record: &RunRecord,
    genotype: &Genotype,
) -> Result<SearchState, Error> {
    let search = resumed(plan, directory, checkpoint, &run_record.record)?;
    let hall = match run_record.record.populations() {
        1 => HallOfFame::default(),
        _ if search.opponents().is_some() => HallOfFame::default(),
        _ => HallOfFame::before(&History::new(directory.record(), run_record.record.clone(), plan.fresh()), genotype)?,
    };
    let observed = run_record.observed.last().cloned().or(plan.no_observations()?);
    Ok(SearchState::new(search, hall, observed, checkpoint.identity.seed))
}
