//! Arguments of the subcommands for external genotypes.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use crate::command::arguments::shared::{VariantArgs, WorkerArgs, whole};
use crate::error::Error;
use crate::evaluation::evaluate::GeneArguments;
use crate::experiment::settings::Value;
use crate::limits::MAX_TRIALS;
use crate::run::experiment::Experiment;
use crate::run::plan::{MAX_SEED, Plan};

/// The setting of `--ir-tables`.
const INFRARED_TABLES: &str = "robot.infrared_tables";
const IR_TABLES: &str = "Tables of the infrared sensors (robot.infrared_tables)";

/// The condition, settings and tables that genotypes belong to.
#[derive(Args)]
pub(crate) struct GenotypeVariant {
    #[command(flatten)]
    pub(crate) variant: VariantArgs,
    #[arg(long, value_name = "DIR", help = IR_TABLES, value_hint = ValueHint::DirPath)]
    pub(crate) ir_tables: Option<PathBuf>,
}

impl GenotypeVariant {
    /// Returns the plan of an experiment under this condition with these settings and tables.
    ///
    /// # Errors
    /// [`Error::Setting`] and [`Error::Setting`], and [`Error::Usage`] for tables without a setting of the experiment.
    pub(crate) fn plan<'e>(&self, experiment: &'e dyn Experiment) -> Result<Plan<'e>, Error> {
        let mut plan = self.variant.plan(experiment)?;
        if let Some(directory) = &self.ir_tables {
            if !plan.settings.table().iter().any(|setting| setting.key() == INFRARED_TABLES) {
                let (name, condition) = (experiment.name(), &plan.condition);
                let under =
                    if condition.is_empty() { String::new() } else { format!(" under condition `{condition}`") };
                let why = format!("--ir-tables: {name} has no setting `{INFRARED_TABLES}`{under}");
                return Err(Error::Usage(why));
            }
            let text = directory.to_str().ok_or_else(|| {
                Error::Usage(format!("--ir-tables: {}: the name is not Unicode", directory.display()))
            })?;
            plan.settings.set("--ir-tables", INFRARED_TABLES, Value::Word(text.into()))?;
        }
        Ok(plan)
    }

    /// Returns true without any option.
    pub(crate) fn is_empty(&self) -> bool {
        self.ir_tables.is_none() && self.variant.condition.is_none() && self.variant.set.is_empty()
    }

    /// Returns the first value of `--set` for a setting.
    pub(crate) fn set(&self, key: &str) -> Option<&Value> {
        self.variant.set.iter().find(|(set, _)| set == key).map(|(_, value)| value)
    }
}

#[derive(Args)]
#[command(allow_negative_numbers = true)]
pub(crate) struct EvaluateArgs {
    /// The experiment
    pub(crate) experiment: String,
    #[command(flatten)]
    pub(crate) variant: GenotypeVariant,
    /// Genes as integers with commas, once per population, in order or by name
    #[arg(long, value_name = "[NAME=]G,G,...", allow_hyphen_values = true, required_unless_present_any = ["genes_file", "stdin"])]
    pub(crate) genes: Vec<String>,
    /// A .gen file of the original FARSA or a list, once per population
    #[arg(long, value_name = "[NAME=]FILE", value_hint = ValueHint::FilePath)]
    pub(crate) genes_file: Vec<PathBuf>,
    /// The genotype in the file, from 0, once per file [default: the only one]
    #[arg(long, value_name = "N", requires = "genes_file")]
    pub(crate) genotype: Vec<usize>,
    /// Read parameters as JSON lines and answer each with a line, in the trials of a run, for custom optimizers
    #[arg(long, conflicts_with_all = ["genes", "genes_file", "trials", "json"])]
    pub(crate) stdin: bool,
    /// Random trials
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = whole(1..=MAX_TRIALS))]
    pub(crate) trials: u32,
    /// The seed, as in a test (with --stdin as in a run)
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole(0..=MAX_SEED))]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) workers: WorkerArgs,
    /// Write JSON
    #[arg(long)]
    pub(crate) json: bool,
}

impl EvaluateArgs {
    pub(crate) fn genes(&self) -> GeneArguments {
        GeneArguments { lists: self.genes.clone(), files: self.genes_file.clone(), numbers: self.genotype.clone() }
    }
}

#[derive(Args)]
#[command(allow_negative_numbers = true)]
pub(crate) struct ImportArgs {
    /// .gen files, whose first genotype becomes the champion, one per population or POPULATION=FILE, or a configuration
    /// (.ini, .conf) of the original FARSA
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) files: Vec<PathBuf>,
    /// The experiment of the genotypes
    #[arg(long, value_name = "NAME")]
    pub(crate) experiment: Option<String>,
    #[command(flatten)]
    pub(crate) variant: GenotypeVariant,
    /// The seed of replayed trials [default: 1]
    #[arg(long, value_name = "N", value_parser = whole(0..=MAX_SEED))]
    pub(crate) seed: Option<u64>,
    /// The new directory, or for a configuration the new file [default: NAME.toml]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::AnyPath)]
    pub(crate) out: Option<PathBuf>,
    /// Write nothing if a line of a configuration cannot be converted exactly
    #[arg(long)]
    pub(crate) strict: bool,
    /// Write the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
