//! The three sealed files of a run: where to go on, who descends from whom, and who is best.

use std::path::Path;

use farsa_evo::{Fitness, Lineage, TruncationGa};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::log::Mark;
use crate::plan::{Identity, Plan};
use crate::sealed::{self, Sealed};

/// `checkpoint.bin`: all that the next generation depends on.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Checkpoint {
    pub(crate) identity: Identity,
    pub(crate) log: Mark,
    pub(crate) evolution: TruncationGa,
}

/// `lineage.bin`: all that any genome of the run is rebuilt from.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Ancestry {
    pub(crate) identity: Identity,
    pub(crate) lineage: Lineage,
}

/// `champion.bin`: the best individual of the last generation, equals by index.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Champion {
    pub(crate) identity: Identity,
    pub(crate) generation: u32,
    pub(crate) individual: u32,
    pub(crate) fitness: Fitness,
    pub(crate) genes: Vec<u16>,
}

impl Sealed for Checkpoint {
    const MAGIC: [u8; 8] = *b"farsachk";
    const KIND: &'static str = "checkpoint";
}

impl Sealed for Ancestry {
    const MAGIC: [u8; 8] = *b"farsalin";
    const KIND: &'static str = "lineage";
}

impl Sealed for Champion {
    const MAGIC: [u8; 8] = *b"farsachm";
    const KIND: &'static str = "champion";
}

/// A record that says which run it belongs to.
pub(crate) trait Owned: Sealed {
    fn identity(&self) -> &Identity;
}

impl Owned for Checkpoint {
    fn identity(&self) -> &Identity {
        &self.identity
    }
}

impl Owned for Ancestry {
    fn identity(&self) -> &Identity {
        &self.identity
    }
}

impl Owned for Champion {
    fn identity(&self) -> &Identity {
        &self.identity
    }
}

/// Reads a record of the run that a plan describes, as it lies in `directory`.
///
/// # Errors
/// [`Error::Damaged`], [`Error::OtherConfiguration`] when the plan is another one than that of the record.
pub(crate) fn read<T: Owned>(path: &Path, plan: &Plan<'_>, directory: &Path) -> Result<T, Error> {
    let record: T = sealed::read(path)?;
    record.identity().same_run(&plan.identity(), directory)?;
    Ok(record)
}
