//! Arguments of `farsa merge`.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use crate::merge::Merge;

#[derive(Args)]
pub(crate) struct MergeArgs {
    /// Runs, directories that contain runs at any depth, or archives of sweeps
    #[arg(required = true, value_name = "DIR", value_hint = ValueHint::AnyPath)]
    directories: Vec<PathBuf>,
    /// Copy finished runs into this directory under their names, without overwriting
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) out: Option<PathBuf>,
    /// A new file for the table of all runs [default without --out and --curves: standard output]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) csv: Option<PathBuf>,
    /// A new file for the learning curves of all runs, a line per generation and population
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    curves: Option<PathBuf>,
    /// Write the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

impl MergeArgs {
    pub(crate) fn merge(&self) -> Merge<'_> {
        let Self { directories, out, csv, curves, .. } = self;
        Merge { directories, out: out.as_deref(), csv: csv.as_deref(), curves: curves.as_deref() }
    }

    /// Returns true if the table is written to standard output.
    pub(crate) fn prints(&self) -> bool {
        self.out.is_none() && self.csv.is_none() && self.curves.is_none() && !self.json
    }
}
