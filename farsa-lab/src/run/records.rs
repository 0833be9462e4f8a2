//! The sealed files of a run: where to go on, who descends from whom, who is best, and genotypes from elsewhere.
//!
//! Each search has kinds of its own, told by their first bytes; those of the truncation algorithm are as they were when
//! it was the only one.

use std::path::{Path, PathBuf};

use farsa_evo::{Coevolution, Fitness, Lineage, Lineages, OnePlusOne, OnePlusOneHistory, TruncationGa};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::experiment::evaluator::Evaluator;
use crate::run::plan::Plan;
use crate::search::engine::{Descent, Evolution};
use crate::search::learning::{Learning, Lessons};
use crate::store::directory::Directory;
use crate::store::identity::Identity;
use crate::store::log::Mark;
use crate::store::sealed;
use crate::store::sealed::Sealed;

/// `checkpoint.bin`: all that the next generation depends on.
#[derive(Debug)]
pub(crate) struct Checkpoint {
    pub(crate) identity: Identity,
    pub(crate) log: Mark,
    pub(crate) evolution: Evolution,
}

/// `lineage.bin`: all that any genome of the run is rebuilt from.
#[derive(Debug)]
pub(crate) struct Ancestry {
    pub(crate) identity: Identity,
    pub(crate) descent: Descent,
}

/// `champion.bin`: the best individual of the last generation, equals by index, in each population.
#[derive(Debug)]
pub(crate) struct Champions {
    pub(crate) identity: Identity,
    pub(crate) generation: u32,
    /// At least one.
    pub(crate) best: Vec<Best>,
}

/// The best individual of a population.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Best {
    /// Counted through all populations.
    pub(crate) individual: u32,
    pub(crate) fitness: Fitness,
    pub(crate) genes: Vec<u16>,
}

/// `genotypes.bin`: genotypes that no evolution of ours has made.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Imported {
    pub(crate) identity: Identity,
    pub(crate) genomes: Vec<Vec<u16>>,
}

/// The same of several populations, those of one after the other, as many of each.
#[derive(Debug, Serialize, Deserialize)]
struct ImportedSeveral {
    identity: Identity,
    genomes: Vec<Vec<u16>>,
    populations: usize,
}

#[derive(Serialize, Deserialize)]
struct CheckpointOf<E> {
    identity: Identity,
    log: Mark,
    evolution: E,
}

#[derive(Serialize, Deserialize)]
struct AncestryOf<L> {
    identity: Identity,
    lineage: L,
}

#[derive(Serialize, Deserialize)]
struct ChampionOfOne {
    identity: Identity,
    generation: u32,
    individual: u32,
    fitness: Fitness,
    genes: Vec<u16>,
}

#[derive(Serialize, Deserialize)]
struct ChampionsOfSeveral {
    identity: Identity,
    generation: u32,
    best: Vec<Best>,
}

/// Gives records their first bytes, their names and their owner.
macro_rules! sealed {
    ($($record:ty: $magic:literal, $kind:literal;)*) => {$(
        impl Sealed for $record {
            const MAGIC: [u8; 8] = *$magic;
            const KIND: &'static str = $kind;
        }

        impl Owned for $record {
            fn identity(&self) -> &Identity {
                &self.identity
            }
        }
    )*};
}

sealed! {
    CheckpointOf<TruncationGa>: b"farsachk", "checkpoint";
    CheckpointOf<OnePlusOne>: b"farsachs", "checkpoint of a steady-state search";
    CheckpointOf<Coevolution>: b"farsachc", "checkpoint of a co-evolution";
    CheckpointOf<Learning>: b"farsachl", "checkpoint of learning";
    AncestryOf<Lineage>: b"farsalin", "lineage";
    AncestryOf<OnePlusOneHistory>: b"farsalis", "lineage of a steady-state search";
    AncestryOf<Lineages>: b"farsalic", "lineage of a co-evolution";
    AncestryOf<Lessons>: b"farsalil", "record of lessons";
    ChampionOfOne: b"farsachm", "champion";
    ChampionsOfSeveral: b"farsacmc", "set of champions";
    Imported: b"farsagen", "set of genotypes";
    ImportedSeveral: b"farsagec", "set of genotypes of several populations";
}

/// A record that says which run it belongs to.
trait Owned: Sealed {
    fn identity(&self) -> &Identity;
}

/// Reads a record of the run that a plan describes, as it lies in `directory`.
fn read<T: Owned>(path: &Path, plan: &Plan<'_>, directory: &Directory) -> Result<T, Error> {
    let record: T = sealed::read(path)?;
    plan.same_run(record.identity(), directory.path())?;
    Ok(record)
}

impl Checkpoint {
    /// Writes the file.
    pub(crate) fn write(self, path: &Path) -> Result<(), Error> {
        let Self { identity, log, evolution } = self;
        match evolution {
            Evolution::Truncation(evolution) => sealed::write(path, &CheckpointOf { identity, log, evolution }),
            Evolution::OnePlusOne(evolution) => sealed::write(path, &CheckpointOf { identity, log, evolution }),
            Evolution::Several(evolution) => sealed::write(path, &CheckpointOf { identity, log, evolution }),
            Evolution::Learning(evolution) => sealed::write(path, &CheckpointOf { identity, log, evolution }),
        }
    }

    /// Reads the checkpoint of the run that a plan describes.
    ///
    /// # Errors
    /// [`Error::Usage`] in a directory of imported genotypes, [`Error::Damaged`], [`Error::OtherConfiguration`] or
    /// [`Error::OtherFile`] when the plan is another one than that of the record.
    pub(crate) fn read(plan: &Plan<'_>, directory: &Directory) -> Result<Self, Error> {
        let path = directory.checkpoint();
        evolved(directory)?;
        match sealed::magic(&path)? {
            Some(<CheckpointOf<OnePlusOne> as Sealed>::MAGIC) => {
                let CheckpointOf { identity, log, evolution } = read(&path, plan, directory)?;
                Ok(Self { identity, log, evolution: Evolution::OnePlusOne(evolution) })
            }
            Some(<CheckpointOf<Coevolution> as Sealed>::MAGIC) => {
                let CheckpointOf { identity, log, evolution } = read(&path, plan, directory)?;
                Ok(Self { identity, log, evolution: Evolution::Several(evolution) })
            }
            Some(<CheckpointOf<Learning> as Sealed>::MAGIC) => {
                let CheckpointOf { identity, log, evolution } = read(&path, plan, directory)?;
                Ok(Self { identity, log, evolution: Evolution::Learning(evolution) })
            }
            _ => {
                let CheckpointOf { identity, log, evolution } = read(&path, plan, directory)?;
                Ok(Self { identity, log, evolution: Evolution::Truncation(evolution) })
            }
        }
    }
}

/// Refuses a directory of imported genotypes.
///
/// # Errors
/// [`Error::Usage`].
pub(crate) fn evolved(directory: &Directory) -> Result<(), Error> {
    if directory.genotypes().is_file() && !directory.checkpoint().is_file() {
        let path = directory.path().display();
        return Err(Error::Usage(format!(
            "{path}: holds imported genotypes, which no evolution has made: they can be tested, replayed and drawn"
        )));
    }
    Ok(())
}

impl Ancestry {
    /// Writes the file; imported genotypes have one of their own.
    pub(crate) fn write(self, path: &Path) -> Result<(), Error> {
        let Self { identity, descent } = self;
        match descent {
            Descent::Truncation(lineage) => sealed::write(path, &AncestryOf { identity, lineage }),
            Descent::OnePlusOne(lineage) => sealed::write(path, &AncestryOf { identity, lineage }),
            Descent::Several(lineage) => sealed::write(path, &AncestryOf { identity, lineage }),
            Descent::Learned(lineage) => sealed::write(path, &AncestryOf { identity, lineage }),
            Descent::Imported { genomes, populations: 1 } => sealed::write(path, &Imported { identity, genomes }),
            Descent::Imported { genomes, populations } => {
                sealed::write(path, &ImportedSeveral { identity, genomes, populations })
            }
        }
    }

    /// Reads what the genomes of the run that a plan describes are rebuilt from, and says where that stands.
    ///
    /// # Errors
    /// As [`Checkpoint::read`].
    pub(crate) fn read(plan: &Plan<'_>, directory: &Directory) -> Result<(Self, PathBuf), Error> {
        let path = directory.genotypes();
        if path.is_file() {
            let (identity, genomes, populations) = if sealed::magic(&path)? == Some(ImportedSeveral::MAGIC) {
                let ImportedSeveral { identity, genomes, populations } = read(&path, plan, directory)?;
                (identity, genomes, populations)
            } else {
                let Imported { identity, genomes } = read(&path, plan, directory)?;
                (identity, genomes, 1)
            };
            return Ok((Self { identity, descent: Descent::Imported { genomes, populations } }, path));
        }
        let path = directory.lineage();
        let ancestry = match sealed::magic(&path)? {
            Some(<AncestryOf<OnePlusOneHistory> as Sealed>::MAGIC) => {
                let AncestryOf { identity, lineage } = read(&path, plan, directory)?;
                Self { identity, descent: Descent::OnePlusOne(lineage) }
            }
            Some(<AncestryOf<Lineages> as Sealed>::MAGIC) => {
                let AncestryOf { identity, lineage } = read(&path, plan, directory)?;
                Self { identity, descent: Descent::Several(lineage) }
            }
            Some(<AncestryOf<Lessons> as Sealed>::MAGIC) => {
                let AncestryOf { identity, lineage } = read(&path, plan, directory)?;
                Self { identity, descent: Descent::Learned(lineage) }
            }
            _ => {
                let AncestryOf { identity, lineage } = read(&path, plan, directory)?;
                Self { identity, descent: Descent::Truncation(lineage) }
            }
        };
        Ok((ancestry, path))
    }
}

impl Champions {
    /// Writes the file.
    pub(crate) fn write(&self, path: &Path) -> Result<(), Error> {
        let Self { identity, generation, best } = self;
        let (identity, generation) = (identity.clone(), *generation);
        if let [Best { individual, fitness, genes }] = best.as_slice() {
            let (individual, fitness, genes) = (*individual, *fitness, genes.clone());
            return sealed::write(path, &ChampionOfOne { identity, generation, individual, fitness, genes });
        }
        sealed::write(path, &ChampionsOfSeveral { identity, generation, best: best.clone() })
    }

    /// Reads the champions of the run that a plan describes.
    ///
    /// # Errors
    /// As [`Checkpoint::read`].
    pub(crate) fn read(plan: &Plan<'_>, directory: &Directory) -> Result<Self, Error> {
        let path = directory.champion();
        if sealed::magic(&path)? == Some(ChampionsOfSeveral::MAGIC) {
            let ChampionsOfSeveral { identity, generation, best } = read(&path, plan, directory)?;
            return Ok(Self { identity, generation, best });
        }
        let ChampionOfOne { identity, generation, individual, fitness, genes } = read(&path, plan, directory)?;
        Ok(Self { identity, generation, best: vec![Best { individual, fitness, genes }] })
    }

    /// The same where a generation is finished, and this program would compute the champions' lives as they were.
    ///
    /// # Errors
    /// Those of [`read`](Self::read), [`Error::OtherConfiguration`] for other values, [`Error::Damaged`] for genomes that are none
    /// of the experiment or when there is no champion yet.
    pub(crate) fn of(plan: &Plan<'_>, directory: &Directory, evaluator: &dyn Evaluator) -> Result<Self, Error> {
        let path = directory.champion();
        if !path.is_file() {
            return Err(Error::damaged(&path, "there is none: no generation is finished yet"));
        }
        let found = Self::read(plan, directory)?;
        found.identity.same_values(&plan.identity()?, &path)?;
        let genes = evaluator.parameters().len();
        if found.best.len() != evaluator.populations().len() || found.best.iter().any(|best| best.genes.len() != genes)
        {
            return Err(Error::damaged(&path, "its genome is not one of the experiment"));
        }
        Ok(found)
    }
}
