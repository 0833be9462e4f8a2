//! The best of a run, for comparisons that the command does not make.

use std::path::Path;

use farsa_evo::ObservationStatistics;

use crate::error::Error;
use crate::experiment::definition::Experiment;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::settings::Settings;
use crate::run::config_file::ConfigFile;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::run::records::Champions;
use crate::store::directory::Directory;

/// What a run has come to: its configuration, and the best of its last finished generation.
pub struct BestOfRun {
    /// The experiment's name.
    pub experiment: String,
    /// The condition; empty if there are none.
    pub condition: String,
    /// The name of the strategy.
    pub strategy: String,
    /// The seed.
    pub seed: u64,
    /// Every setting.
    pub settings: Settings,
    /// The last finished generation, from 0.
    pub generation: u32,
    /// The parameters of the best of each population.
    pub parameters: Vec<Vec<f32>>,
    /// By what observations are normalised, where they are: [`Evaluation::normalisation`](crate::Evaluation::normalisation).
    pub normalisation: Option<ObservationStatistics>,
    /// The experiment, ready to be evaluated.
    pub evaluator: Box<dyn Evaluator>,
}

impl BestOfRun {
    /// Reads it from the directory of a run of one of these experiments.
    ///
    /// # Errors
    /// [`Error`] for a directory without a run, or with one that is damaged, of another experiment or of another version.
    pub fn read(directory: &Path, experiments: &[&dyn Experiment]) -> Result<Self, Error> {
        Self::read_in(directory, &Laboratory::new(experiments))
    }

    /// The same of a run by any strategy of a laboratory.
    ///
    /// # Errors
    /// Those of [`read`](Self::read).
    pub fn read_in(directory: &Path, laboratory: &Laboratory<'_>) -> Result<Self, Error> {
        let directory = Directory::open(directory)?;
        let plan = Plan::from_file(laboratory, &ConfigFile::read(&directory.config())?)?;
        let evaluator = plan.evaluator()?;
        let genotype = plan.genotype(evaluator.as_ref());
        let Champions { generation, best, normalisation, .. } =
            Champions::read_checked(&plan, &directory, evaluator.as_ref())?;
        Ok(Self {
            experiment: plan.experiment.name().into(),
            strategy: plan.definition().name().into(),
            condition: plan.condition,
            seed: plan.seed,
            settings: plan.settings,
            generation,
            parameters: best.iter().filter_map(|best| best.genes.decode(&genotype)).collect(),
            normalisation,
            evaluator,
        })
    }
}
