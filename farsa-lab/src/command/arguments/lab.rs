//! Arguments of `farsa lab`.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use crate::command::arguments::shared::whole;
use crate::live::serve::PagePart;

/// `farsa lab`.
#[derive(Args)]
pub(crate) struct LabArgs {
    /// The folder of experiment files and of runs
    #[arg(default_value = ".", value_hint = ValueHint::DirPath)]
    pub(crate) folder: PathBuf,
    /// The port of 127.0.0.1, 0 for any free one
    #[arg(long, value_name = "N", default_value_t = 8378, value_parser = whole(0..=u16::MAX))]
    pub(crate) port: u16,
    /// Processes at once, while others wait [default: all processors]
    #[arg(long, value_name = "N", value_parser = whole(1_u16..=1024))]
    pub(crate) jobs: Option<u16>,
    /// A WebAssembly module of the experiments [default: this program's]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) module: Option<PathBuf>,
    /// Refuse every change
    #[arg(long)]
    pub(crate) read_only: bool,
    /// Write the address as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct ServeArgs {
    /// The run's directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) directory: PathBuf,
    /// The port of 127.0.0.1, 0 for any free one
    #[arg(long, value_name = "N", default_value_t = 8377, value_parser = whole(0..=u16::MAX))]
    pub(crate) port: u16,
    /// A WebAssembly module of the experiments [default: this program's]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) module: Option<PathBuf>,
    /// Write the address as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Print a part of the page, for a program that shows it
    #[arg(long, hide = true, conflicts_with_all = ["port", "json"])]
    pub(crate) print: Option<PagePart>,
}
