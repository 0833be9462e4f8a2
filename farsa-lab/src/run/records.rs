//! Checksummed files of a run, such as checkpoint, champions and imported genotypes.

use std::path::Path;

use farsa_evo::{Fitness, ObservationStatistics, Snapshot as _};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::experiment::evaluator::Evaluator;
use crate::limits::Limits;
use crate::run::plan::Plan;
use crate::store::append_log::Mark;
use crate::store::checksummed;
use crate::store::checksummed::Checksummed;
use crate::store::directory::Directory;
use crate::store::identity::Identity;
use crate::strategy::any_strategy::Genome;

/// Content of `checkpoint.bin`, from which a run continues. Its size does not grow.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Checkpoint {
    pub(crate) identity: Identity,
    /// Number of finished generations.
    pub(crate) generation: u32,
    /// Mark of `record.bin`.
    pub(crate) record: Mark,
    /// Mark of `lineage.csv`, if this file exists.
    pub(crate) lineage: Mark,
    /// Mark of `failures.csv`, if this file exists.
    pub(crate) failures: Mark,
    /// State of the strategy. If it has none, the complete record is replayed instead.
    pub(crate) state: Option<Vec<u8>>,
}

/// Head of `record.bin`, which identifies the run.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct RecordHead {
    pub(crate) identity: Identity,
    /// Name of the strategy.
    pub(crate) strategy: String,
}

/// `champion.bin`: the best individual of the last generation in each population, the first of equal fitness. For a strategy
/// [with a best-ever champion](farsa_evo::Strategy::champion_is_best_ever), that of all generations.
#[derive(Debug)]
pub(crate) struct Champions {
    pub(crate) identity: Identity,
    pub(crate) generation: u32,
    /// At least one.
    pub(crate) best: Vec<Best>,
    /// Normalization of observations in this generation, if there is any.
    pub(crate) normalisation: Option<ObservationStatistics>,
}

/// Best individual of a population.
#[derive(Debug, Clone)]
pub(crate) struct Best {
    /// Index in the generation, counted through all populations.
    pub(crate) individual: u32,
    pub(crate) fitness: Fitness,
    pub(crate) genes: Genome,
}

/// Best individual with genes of one type.
#[derive(Serialize, Deserialize)]
struct BestOf<G> {
    individual: u32,
    fitness: Fitness,
    genes: Vec<G>,
}

impl<G> BestOf<G> {
    fn of(self, genome: fn(Vec<G>) -> Genome) -> Best {
        Best { individual: self.individual, fitness: self.fitness, genes: genome(self.genes) }
    }
}

/// `genotypes.bin`: imported genotypes.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Imported {
    pub(crate) identity: Identity,
    pub(crate) genomes: Vec<Vec<u16>>,
}

/// Imported genotypes of several populations, one population after the other, all of the same size.
#[derive(Debug, Serialize, Deserialize)]
struct ImportedSeveral {
    identity: Identity,
    genomes: Vec<Vec<u16>>,
    populations: usize,
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
    best: Vec<BestOf<u16>>,
}

/// Champions with real genes.
#[derive(Serialize, Deserialize)]
struct ChampionsOfReals {
    identity: Identity,
    generation: u32,
    best: Vec<BestOf<f64>>,
}

/// Champions with normalized observations, all with integer genes or all with real genes.
#[derive(Serialize, Deserialize)]
struct ChampionsNormalised {
    identity: Identity,
    generation: u32,
    words: Vec<BestOf<u16>>,
    reals: Vec<BestOf<f64>>,
    /// State of [`ObservationStatistics`].
    normalisation: Vec<u8>,
}

/// Implements the first bytes, the name, the largest size and the owner of records.
macro_rules! sealed {
    ($($record:ty: $magic:literal, $kind:literal, $largest:expr;)*) => {$(
        impl Checksummed for $record {
            const MAGIC: [u8; 8] = *$magic;
            const KIND: &'static str = $kind;
            const MAX_BYTES: u64 = $largest;
        }

        impl Owned for $record {
            fn identity(&self) -> &Identity {
                &self.identity
            }
        }
    )*};
}

sealed! {
    Checkpoint: b"farsackp", "checkpoint", Limits::DEFAULT.state_bytes + (1 << 20);
    RecordHead: b"farsatld", "record of the fitness that a strategy received", 1 << 20;
    ChampionOfOne: b"farsachm", "champion", 64 << 20;
    ChampionsOfSeveral: b"farsacmc", "set of champions", 64 << 20;
    ChampionsOfReals: b"farsacmr", "set of champions with real genes", 256 << 20;
    ChampionsNormalised: b"farsacmn", "set of champions with normalised observations", 256 << 20;
    Imported: b"farsagen", "set of genotypes", 1 << 30;
    ImportedSeveral: b"farsagec", "set of genotypes of several populations", 1 << 30;
}

/// A record with the identity of its run.
trait Owned: Checksummed {
    fn identity(&self) -> &Identity;
}

/// Reads a record of a planned run in `directory`.
fn read<T: Owned>(path: &Path, plan: &Plan<'_>, directory: &Directory) -> Result<T, Error> {
    let record: T = checksummed::read(path)?;
    plan.same_run(record.identity(), directory.path())?;
    Ok(record)
}

/// Refuses a directory that cannot be continued or rebuilt: imported genotypes, or a run of an earlier version.
///
/// # Errors
/// [`Error::Usage`] with advice.
pub(crate) fn evolved(directory: &Directory) -> Result<(), Error> {
    let path = directory.path().display();
    if directory.genotypes().is_file() && !directory.checkpoint().is_file() {
        return Err(Error::Usage(format!(
            "{path}: holds imported genotypes, which no evolution has made: they can be tested, replayed and drawn"
        )));
    }
    earlier(directory)
}

/// Refuses the run of an earlier version, whose generations were rebuilt from a lineage.
fn earlier(directory: &Directory) -> Result<(), Error> {
    if directory.earlier_lineage().is_file() && !directory.record().is_file() {
        let (path, config) = (directory.path().display(), directory.config());
        return Err(Error::Usage(format!(
            "{path}: has a lineage.bin of an earlier version of FARSA in place of record.bin: it can be tested and \
             exported, and `run --config {} --out NEW` makes it again with the same numbers",
            config.display()
        )));
    }
    Ok(())
}

impl Checkpoint {
    /// Reads the checkpoint of a planned run.
    ///
    /// # Errors
    /// [`Error::Usage`] in a directory of imported genotypes or of an earlier version, [`Error::File`],
    /// [`Error::Usage`] or [`Error::File`] for the record of another run.
    pub(crate) fn read(plan: &Plan<'_>, directory: &Directory) -> Result<Self, Error> {
        evolved(directory)?;
        read(&directory.checkpoint(), plan, directory)
    }

    /// Writes the file.
    pub(crate) fn write(&self, path: &Path) -> Result<(), Error> {
        checksummed::write(path, self)
    }
}

/// Reads imported genotypes, one population after the other, with their identity and the number of populations.
///
/// # Errors
/// As [`Checkpoint::read`].
pub(crate) fn imported(plan: &Plan<'_>, directory: &Directory) -> Result<(Identity, Vec<Vec<u16>>, usize), Error> {
    let path = directory.genotypes();
    if checksummed::magic(&path)? == Some(ImportedSeveral::MAGIC) {
        let ImportedSeveral { identity, genomes, populations } = read(&path, plan, directory)?;
        return Ok((identity, genomes, populations));
    }
    let Imported { identity, genomes } = read(&path, plan, directory)?;
    Ok((identity, genomes, 1))
}

/// Writes imported genotypes, one population after the other.
///
/// # Errors
/// [`Error::Io`].
pub(crate) fn write_imported(
    path: &Path,
    identity: Identity,
    genomes: Vec<Vec<u16>>,
    populations: usize,
) -> Result<(), Error> {
    if populations == 1 {
        checksummed::write(path, &Imported { identity, genomes })
    } else {
        checksummed::write(path, &ImportedSeveral { identity, genomes, populations })
    }
}

impl Champions {
    /// Gets the fitness of the first population's champion.
    pub(crate) fn fitness(&self) -> Option<Fitness> {
        self.best.first().map(|best| best.fitness)
    }

    /// Writes the file.
    pub(crate) fn write(&self, path: &Path) -> Result<(), Error> {
        let Self { identity, generation, best, normalisation } = self;
        let (identity, generation) = (identity.clone(), *generation);
        // All genes are of one type.
        let (mut words, mut reals) = (Vec::new(), Vec::new());
        for Best { individual, fitness, genes } in best {
            let (individual, fitness) = (*individual, *fitness);
            match genes.clone() {
                Genome::Words(genes) => words.push(BestOf { individual, fitness, genes }),
                Genome::Reals(genes) => reals.push(BestOf { individual, fitness, genes }),
            }
        }
        if let Some(statistics) = normalisation {
            let normalisation = statistics.save();
            return checksummed::write(
                path,
                &ChampionsNormalised { identity, generation, words, reals, normalisation },
            );
        }
        if !reals.is_empty() {
            return checksummed::write(path, &ChampionsOfReals { identity, generation, best: reals });
        }
        if words.len() == 1 {
            let BestOf { individual, fitness, genes } = words.swap_remove(0);
            return checksummed::write(path, &ChampionOfOne { identity, generation, individual, fitness, genes });
        }
        checksummed::write(path, &ChampionsOfSeveral { identity, generation, best: words })
    }

    /// Reads the champions of a planned run.
    ///
    /// # Errors
    /// As [`Checkpoint::read`].
    pub(crate) fn read(plan: &Plan<'_>, directory: &Directory) -> Result<Self, Error> {
        let path = directory.champion();
        let magic = checksummed::magic(&path)?;
        if magic == Some(ChampionsNormalised::MAGIC) {
            let ChampionsNormalised { identity, generation, words, reals, normalisation } =
                read(&path, plan, directory)?;
            let words = words.into_iter().map(|best| best.of(Genome::Words));
            let best = words.chain(reals.into_iter().map(|best| best.of(Genome::Reals))).collect();
            let normalisation = ObservationStatistics::from_saved(&normalisation);
            let normalisation = Some(normalisation.map_err(|error| Error::damaged(&path, error))?);
            return Ok(Self { identity, generation, best, normalisation });
        }
        let normalisation = None;
        if magic == Some(ChampionsOfReals::MAGIC) {
            let ChampionsOfReals { identity, generation, best } = read(&path, plan, directory)?;
            return Ok(Self {
                identity,
                generation,
                best: best.into_iter().map(|best| best.of(Genome::Reals)).collect(),
                normalisation,
            });
        }
        if magic == Some(ChampionsOfSeveral::MAGIC) {
            let ChampionsOfSeveral { identity, generation, best } = read(&path, plan, directory)?;
            return Ok(Self {
                identity,
                generation,
                best: best.into_iter().map(|best| best.of(Genome::Words)).collect(),
                normalisation,
            });
        }
        let ChampionOfOne { identity, generation, individual, fitness, genes } = read(&path, plan, directory)?;
        let best = vec![Best { individual, fitness, genes: Genome::Words(genes) }];
        Ok(Self { identity, generation, best, normalisation })
    }

    /// Reads the champions of a run with a finished generation, whose trials this program computes in the same way.
    ///
    /// # Errors
    /// The errors of [`read`](Self::read), [`Error::File`] for other values, [`Error::File`] for genomes of another
    /// experiment or before the first generation.
    pub(crate) fn read_checked(
        plan: &Plan<'_>,
        directory: &Directory,
        evaluator: &dyn Evaluator,
    ) -> Result<Self, Error> {
        let path = directory.champion();
        if !path.is_file() {
            return Err(Error::damaged(&path, "there is none: no generation is finished yet"));
        }
        let champions = Self::read(plan, directory)?;
        champions.identity.same_values(&plan.identity()?, &path)?;
        let genes = evaluator.info().parameters.len();
        if champions.best.len() != evaluator.info().populations.len()
            || champions.best.iter().any(|best| best.genes.len() != genes)
        {
            return Err(Error::damaged(&path, "its genome is not one of the experiment"));
        }
        let channels = |statistics: &ObservationStatistics| statistics.channels() != evaluator.info().observations;
        if champions.normalisation.as_ref().is_some_and(channels) {
            return Err(Error::damaged(&path, "its observations are not those of the experiment"));
        }
        Ok(champions)
    }
}
