//! Arguments of `farsa export`, with the formats of files.

use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Args, Subcommand, ValueEnum, ValueHint};

use crate::command::arguments::shared::{VariantArgs, whole};
use crate::export::files::{ControllerFormat, ModelFormat};
use crate::run::plan::MAX_SEED;

#[derive(Args)]
pub(crate) struct ExportArgs {
    #[command(subcommand)]
    pub(crate) what: ExportWhat,
}

#[derive(Subcommand)]
pub(crate) enum ExportWhat {
    /// Write the robot and its surroundings as a model file
    Robot(ExportRobotArgs),
    /// Write the controller of a champion with its sensors and motors
    Controller(ExportControllerArgs),
    /// Write the genes of a champion as a .gen file, for `import` and `evaluate`
    Genotype(ExportGenotypeArgs),
    /// Write the starts of the trials of `test`
    Starts(ExportStartsArgs),
}

#[derive(Args)]
pub(crate) struct ExportControllerArgs {
    /// The run's directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) directory: PathBuf,
    /// The population, where there are several
    #[arg(long, value_name = "NAME")]
    pub(crate) population: Option<String>,
    /// The format of the file
    #[arg(long, value_enum)]
    pub(crate) format: ControllerFormat,
    /// A new file [default: standard output, for C controller.c]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Args)]
pub(crate) struct ExportGenotypeArgs {
    /// The run's directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) directory: PathBuf,
    /// The population, where there are several
    #[arg(long, value_name = "NAME")]
    pub(crate) population: Option<String>,
    /// A new file [default: standard output]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Args)]
pub(crate) struct ExportStartsArgs {
    /// The run's directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) directory: PathBuf,
    /// The number of trials
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = whole(1_u32..=1_000_000))]
    pub(crate) trials: u32,
    /// The seed of the test
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole(0..=MAX_SEED))]
    pub(crate) seed: u64,
    /// The format of the file
    #[arg(long, value_enum)]
    pub(crate) format: DataFormat,
    /// A new file [default: standard output]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Args)]
#[command(allow_negative_numbers = true)]
pub(crate) struct ExportRobotArgs {
    /// The experiment or the directory of a run, for its champion where bodies evolve
    #[arg(value_name = "EXPERIMENT")]
    pub(crate) experiment: String,
    /// The population of a run, where there are several
    #[arg(long, value_name = "NAME")]
    pub(crate) population: Option<String>,
    #[command(flatten)]
    pub(crate) variant: VariantArgs,
    /// The format of the file
    #[arg(long, value_enum)]
    pub(crate) format: ModelFormat,
    /// A new file [default: standard output]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) out: Option<PathBuf>,
}

/// The formats of starts.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum DataFormat {
    /// Names and numbers
    Json,
}

impl ValueEnum for ModelFormat {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Mjcf, Self::Urdf]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let (name, help) = match self {
            Self::Mjcf => ("mjcf", "MuJoCo: joints, inertias, contact pairs, actuators, starts"),
            Self::Urdf => ("urdf", "The robot only: joints, inertias, shapes"),
        };
        Some(PossibleValue::new(name).help(help))
    }
}

impl ValueEnum for ControllerFormat {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Json, Self::Bytes, Self::Rust, Self::Safetensors, Self::C, Self::CIntegers]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let (name, help) = match self {
            Self::Json => ("json", "Names and numbers, including the body"),
            Self::Bytes => ("bytes", "The network for the flash memory of a board"),
            Self::Rust => ("rust", "The network as constants of a Rust program"),
            Self::Safetensors => ("safetensors", "The network as tables for Python"),
            Self::C => ("c", "The network as a header and a source file in C99"),
            Self::CIntegers => ("c-integers", "A leaky network in integers in C99, for processors without floats"),
        };
        Some(PossibleValue::new(name).help(help))
    }
}
