//! Files of a run, for programs that analyze runs.

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

/// Directory of a run. It is only read, and never changed.
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

/// Champions of all populations of a run.
#[derive(Debug, Clone)]
pub struct RunChampion {
    /// Generation in which they were evaluated, from 0.
    pub generation: u32,
    /// Index of each champion in the generation. Individuals are counted through all populations.
    pub individuals: Vec<u32>,
    /// Fitness of each champion.
    pub fitness: Vec<f64>,
    /// Parameters of each champion.
    pub parameters: Vec<Vec<f32>>,
    /// Statistics that normalize the observations, as in
    /// [`Evaluation::normalisation`](crate::Evaluation::normalisation). This is `None` unless observations are
    /// normalized.
    pub normalisation: Option<ObservationStatistics>,
}

/// Fitness of a single generation.
#[derive(Debug, Clone, PartialEq)]
pub struct LogRow {
    /// Best fitness.
    pub best: f64,
    /// Mean fitness.
    pub mean: f64,
    /// Worst fitness.
    pub worst: f64,
    /// Best, mean and worst fitness of each population. This is empty if there is only one population.
    pub populations: Vec<[f64; 3]>,
    /// Number of individuals that were evaluated.
    pub evaluations: u64,
    /// Number of individuals for which a trial failed.
    pub failed: u64,
}

/// Record of all finished generations of a run. You can use it to rebuild any individual.
pub struct GenerationRecord<'r> {
    rows: Vec<LogRow>,
    history: History<'r>,
    genotype: Genotype,
}

impl<'l> RunDirectory<'l> {
    /// Opens the directory of a run. Its experiment and its strategy must be part of the laboratory.
    ///
    /// # Errors
    /// Returns [`Error::File`] if there is no run in this directory, or other errors if its configuration is invalid.
    pub fn open(path: &Path, laboratory: &Laboratory<'l>) -> Result<Self, Error> {
        let directory = Directory::open(path)?;
        let plan = Plan::from_file(laboratory, &ConfigFile::read_regular(&directory.config())?)?;
        Ok(Self { directory, plan })
    }

    /// Gets the path of this directory.
    pub fn path(&self) -> &Path {
        self.directory.path()
    }

    /// Gets the name of the experiment.
    pub fn experiment(&self) -> &str {
        self.plan.experiment.name()
    }

    /// Gets the condition. This is empty if the experiment has no conditions.
    pub fn condition(&self) -> &str {
        &self.plan.condition
    }

    /// Gets the name of the strategy.
    pub fn strategy(&self) -> &str {
        self.plan.definition().name()
    }

    /// Gets the seed of the run.
    pub fn seed(&self) -> u64 {
        self.plan.seed
    }

    /// Gets the values of all settings.
    pub fn settings(&self) -> &Settings {
        &self.plan.settings
    }

    /// Writes the complete configuration as TOML, including the documentation of every setting.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if a setting has no value.
    pub fn config(&self) -> Result<String, Error> {
        self.plan.to_toml()
    }

    /// Prepares the experiment, so that you can evaluate individuals by yourself.
    ///
    /// # Errors
    /// Returns the errors of [`Experiment::prepare`](crate::Experiment::prepare).
    pub fn evaluator(&self) -> Result<Box<dyn Evaluator>, Error> {
        self.plan.evaluator()
    }

    /// Reads the champion of each population.
    ///
    /// # Errors
    /// Returns [`Error::File`] if there is no generation yet, or if the file is invalid. You also get this error if
    /// this version of the program would compute different trials.
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

    /// Reads all finished generations.
    ///
    /// Note that imported genotypes are a single generation without a log.
    ///
    /// # Errors
    /// Returns [`Error::File`] if the checkpoint or the record is invalid.
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

    /// Reads the trials of the last `farsa test`. If the champion was never tested, the list is empty.
    ///
    /// # Errors
    /// Returns [`Error::File`] if the table is invalid.
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
    /// Gets the fitness of all generations, starting with the first one.
    pub fn log(&self) -> &[LogRow] {
        &self.rows
    }

    /// Rebuilds the parameters of all individuals of a generation.
    ///
    /// If there are several populations, their individuals follow one after the other.
    ///
    /// # Errors
    /// Returns [`Error::File`] if the generation is not finished, or if the genomes belong to another strategy.
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
