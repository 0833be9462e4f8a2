//! How a run begins, and how it is taken up where its checkpoint left it.

use std::path::Path;

use farsa_evo::{EvoError, Fitness, Record};

use crate::error::Error;
use crate::experiment::genotype::Genotype;
use crate::run::plan::Plan;
use crate::run::record_file::{RunRecord, RunRecordWriter};
use crate::run::records::{Best, Champions, Checkpoint};
use crate::run::search_state::SearchState;
use crate::store::append_log::Mark;
use crate::store::directory::Directory;
use crate::store::lineage::{HEADER, Lineage, rows};
use crate::store::log;
use crate::store::manifest::Manifest;
use crate::store::replace::replace;
use crate::strategy::history::History;
use crate::strategy::opponents::Hall;
use crate::strategy::search::{LARGEST_STATE, Search};

/// Makes the directory of a new run, ready for its first generation.
pub(crate) fn create(plan: &Plan<'_>, path: &Path) -> Result<Directory, Error> {
    let mut strategy = plan.strategy()?;
    let refused = |error: EvoError| Error::Other(format!("{}: {error}", plan.definition().name()));
    strategy.record().map_err(refused)?;
    let (text, identity, populations) = (plan.to_toml()?, plan.identity()?, strategy.populations());
    let state = strategy.snapshot().map(|strategy| strategy.save());
    let bytes = state.as_ref().map_or(0, Vec::len);
    if bytes as u64 > LARGEST_STATE {
        let (name, individuals, genes) = (plan.definition().name(), strategy.individuals(), strategy.genes());
        return Err(Error::Usage(format!(
            "`{name}`: a state of {individuals} individuals of {genes} genes has {bytes} bytes; a checkpoint keeps at most \
             {LARGEST_STATE}"
        )));
    }
    Directory::create(path, |directory| {
        replace(&directory.config(), text.as_bytes())?;
        Manifest::new(&identity).write(&directory.manifest())?;
        replace(&directory.log(), log::header(populations).as_bytes())?;
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

/// The strategy of a run as it was when its checkpoint was written.
pub(crate) fn resumed(
    plan: &Plan<'_>,
    directory: &Directory,
    checkpoint: &Checkpoint,
    record: &Record,
) -> Result<Search, Error> {
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

/// The search of a run as it was when its checkpoint was written, with whom it still has to meet.
///
/// # Errors
/// Those of [`resumed`] and of [`Hall::before`].
pub(crate) fn search_state(
    plan: &Plan<'_>,
    directory: &Directory,
    checkpoint: &Checkpoint,
    run_record: &RunRecord,
    genotype: &Genotype,
) -> Result<SearchState, Error> {
    let search = resumed(plan, directory, checkpoint, &run_record.record)?;
    let hall = match run_record.record.populations() {
        1 => Hall::default(),
        _ if search.opponents().is_some() => Hall::default(),
        _ => Hall::before(&History::new(directory.record(), run_record.record.clone(), plan.fresh()), genotype)?,
    };
    let observed = run_record.observed.last().cloned().or(plan.no_observations()?);
    Ok(SearchState::new(search, hall, observed, checkpoint.identity.seed))
}

/// Opens the lineage of a run that goes on, where its strategy has one.
pub(crate) fn lineage(
    plan: &Plan<'_>,
    directory: &Directory,
    checkpoint: &Checkpoint,
    record: &Record,
    strategy: &Search,
) -> Result<Option<Lineage>, Error> {
    if strategy.genealogy().is_none() {
        return Ok(None);
    }
    let again = |append: &mut dyn FnMut(&str) -> Result<(), Error>| {
        let mut strategy = plan.strategy()?;
        for generation in 0..=checkpoint.generation {
            let rebuilt = strategy.rebuild(record, generation);
            rebuilt.map_err(|error| Error::damaged(&directory.record(), error))?;
            append(&rows(&strategy))?;
        }
        Ok(())
    };
    Lineage::resume(&directory.lineage(), checkpoint.lineage, again).map(Some)
}

/// The champions of the generations that a checkpoint speaks of, where `champion.bin` has not got them: it is written before the
/// checkpoint, and a process that is killed between the two leaves those of a later generation.
///
/// # Errors
/// Those of [`History::genomes`].
pub(crate) fn champions(
    plan: &Plan<'_>,
    directory: &Directory,
    checkpoint: &Checkpoint,
    run_record: &RunRecord,
) -> Result<Option<Champions>, Error> {
    let Some(generation) = run_record.champion() else { return Ok(None) };
    // What cannot be read is made again, too.
    if Champions::read(plan, directory).is_ok_and(|champions| champions.generation == generation) {
        return Ok(None);
    }
    let missing = || Error::damaged(&directory.record(), format!("has no champion of generation {generation}"));
    let individuals =
        (0..run_record.record.populations()).map(|population| run_record.record.champion(population, generation));
    let individuals: Vec<usize> = individuals.collect::<Option<_>>().ok_or_else(missing)?;
    let wanted: Vec<(u32, usize)> = individuals.iter().map(|&individual| (generation, individual)).collect();
    let genomes = History::new(directory.record(), run_record.record.clone(), plan.fresh()).genomes(&wanted)?;
    let line = run_record.lines.get(generation as usize).ok_or_else(missing)?;
    // Of a single population there is nothing but the whole.
    let rows = if line.each.is_empty() { std::slice::from_ref(&line.row) } else { &line.each };
    let best = individuals.into_iter().zip(genomes).zip(rows).map(|((individual, genes), [best, ..])| Best {
        individual: individual as u32,
        fitness: Fitness::nan_as_failed(*best),
        genes,
    });
    let before = (generation as usize).checked_sub(1).and_then(|before| run_record.observed.get(before)).cloned();
    let normalisation = if run_record.observed.is_empty() { None } else { before.or(plan.no_observations()?) };
    Ok(Some(Champions { identity: checkpoint.identity.clone(), generation, best: best.collect(), normalisation }))
}
