//! Arguments of `farsa sweep`.

use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};

use crate::command::arguments::shared::{WorkerArgs, whole};
use crate::limits::MAX_TRIALS;
use crate::sweep::work::Selection;

#[derive(Args)]
pub(crate) struct SweepArgs {
    /// A configuration with tables [grid] (every combination) and [list] (n-th values together) of the settings that vary
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    /// Use the quick values of [[checks]]
    #[arg(long)]
    pub(crate) quick: bool,
    /// Only the K-th point, from 1, for a task of a scheduler's array
    #[arg(long, value_name = "K", value_parser = whole(1..=u32::MAX))]
    point: Option<u32>,
    /// Only the K-th replication of each point, from 1
    #[arg(long, value_name = "K", value_parser = whole(1..=u32::MAX))]
    replication: Option<u32>,
    /// Test each champion in N trials [default: test.trials of the file, or none]
    #[arg(long, value_name = "N", value_parser = whole(1..=MAX_TRIALS))]
    pub(crate) test: Option<u32>,
    /// Check and list all points with their finished runs, without starting any
    #[arg(long)]
    pub(crate) list: bool,
    /// Archive the finished runs with their tests, for `merge` (replaces one of fewer)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) archive: Option<PathBuf>,
    /// Write a report as HTML
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) html: Option<PathBuf>,
    /// Write a report as Markdown
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) md: Option<PathBuf>,
    /// The parent directory of the points [default: runs/FILE without extension]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) workers: WorkerArgs,
    /// Write the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

impl SweepArgs {
    pub(crate) fn which(&self) -> Selection {
        let from_0 = |number: Option<u32>| number.map(|number| number as usize - 1);
        Selection { point: from_0(self.point), replication: from_0(self.replication) }
    }

    /// Returns the first option that a file of checks does not have.
    pub(crate) fn refused_by_checks(&self) -> Option<&'static str> {
        let given =
            [("--test", self.test.is_some()), ("--archive", self.archive.is_some()), ("--html", self.html.is_some())];
        given.into_iter().find_map(|(option, is_given)| is_given.then_some(option))
    }

    /// Iterates over the files of the report.
    pub(crate) fn pages(&self) -> impl Iterator<Item = &Path> {
        self.html.iter().chain(&self.md).map(PathBuf::as_path)
    }

    pub(crate) fn root(&self) -> PathBuf {
        let stem = || {
            let mut stem = self.file.file_stem().unwrap_or_default().to_owned();
            stem.push(if self.quick { "-quick" } else { "" });
            PathBuf::from("runs").join(stem)
        };
        self.out.clone().unwrap_or_else(stem)
    }
}
