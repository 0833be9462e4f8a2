//! All subcommands, with the arguments of the shorter ones.

use std::path::PathBuf;

use clap::{ArgGroup, Args, Parser, Subcommand, ValueHint};
use clap_complete::Shell;
use farsa_view::Camera;

use crate::command::arguments::export::ExportArgs;
use crate::command::arguments::files::{CheckArgs, NewArgs};
use crate::command::arguments::genotypes::{EvaluateArgs, ImportArgs};
use crate::command::arguments::lab::{LabArgs, ServeArgs};
use crate::command::arguments::merge::MergeArgs;
use crate::command::arguments::robot::RobotArgs;
use crate::command::arguments::shared::{FIXED_BY_PAGE, VariantArgs, WorkerArgs, WorldArgs, whole};
use crate::command::arguments::sweep::SweepArgs;
use crate::error::Error;
use crate::evaluation::protocols::selected_cases::CaseSelection;
use crate::evaluation::protocols::sheet::DrawRequest;
use crate::evaluation::replay::{Selection, TrialSelector};
use crate::limits::MAX_TRIALS;
use crate::report::outcome::Success;
use crate::run::plan::MAX_SEED;

/// Evolve robots, test the champions, and replay any trial of a run.
#[derive(Parser)]
#[command(max_term_width = 80)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Suppress progress and summary, but not errors
    #[arg(short, long, global = true, display_order = 900)]
    pub(crate) quiet: bool,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    /// List the experiments
    List(ListArgs),
    /// Describe an experiment, with every setting and its source
    Info(InfoArgs),
    /// List the strategies, or describe one with every setting
    Strategies(StrategiesArgs),
    /// Write a file that describes an experiment
    New(NewArgs),
    /// Check an experiment and list or draw its connections
    Check(CheckArgs),
    /// Write the JSON schema of experiment files, for editors
    #[command(hide = true)]
    Schema,
    /// Evolve, or continue a run
    Run(RunArgs),
    /// Run an experiment at many settings listed in a file
    Sweep(SweepArgs),
    /// Collect runs of several directories as a table or as copies
    Merge(MergeArgs),
    /// Test the champion of a run on new random starts
    Test(TestArgs),
    /// Evaluate a genotype from any source on random trials
    Evaluate(EvaluateArgs),
    /// Import genotypes or configurations of the original FARSA
    Import(ImportArgs),
    /// Replay a trial of a run exactly
    Replay(ReplayArgs),
    /// Write an interactive page that runs the agent of a run
    Live(LiveArgs),
    /// Serve the interactive page of a running run on this machine
    Serve(ServeArgs),
    /// Open a laboratory in the browser, to begin with
    Lab(LabArgs),
    /// Draw a moment of a trial as a picture
    Draw(DrawArgs),
    /// Write a report about one or several runs
    Report(ReportArgs),
    /// Write a robot, a controller, genes or starts for other programs
    Export(ExportArgs),
    /// Read a robot from a URDF or MJCF file and describe it
    Robot(RobotArgs),
    /// Measure the speed of trials and estimate the time of a study
    Bench(BenchArgs),
    /// Write the completions of a shell to standard output
    #[command(hide = true)]
    Completions(CompletionsArgs),
    /// Write manual pages
    #[command(hide = true)]
    Man(ManArgs),
}

#[derive(Args)]
pub(crate) struct ListArgs {
    /// Write JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct StrategiesArgs {
    /// A strategy, whose settings are listed [default: the names of all]
    pub(crate) strategy: Option<String>,
    /// Write JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct InfoArgs {
    /// The experiment
    pub(crate) experiment: String,
    /// A condition of the experiment [default: the first]
    #[arg(long, value_name = "NAME")]
    pub(crate) condition: Option<String>,
    /// A strategy instead of the experiment's default
    #[arg(long, value_name = "NAME")]
    pub(crate) strategy: Option<String>,
    /// Write JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct RunArgs {
    /// The experiment
    #[arg(required_unless_present_any = ["resume", "config", "from"])]
    pub(crate) experiment: Option<String>,
    #[command(flatten)]
    pub(crate) variant: VariantArgs,
    /// The strategy, see `strategies` [default: the experiment's]
    #[arg(long, value_name = "NAME")]
    pub(crate) strategy: Option<String>,
    /// The seed of all random numbers [default: 1]
    #[arg(long, value_name = "N", value_parser = whole(0..=MAX_SEED))]
    pub(crate) seed: Option<u64>,
    /// Generations to evaluate (evolution.generations)
    #[arg(long, value_name = "G", value_parser = integer)]
    pub(crate) generations: Option<i64>,
    /// Individuals per generation (evolution.population)
    #[arg(long, value_name = "P", value_parser = integer)]
    pub(crate) population: Option<i64>,
    #[command(flatten)]
    pub(crate) workers: WorkerArgs,
    #[command(flatten)]
    pub(crate) world: WorldArgs,
    /// The run's directory [default: runs/EXPERIMENT-CONDITION-SEED], or with --replications its parent [default: runs]
    #[arg(long, value_name = "DIR", conflicts_with = "resume", value_hint = ValueHint::DirPath)]
    pub(crate) out: Option<PathBuf>,
    /// Rename an existing run to DIR.old-1, or the next free number
    #[arg(long, conflicts_with_all = ["resume", "replications"])]
    pub(crate) force: bool,
    /// Make N runs with consecutive seeds (repeated or parallel commands continue with unfinished runs)
    #[arg(long, value_name = "N", conflicts_with = "resume", value_parser = whole(1..=u32::MAX))]
    pub(crate) replications: Option<u32>,
    /// Make only the K-th run, from 1, for a task of a scheduler's array
    #[arg(long, value_name = "K", requires = "replications", value_parser = whole(1..=u32::MAX))]
    pub(crate) replication: Option<u32>,
    /// Make G runs in parallel, each on a part of the ranks
    #[arg(long, value_name = "G", requires = "replications", conflicts_with = "replication", hide = true, value_parser = whole(1..=u32::MAX))]
    pub(crate) groups: Option<u32>,
    /// Test each champion in N trials, as `test` does
    #[arg(long, value_name = "N", value_parser = whole(1..=MAX_TRIALS))]
    pub(crate) test: Option<u32>,
    /// Read settings from a TOML file (--set takes precedence)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) config: Option<PathBuf>,
    /// Continue the run in a directory (generations may be added)
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) resume: Option<PathBuf>,
    /// Evolve a run that a page has saved, and check that it is equal
    #[arg(long, value_name = "FILE", conflicts_with_all = FIXED_BY_PAGE, value_hint = ValueHint::FilePath)]
    pub(crate) from: Option<PathBuf>,
    /// Write the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct BenchArgs {
    /// The experiment [default: the first in the list]
    pub(crate) experiment: Option<String>,
    #[command(flatten)]
    pub(crate) variant: VariantArgs,
    /// Use the last generation and the configuration of a run [default: random genomes]
    #[arg(long, value_name = "DIR", conflicts_with_all = ["experiment", "condition"], value_hint = ValueHint::DirPath)]
    pub(crate) run: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) workers: WorkerArgs,
    /// Duration in seconds (only the first generation is interrupted)
    #[arg(long, value_name = "S", default_value_t = 10.0, value_parser = seconds)]
    pub(crate) seconds: f64,
    /// Write JSON instead of the table
    #[arg(long)]
    pub(crate) json: bool,
}

/// Parses a value of a setting, whose range the setting checks.
fn integer(text: &str) -> Result<i64, String> {
    text.parse().map_err(|_| "not a whole number".into())
}

/// Parses a duration.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds| (0.01..=86400.0).contains(seconds));
    seconds.ok_or_else(|| "not a number of seconds from 0.01 to 86400".into())
}

#[derive(Args)]
pub(crate) struct TestArgs {
    /// The run's directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) directory: PathBuf,
    /// Trials, or trials of each case of a protocol [default: 100, or the protocol's number]
    #[arg(long, value_name = "N", value_parser = whole(1..=MAX_TRIALS))]
    pub(crate) trials: Option<u32>,
    /// Test every case of a test protocol, see `info`
    #[arg(long, value_name = "NAME")]
    pub(crate) protocol: Option<String>,
    /// Test the best of this generation, from 0, without writing a file
    #[arg(long, value_name = "N", conflicts_with_all = ["protocol", "lesion"], value_parser = whole(0..=u32::MAX))]
    generation: Option<u32>,
    /// Test this individual of the generation, from 0, without writing a file
    #[arg(long, value_name = "N", conflicts_with_all = ["protocol", "lesion"], value_parser = whole(0..=u32::MAX))]
    individual: Option<u32>,
    /// Compare with the controller with changed parts, such as neuron:3,link:2-5,sensor:touch, without writing a file
    #[arg(long, value_name = "LIST")]
    pub(crate) lesion: Vec<String>,
    /// The seed of the test, independent of those of runs
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole(0..=MAX_SEED))]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) workers: WorkerArgs,
    #[command(flatten)]
    pub(crate) world: WorldArgs,
    /// Write JSON instead of the table
    #[arg(long)]
    pub(crate) json: bool,
}

impl TestArgs {
    /// Returns the individual of the options, or `None` for the champion.
    pub(crate) fn which(&self) -> Option<Selection> {
        let Self { generation, individual, .. } = *self;
        let is_given = generation.is_some() || individual.is_some();
        is_given.then(|| Selection { generation, individual, ..Selection::default() })
    }
}

/// The selection of trials of a run.
#[derive(Args)]
pub(crate) struct WhichArgs {
    /// The generation, from 0 [default: the champion's, or with --individual the last]
    #[arg(long, value_name = "N", value_parser = whole(0..=u32::MAX))]
    generation: Option<u32>,
    /// The individual, from 0 [default: the best of the generation]
    #[arg(long, value_name = "N", value_parser = whole(0..=u32::MAX))]
    individual: Option<u32>,
    /// The trial, from 0, or `best` by fitness [default: all]
    #[arg(long, value_name = "N", value_parser = which_trial)]
    trial: Option<TrialSelector>,
}

impl WhichArgs {
    pub(crate) fn which(&self) -> Selection {
        let trial = self.trial.unwrap_or_default();
        Selection { generation: self.generation, individual: self.individual, trial }
    }
}

/// Parses the number of a trial or `best`.
fn which_trial(text: &str) -> Result<TrialSelector, String> {
    match text {
        "best" => Ok(TrialSelector::Best),
        number => number.parse().map(TrialSelector::Number).map_err(|_| "neither a number from 0 nor `best`".into()),
    }
}

#[derive(Args)]
pub(crate) struct ReplayArgs {
    /// The run's directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) directory: PathBuf,
    #[command(flatten)]
    pub(crate) which: WhichArgs,
    /// Replay the champion in the cases of a protocol, see `info`
    #[arg(long, value_name = "NAME", conflicts_with_all = ["generation", "individual"])]
    protocol: Option<String>,
    #[command(flatten)]
    cases: CaseArgs,
    #[command(flatten)]
    pub(crate) world: WorldArgs,
    /// Change parts of the controller, such as neuron:3,link:2-5,sensor:touch
    #[arg(long, value_name = "LIST", conflicts_with_all = ["compare", "protocol"])]
    pub(crate) lesion: Option<String>,
    /// Move or push bodies, as a page's script does
    #[arg(long, value_name = "FILE", conflicts_with_all = ["compare", "protocol"], value_hint = ValueHint::FilePath)]
    pub(crate) changes: Option<PathBuf>,
    /// A new CSV file of the steps [default: standard output]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) out: Option<PathBuf>,
    /// A page for a browser (replaces only its earlier version)
    #[arg(long, value_name = "FILE", conflicts_with = "out", value_hint = ValueHint::FilePath)]
    pub(crate) html: Option<PathBuf>,
    /// Another run for comparison in the page
    #[arg(long, value_name = "DIR", requires = "html", value_hint = ValueHint::DirPath)]
    pub(crate) compare: Option<PathBuf>,
    /// Write the summary as JSON, to standard error without --out or --html
    #[arg(long)]
    pub(crate) json: bool,
}

impl ReplayArgs {
    /// Returns the selected cases of a protocol, if any.
    ///
    /// # Errors
    /// [`Error::Usage`] for a trial without a number.
    pub(crate) fn choice(&self) -> Result<Option<CaseSelection<'_>>, Error> {
        self.protocol.as_deref().map(|protocol| self.cases.choice(protocol, self.which.trial)).transpose()
    }
}

/// The selection of cases of a protocol.
#[derive(Args)]
pub(crate) struct CaseArgs {
    /// A case by its name (row, space, column) or number from 0, repeatable [default: all]
    #[arg(id = "case", long = "case", value_name = "CASE", requires = "protocol")]
    cases: Vec<String>,
    /// The seed of the test
    #[arg(long, value_name = "N", requires = "protocol", default_value_t = 1, value_parser = whole(0..=MAX_SEED))]
    seed: u64,
}

impl CaseArgs {
    fn choice<'c>(&'c self, protocol: &'c str, trial: Option<TrialSelector>) -> Result<CaseSelection<'c>, Error> {
        let trial = match trial {
            None | Some(TrialSelector::All) => 0,
            Some(TrialSelector::Number(trial)) => trial,
            Some(TrialSelector::Best) => {
                return Err(Error::Usage("--trial best: a case of a protocol needs the number of a trial".into()));
            }
        };
        Ok(CaseSelection { protocol, cases: &self.cases, trial, seed: self.seed })
    }
}

#[derive(Args)]
pub(crate) struct LiveArgs {
    /// The run's directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) directory: PathBuf,
    /// The file of the page (replaces only its earlier version)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) html: PathBuf,
    /// Generations whose best individuals are included, such as 0,10,100 [default: the last]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = whole(0..=u32::MAX))]
    pub(crate) generations: Vec<u32>,
    /// This individual of each generation, from 0 [default: the best]
    #[arg(long, value_name = "N", value_parser = whole(0..=u32::MAX))]
    pub(crate) individual: Option<u32>,
    /// A WebAssembly module of the experiments [default: this program's]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) module: Option<PathBuf>,
    /// Write the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct DrawArgs {
    /// The run's directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) directory: PathBuf,
    /// The generation, from 0 [default: the last]
    #[arg(long, value_name = "N", value_parser = whole(0..=u32::MAX))]
    generation: Option<u32>,
    /// The individual, from 0 [default: the best of the generation]
    #[arg(long, value_name = "N", value_parser = whole(0..=u32::MAX))]
    individual: Option<u32>,
    /// The trial, from 0, or `best`, the one of highest fitness [default: best, with --protocol 0]
    #[arg(long, value_name = "N", value_parser = which_trial)]
    trial: Option<TrialSelector>,
    /// The time in seconds [default: the end]
    #[arg(long, value_name = "S")]
    pub(crate) time: Option<f64>,
    /// Write an animated PNG of N moments at the speed of the trial, at most 100 per second
    #[arg(long, value_name = "N", conflicts_with_all = ["time", "protocol"], value_parser = whole(1_u32..=1000))]
    pub(crate) frames: Option<u32>,
    /// Draw the champion at the end of a trial of each case of a test protocol, as SVG, see `info`
    #[arg(long, value_name = "NAME", conflicts_with_all = ["generation", "individual", "time"])]
    protocol: Option<String>,
    #[command(flatten)]
    cases: CaseArgs,
    #[arg(long, value_name = "NAME", help = camera_help())]
    pub(crate) camera: Option<String>,
    /// Width and height in pixels [default: 1200x800, with --frames 480x320, per case 320x260]
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<(u32, u32)>,
    /// A .svg or .png file (replaces only its earlier version)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) out: PathBuf,
    /// Write the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

impl DrawArgs {
    pub(crate) fn which(&self) -> Selection {
        let trial = self.trial.unwrap_or(TrialSelector::Best);
        Selection { generation: self.generation, individual: self.individual, trial }
    }

    /// Returns the request for a sheet of a protocol, if any.
    ///
    /// # Errors
    /// [`Error::Usage`] for a trial without a number.
    pub(crate) fn sheet(&self) -> Result<Option<DrawRequest<'_>>, Error> {
        let Some(protocol) = self.protocol.as_deref() else { return Ok(None) };
        let choice = self.cases.choice(protocol, self.trial)?;
        Ok(Some(DrawRequest { choice, camera: self.camera.as_deref(), size: self.size }))
    }
}

/// Lists the cameras, the default first.
fn camera_help() -> String {
    let [first, others @ ..] = Camera::NAMES;
    format!("The camera: {first} [default], {}", others.join(", "))
}

/// Parses a size such as 1200x800.
fn size(text: &str) -> Result<(u32, u32), String> {
    let pair = text.split_once('x').and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    pair.ok_or_else(|| "not of the form 1200x800".into())
}

#[derive(Args)]
#[command(group = ArgGroup::new("pages").args(["html", "md"]).required(true).multiple(true))]
pub(crate) struct ReportArgs {
    /// The runs' directories
    #[arg(required = true, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) directories: Vec<PathBuf>,
    /// An HTML file (replaces only its earlier version)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) html: Option<PathBuf>,
    /// A Markdown file, with pictures NAME-*.svg next to it (replace only their earlier versions)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) md: Option<PathBuf>,
    /// Count a run as successful if this share of its champion's test succeeded [default: 0.5]
    #[arg(long, value_name = "S", value_parser = share)]
    success_share: Option<f64>,
    /// Count a run as successful if the best of a generation reaches this fitness
    #[arg(long, value_name = "F", conflicts_with = "success_share", value_parser = finite)]
    success_fitness: Option<f64>,
    /// Write the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

impl ReportArgs {
    /// Returns the criterion of success, if one is given.
    pub(crate) fn success(&self) -> Option<Success> {
        self.success_fitness.map(Success::Fitness).or(self.success_share.map(Success::Share))
    }
}

fn share(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "not a share from 0 to 1".into())
}

fn finite(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(|| "not a number".into())
}

#[derive(Args)]
pub(crate) struct CompletionsArgs {
    /// The shell
    pub(crate) shell: Shell,
}

#[derive(Args)]
pub(crate) struct ManArgs {
    /// Write a page per command into a directory [default: the first page, to standard output]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) out: Option<PathBuf>,
}
