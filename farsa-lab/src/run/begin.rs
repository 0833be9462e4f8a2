//! How a run begins, and how it is taken up where its checkpoint left it.

use std::path::Path;

use farsa_evo::{EvoError, Record, Strategy};

use crate::error::Error;
use crate::run::plan::Plan;
use crate::run::records::{Checkpoint, ToldRecord};
use crate::store::directory::{Directory, replace};
use crate::store::lineage::{Lineage, rows};
use crate::store::log;
use crate::store::log::Log;
use crate::store::manifest::Manifest;

/// Makes the directory of a new run, ready for its first generation.
pub(crate) fn create(plan: &Plan<'_>, path: &Path) -> Result<Directory, Error> {
    let mut strategy = plan.strategy()?;
    let refused = |error: EvoError| Error::Other(format!("{}: {error}", plan.definition().name()));
    let record = Record::new(strategy.as_mut()).map_err(refused)?;
    let (text, identity, populations) = (plan.to_toml()?, plan.identity()?, strategy.populations());
    let state = strategy.snapshot().map(|strategy| strategy.save());
    Directory::create(path, |directory| {
        replace(&directory.config(), text.as_bytes())?;
        Manifest::new(&identity).write(&directory.manifest())?;
        replace(&directory.log(), log::header(populations).as_bytes())?;
        let lineage = match strategy.genealogy() {
            Some(_) => Lineage::create(&directory.lineage())?,
            None => 0,
        };
        let strategy = plan.definition().name().to_owned();
        ToldRecord { identity: identity.clone(), strategy, record }.write(&directory.record())?;
        let (log, diagnostics) = (Log::start(populations), Vec::new());
        Checkpoint { identity, generation: 0, log, lineage, diagnostics, state }.write(&directory.checkpoint())
    })
}

/// The strategy of a run as it was when its checkpoint was written, and what it had been told.
pub(crate) fn resumed(
    plan: &Plan<'_>,
    directory: &Directory,
    checkpoint: &Checkpoint,
) -> Result<(Box<dyn Strategy>, Record), Error> {
    let ToldRecord { mut record, .. } = ToldRecord::read(plan, directory)?;
    let path = directory.record();
    if record.generations() < checkpoint.generation {
        let (found, expected) = (record.generations(), checkpoint.generation);
        return Err(Error::damaged(&path, format!("{found} generations where checkpoint.bin speaks of {expected}")));
    }
    record.truncate(checkpoint.generation);
    let mut strategy = plan.strategy()?;
    record.check(strategy.as_ref()).map_err(|error| Error::damaged(&path, error))?;
    match (&checkpoint.state, strategy.snapshot()) {
        (Some(state), Some(strategy)) => {
            strategy.restore(state).map_err(|error| Error::damaged(&directory.checkpoint(), error))?;
        }
        _ => record.rebuild(strategy.as_mut(), checkpoint.generation).map_err(|error| Error::damaged(&path, error))?,
    }
    if strategy.generation() != checkpoint.generation {
        let (found, expected) = (strategy.generation(), checkpoint.generation);
        let why = format!("a strategy at generation {found} where {expected} are finished");
        return Err(Error::damaged(&directory.checkpoint(), why));
    }
    Ok((strategy, record))
}

/// Opens the lineage of a run that goes on, where its strategy has one.
pub(crate) fn lineage(
    plan: &Plan<'_>,
    directory: &Directory,
    checkpoint: &Checkpoint,
    record: &Record,
    strategy: &dyn Strategy,
) -> Result<Option<Lineage>, Error> {
    if strategy.genealogy().is_none() {
        return Ok(None);
    }
    let again = |append: &mut dyn FnMut(&str) -> Result<(), Error>| {
        let mut strategy = plan.strategy()?;
        for generation in 0..=checkpoint.generation {
            let rebuilt = record.rebuild(strategy.as_mut(), generation);
            rebuilt.map_err(|error| Error::damaged(&directory.record(), error))?;
            append(&rows(strategy.as_ref()))?;
        }
        Ok(())
    };
    Lineage::open(&directory.lineage(), checkpoint.lineage, again).map(Some)
}
