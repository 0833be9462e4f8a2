//! Arguments of `farsa lab`.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use crate::command::arguments::shared::whole;

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
    /// Refuse every change
    #[arg(long)]
    pub(crate) read_only: bool,
    /// Write the address as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
