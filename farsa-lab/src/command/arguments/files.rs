//! Arguments of the subcommands for experiment files.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use crate::command::arguments::shared::VariantArgs;

/// `farsa new`.
#[derive(Args)]
pub(crate) struct NewArgs {
    /// The name of the experiment, written to NAME.toml
    #[arg(required_unless_present = "from")]
    pub(crate) name: Option<String>,
    /// The template, or `list` [default: the first]
    #[arg(long, value_name = "TEMPLATE")]
    pub(crate) from: Option<String>,
    /// Write a crate with parts
    #[arg(long, conflicts_with = "from")]
    pub(crate) parts: bool,
}

/// `farsa check`.
#[derive(Args)]
pub(crate) struct CheckArgs {
    /// A file or a built-in experiment
    pub(crate) experiment: String,
    #[command(flatten)]
    pub(crate) variant: VariantArgs,
    /// Draw the connections into an SVG file, or `-` for standard output
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) graph: Option<PathBuf>,
    /// Read the text of the file from standard input, as a page that edits it does
    #[arg(long, hide = true)]
    pub(crate) stdin: bool,
    /// Write JSON
    #[arg(long)]
    pub(crate) json: bool,
}
