//! The words of the commands about files that describe experiments.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use crate::command::arguments::shared::VariantArgs;

/// `farsa new`.
#[derive(Args)]
pub(crate) struct NewArgs {
    /// What the experiment is to be called; written is NAME.toml
    pub(crate) name: String,
    /// What to begin with [default: the first]; an unknown name lists them
    #[arg(long, value_name = "TEMPLATE")]
    pub(crate) from: Option<String>,
}

/// `farsa check`.
#[derive(Args)]
pub(crate) struct CheckArgs {
    /// The file, or an experiment that is built in
    pub(crate) experiment: String,
    #[command(flatten)]
    pub(crate) variant: VariantArgs,
    /// Draw what is connected to what into an SVG file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) graph: Option<PathBuf>,
    /// Write JSON
    #[arg(long)]
    pub(crate) json: bool,
}
