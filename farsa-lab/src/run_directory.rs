//! The files of a run, for programs that analyze runs.

use std::path::Path;

use farsa_evo::ObservationStatistics;

use crate::error::Error;
#[cfg(feature = "command")]
use crate::evaluation::{TestTrial, test};
use crate::experiment::evaluator::Evaluator;
use crate::experiment::genotype::Genotype;
use crate::experiment::settings::Settings;
use crate::run::config_file::ConfigFile;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::run::record_file::{RunRecord, history};
use crate::run::records::{Champions, Checkpoint};
use crate::store::directory::Directory;
use crate::store::log::Line;
use crate::strategy::history::History;

/// The directory of a run, read without changing it.
///
/// ```no_run
/// use std::path::Path;
///
/// use farsa_lab::{Error, Evaluation, EpisodeId, Experiment, Laboratory};
/// use farsa_lab::advanced::RunDirectory;
///
/// fn analyze(path: &Path, experiments: &[&dyn Experiment]) -> Result<(), Error> {
///     let laboratory = Laboratory::new(experiments);
///     let run = RunDirectory::open(path, &laboratory)?;
///     println!("{} under {}, seed {}", run.experiment(), run.strategy(), run.seed());
///     let record = run.record()?;
///     for (generation, row) in record.log().iter().enumerate() {
///         println!("{generation}: best {}, mean {}", row.best, row.mean);
///     }
///     // The individuals of the first generation, and the champion in one more trial.
///     println!("{:?}", record.parameters(0)?);
///     let champion = run.champion()?;
///     let id = EpisodeId { seed: 7, ..EpisodeId::default() };
///     let evaluation = Evaluation { normalisation: champion.normalisation.as_ref(), ..Evaluation::new(&champion.parameters[0], id) };
///     println!("{:?}", run.evaluator()?.evaluate(evaluation, None).terms);
///     Ok(())
/// }
/// ```
pub struct RunDirectory<'l> {
    directory: Directory,
    plan: Plan<'l>,
}

/// The champion of each population.
#[derive(Debug, Clone)]
pub struct RunChampion {
    /// The generation of the champions, from 0.
    pub generation: u32,
    /// Their numbers in the generation, counted through all populations.
    pub individuals: Vec<u32>,
    /// Their fitness.
    pub fitness: Vec<f64>,
    /// Their parameters.
    pub parameters: Vec<Vec<f32>>,
    /// The normalization of their observations, where observations are normalized:
    /// [`Evaluation::normalisation`](crate::Evaluation::normalisation).
    pub normalisation: Option<ObservationStatistics>,
}

/// The fitness of a generation.
#[derive(Debug, Clone, PartialEq)]
pub struct LogRow {
    /// The largest fitness.
    pub best: f64,
    /// The mean fitness.
    pub mean: f64,
    /// The smallest fitness.
    pub worst: f64,
    /// Best, mean and worst of each population, where there are several.
    pub populations: Vec<[f64; 3]>,
    /// Number of evaluated individuals.
    pub evaluations: u64,
    /// Number of individuals with a failed trial.
    pub failed: u64,
}

/// All finished generations of a run.
pub struct GenerationRecord<'r> {
    rows: Vec<LogRow>,
    history: History<'r>,
    genotype: Genotype,
}

impl<'l> RunDirectory<'l> {
    /// Opens the directory of a run of an experiment and a strategy of a laboratory.
    ///
    /// # Errors
    /// [`Error::File`] for a directory without a run, and the errors of an invalid configuration.
    pub fn open(path: &Path, laboratory: &Laboratory<'l>) -> Result<Self, Error> {
        let directory = Directory::open(path)?;
        let plan = Plan::from_file(laboratory, &ConfigFile::read_regular(&directory.config())?)?;
        Ok(Self { directory, plan })
    }

    /// Returns the path of the directory.
    pub fn path(&self) -> &Path {
        self.directory.path()
    }

    /// Returns the name of the experiment.
    pub fn experiment(&self) -> &str {
        self.plan.experiment.name()
    }

    /// Returns the condition, which is empty for an experiment without conditions.
    pub fn condition(&self) -> &str {
        &self.plan.condition
    }

    /// Returns the name of the strategy.
    pub fn strategy(&self) -> &str {
        self.plan.definition().name()
    }

    /// Returns the seed.
    pub fn seed(&self) -> u64 {
        self.plan.seed
    }

    /// Returns all settings.
    pub fn settings(&self) -> &Settings {
        &self.plan.settings
    }

    /// Returns the complete configuration as TOML, with the documentation of every setting.
    ///
    /// # Errors
    /// [`Error::Setting`] for a setting without a value.
    pub fn config(&self) -> Result<String, Error> {
        self.plan.to_toml()
    }

    /// Prepares the experiment for evaluations.
    ///
    /// # Errors
    /// The errors of [`Experiment::prepare`](crate::Experiment::prepare).
    pub fn evaluator(&self) -> Result<Box<dyn Evaluator>, Error> {
        self.plan.evaluator()
    }

    /// Reads the champion of each population.
    ///
    /// # Errors
    /// [`Error::File`] before the first generation and for an invalid file, and [`Error::File`] for a run whose trials
    /// this program computes differently.
    pub fn champion(&self) -> Result<RunChampion, Error> {
        let evaluator = self.evaluator()?;
        let champions = Champions::read_checked(&self.plan, &self.directory, evaluator.as_ref())?;
        let Champions { generation, best, normalisation, .. } = champions;
        let genotype = self.plan.genotype(evaluator.as_ref());
        let parameters = best.iter().map(|best| best.genes.decode(&genotype)).collect::<Option<_>>();
        let invalid = || Error::damaged(&self.directory.champion(), "its genome is not one of the experiment");
        Ok(RunChampion {
            generation,
            individuals: best.iter().map(|best| best.individual).collect(),
            fitness: best.iter().map(|best| best.fitness.get()).collect(),
            parameters: parameters.ok_or_else(invalid)?,
            normalisation,
        })
    }

    /// Reads all finished generations. Imported genotypes are one generation without a log.
    ///
    /// # Errors
    /// [`Error::File`] for an invalid checkpoint or record.
    pub fn record(&self) -> Result<GenerationRecord<'_>, Error> {
        let genotype = self.plan.genotype(self.evaluator()?.as_ref());
        if self.directory.genotypes().is_file() {
            let (_, history, _) = history(&self.plan, &self.directory)?;
            return Ok(GenerationRecord { rows: Vec::new(), history, genotype });
        }
        let checkpoint = Checkpoint::read(&self.plan, &self.directory)?;
        let RunRecord { record, lines, .. } = RunRecord::read(&self.plan, &self.directory, &checkpoint)?;
        Ok(GenerationRecord {
            rows: lines.into_iter().map(LogRow::from).collect(),
            history: History::new(self.directory.record(), record, self.plan.fresh()),
            genotype,
        })
    }

    /// Reads the trials of the last `farsa test`. The result is empty if the champion was never tested.
    ///
    /// # Errors
    /// [`Error::File`] for an invalid table.
    #[cfg(feature = "command")]
    pub fn test(&self) -> Result<Vec<TestTrial>, Error> {
        let Some((table, _)) = test::read(&self.directory)? else { return Ok(Vec::new()) };
        Ok(table.trials())
    }
}

impl From<Line> for LogRow {
    fn from(line: Line) -> Self {
        let Line { row: [best, mean, worst], each, evaluations, failed } = line;
        Self { best, mean, worst, populations: each, evaluations, failed }
    }
}

impl GenerationRecord<'_> {
    /// Returns the fitness of each generation.
    pub fn log(&self) -> &[LogRow] {
        &self.rows
    }

    /// Rebuilds the parameters of all individuals of a generation, those of one population after the other.
    ///
    /// # Errors
    /// [`Error::File`] for a generation that is not finished, and for genomes of another strategy.
    pub fn parameters(&self, generation: u32) -> Result<Vec<Vec<f32>>, Error> {
        let mut parameters = Vec::new();
        self.history.visit([generation], |_, genomes| {
            for individual in 0..self.history.populations() * self.history.size() {
                let genome = genomes.get(individual).and_then(|genome| genome.decode(&self.genotype));
                parameters.push(genome.ok_or_else(|| self.history.missing(generation))?);
            }
            Ok(())
        })?;
        Ok(parameters)
    }
}
