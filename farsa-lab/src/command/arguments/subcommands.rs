//! All subcommands, and the words of those that are short.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueHint, value_parser};
use clap_complete::Shell;
use farsa_view::Camera;

use crate::command::arguments::export::ExportArgs;
use crate::command::arguments::files::{CheckArgs, NewArgs};
use crate::command::arguments::genotypes::{EvaluateArgs, ImportArgs};
use crate::command::arguments::merge::MergeArgs;
use crate::command::arguments::robot::RobotArgs;
use crate::command::arguments::shared::{VariantArgs, WorkerArgs, WorldArgs};
use crate::command::arguments::sweep::SweepArgs;
use crate::error::Error;
use crate::evaluation::protocols::chosen::Choice;
use crate::evaluation::protocols::sheet::Wish;
use crate::evaluation::replay::{Which, WhichTrial};
use crate::report::outcome::Success;
use crate::run::plan::MAX_SEED;

/// Evolve robots, test the champions, and replay any trial of a run.
#[derive(Parser)]
#[command(max_term_width = 80)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// No progress and no summary; errors stay
    #[arg(short, long, global = true, display_order = 900)]
    pub(crate) quiet: bool,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    /// List the experiments
    List(ListArgs),
    /// Describe an experiment, with every setting and its source
    Info(InfoArgs),
    /// List the strategies, with every setting and its source
    Strategies(StrategiesArgs),
    /// Begin a file that describes an experiment
    New(NewArgs),
    /// Check such a file, and tell or draw what is connected to what
    Check(CheckArgs),
    /// Write the schema of such files, for editors
    #[command(hide = true)]
    Schema,
    /// Evolve, or go on with a run
    Run(RunArgs),
    /// Run an experiment at many settings, those of a file
    Sweep(SweepArgs),
    /// Bring runs of several places together, as a table or as copies
    Merge(MergeArgs),
    /// Put a run's champion to the test on fresh starts
    Test(TestArgs),
    /// Evaluate a genotype from any source on random trials
    Evaluate(EvaluateArgs),
    /// Make genotypes of the original FARSA a run to test and replay
    Import(ImportArgs),
    /// Replay a trial of a run, exactly
    Replay(ReplayArgs),
    /// Write a page in which the agent of a run lives
    Live(LiveArgs),
    /// Serve this page on this machine while a run goes on
    Serve(ServeArgs),
    /// Draw a moment of a trial as a picture
    Draw(DrawArgs),
    /// Write a page about one or many runs
    Report(ReportArgs),
    /// Write a robot, a controller or starts for other simulators
    Export(ExportArgs),
    /// Show what is read of a robot in a model file, URDF or MJCF
    Robot(RobotArgs),
    /// Measure how fast trials run here, and estimate a whole study
    Bench(BenchArgs),
    /// Write a shell's completions to the standard output
    #[command(hide = true)]
    Completions(CompletionsArgs),
    /// Write the manual's pages
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
    /// One of them alone
    pub(crate) strategy: Option<String>,
    /// Write JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct InfoArgs {
    /// The experiment
    pub(crate) experiment: String,
    /// One of its conditions [default: its first]
    #[arg(long, value_name = "NAME")]
    pub(crate) condition: Option<String>,
    /// A strategy in place of the experiment's own
    #[arg(long, value_name = "NAME")]
    pub(crate) strategy: Option<String>,
    /// Write JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
#[command(allow_negative_numbers = true)]
pub(crate) struct RunArgs {
    /// The experiment
    #[arg(required_unless_present_any = ["resume", "config"])]
    pub(crate) experiment: Option<String>,
    #[command(flatten)]
    pub(crate) variant: VariantArgs,
    /// What to search with [default: the experiment's own]; `strategies` lists them
    #[arg(long, value_name = "NAME")]
    pub(crate) strategy: Option<String>,
    /// Where all random numbers come from [default: 1]
    #[arg(long, value_name = "N", value_parser = value_parser!(u64).range(..=MAX_SEED))]
    pub(crate) seed: Option<u64>,
    /// Generations to evaluate (evolution.generations)
    #[arg(long, value_name = "G")]
    pub(crate) generations: Option<i64>,
    /// Individuals of a generation (evolution.population)
    #[arg(long, value_name = "P")]
    pub(crate) population: Option<i64>,
    #[command(flatten)]
    pub(crate) workers: WorkerArgs,
    #[command(flatten)]
    pub(crate) world: WorldArgs,
    /// The run's directory [default: runs/EXPERIMENT-CONDITION-SEED]; with --replications what they lie in [default: runs]
    #[arg(long, value_name = "DIR", conflicts_with = "resume", value_hint = ValueHint::DirPath)]
    pub(crate) out: Option<PathBuf>,
    /// Move a run that is in the directory aside, to DIR.old-1 or the next number that is free
    #[arg(long, conflicts_with_all = ["resume", "replications"])]
    pub(crate) force: bool,
    /// So many runs with seeds from --seed on, one after the other; the same command again skips what is finished and
    /// goes on with what is not, and a second one at the same time takes the next run that nobody has
    #[arg(long, value_name = "N", conflicts_with = "resume", value_parser = value_parser!(u32).range(1..))]
    pub(crate) replications: Option<u32>,
    /// Only the K-th of them, from 1: for one task of an array
    #[arg(long, value_name = "K", requires = "replications", value_parser = value_parser!(u32).range(1..))]
    pub(crate) replication: Option<u32>,
    /// So many of them side by side, each on its part of the ranks
    #[arg(long, value_name = "G", requires = "replications", conflicts_with = "replication", hide = true, value_parser = value_parser!(u32).range(1..))]
    pub(crate) groups: Option<u32>,
    /// Take settings from a TOML file; --set goes before it
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) config: Option<PathBuf>,
    /// Go on with the run in a directory; generations may be added
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) resume: Option<PathBuf>,
    /// Write the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
#[command(allow_negative_numbers = true)]
pub(crate) struct BenchArgs {
    /// The experiment [default: the first of the list]
    pub(crate) experiment: Option<String>,
    #[command(flatten)]
    pub(crate) variant: VariantArgs,
    /// Run the last generation of this run, under its configuration [default: random genomes]
    #[arg(long, value_name = "DIR", conflicts_with_all = ["experiment", "condition"], value_hint = ValueHint::DirPath)]
    pub(crate) run: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) workers: WorkerArgs,
    /// How long to measure, in seconds: whole generations until then, cut short only if it is the first
    #[arg(long, value_name = "S", default_value_t = 10.0, value_parser = seconds)]
    pub(crate) seconds: f64,
    /// Write what was found as JSON, without the table
    #[arg(long)]
    pub(crate) json: bool,
}

/// A time to measure for.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds| (0.01..=86400.0).contains(seconds));
    seconds.ok_or_else(|| "not a number of seconds from 0.01 to 86400".into())
}

#[derive(Args)]
pub(crate) struct TestArgs {
    /// The run's directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) directory: PathBuf,
    /// Fresh trials, with a protocol of each of its cases [default: 100, or as many as the protocol says]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=100_000_000))]
    pub(crate) trials: Option<u32>,
    /// Test every case of one of the experiment's test protocols, which `info` lists
    #[arg(long, value_name = "NAME")]
    pub(crate) protocol: Option<String>,
    /// Test the best of this generation, from 0, in place of the champion; writes no file
    #[arg(long, value_name = "N", conflicts_with_all = ["protocol", "lesion"])]
    generation: Option<u32>,
    /// Test this individual of the generation, from 0, such as one of an archive; writes no file
    #[arg(long, value_name = "N", conflicts_with_all = ["protocol", "lesion"])]
    individual: Option<u32>,
    /// Change parts of the controller together, such as neuron:3,link:2-5,sensor:touch, and test it beside the whole one; writes no
    /// file
    #[arg(long, value_name = "LIST")]
    pub(crate) lesion: Vec<String>,
    /// Where the test's random numbers come from; never those of a run
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = value_parser!(u64).range(..=MAX_SEED))]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) workers: WorkerArgs,
    #[command(flatten)]
    pub(crate) world: WorldArgs,
    /// Write what was found as JSON, without the table
    #[arg(long)]
    pub(crate) json: bool,
}

impl TestArgs {
    /// Another individual than the champion, if one is asked for.
    pub(crate) fn which(&self) -> Option<Which> {
        let Self { generation, individual, .. } = *self;
        (generation.is_some() || individual.is_some()).then(|| Which { generation, individual, ..Which::default() })
    }
}

/// Which trials of a run.
#[derive(Args)]
pub(crate) struct WhichArgs {
    /// The generation, from 0 [default: the champion's; with --individual the last]
    #[arg(long, value_name = "N")]
    generation: Option<u32>,
    /// The individual, from 0 [default: the best of the generation]
    #[arg(long, value_name = "N")]
    individual: Option<u32>,
    /// The trial, from 0, or `best`, the one that earns most [default: all]
    #[arg(long, value_name = "N", value_parser = which_trial)]
    trial: Option<WhichTrial>,
}

impl WhichArgs {
    pub(crate) fn which(&self) -> Which {
        let trial = self.trial.unwrap_or_default();
        Which { generation: self.generation, individual: self.individual, trial }
    }
}

/// A trial's number, or `best`.
fn which_trial(text: &str) -> Result<WhichTrial, String> {
    match text {
        "best" => Ok(WhichTrial::Best),
        number => number.parse().map(WhichTrial::Number).map_err(|_| "neither a number from 0 nor `best`".into()),
    }
}

#[derive(Args)]
pub(crate) struct ReplayArgs {
    /// The run's directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) directory: PathBuf,
    #[command(flatten)]
    pub(crate) which: WhichArgs,
    /// The champion in the cases of a test protocol, as `test` runs them; `info` lists the protocols
    #[arg(long, value_name = "NAME", conflicts_with_all = ["generation", "individual"])]
    protocol: Option<String>,
    #[command(flatten)]
    cases: CaseArgs,
    #[command(flatten)]
    pub(crate) world: WorldArgs,
    /// Change parts of the controller together, such as neuron:3,link:2-5,sensor:touch: the steps are those with the change, and a
    /// page shows both beside each other
    #[arg(long, value_name = "LIST", conflicts_with_all = ["compare", "protocol"])]
    pub(crate) lesion: Option<String>,
    /// A new file for the steps as CSV [default: the standard output]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) out: Option<PathBuf>,
    /// A file for a self-contained page that shows the trial in a browser; a page that is there already is replaced
    #[arg(long, value_name = "FILE", conflicts_with = "out", value_hint = ValueHint::FilePath)]
    pub(crate) html: Option<PathBuf>,
    /// Another run, whose same trial the page shows beside it
    #[arg(long, value_name = "DIR", requires = "html", value_hint = ValueHint::DirPath)]
    pub(crate) compare: Option<PathBuf>,
    /// Write the summary as JSON: where the steps do not go, the standard error without --out or --html
    #[arg(long)]
    pub(crate) json: bool,
}

impl ReplayArgs {
    /// The cases that are asked for, if any are.
    ///
    /// # Errors
    /// [`Error::Usage`] for a trial without a number.
    pub(crate) fn choice(&self) -> Result<Option<Choice<'_>>, Error> {
        self.protocol.as_deref().map(|protocol| self.cases.choice(protocol, self.which.trial)).transpose()
    }
}

/// Which cases of a protocol.
#[derive(Args)]
pub(crate) struct CaseArgs {
    /// A case of the protocol, by its name (row, space, column) or number from 0; may be repeated [default: all]
    #[arg(id = "case", long = "case", value_name = "CASE", requires = "protocol")]
    cases: Vec<String>,
    /// The seed of that test
    #[arg(long, value_name = "N", requires = "protocol", default_value_t = 1, value_parser = value_parser!(u64).range(..=MAX_SEED))]
    seed: u64,
}

impl CaseArgs {
    fn choice<'c>(&'c self, protocol: &'c str, trial: Option<WhichTrial>) -> Result<Choice<'c>, Error> {
        let trial = match trial {
            None | Some(WhichTrial::All) => 0,
            Some(WhichTrial::Number(trial)) => trial,
            Some(WhichTrial::Best) => {
                return Err(Error::Usage("--trial best: of a protocol's cases name the trial by its number".into()));
            }
        };
        Ok(Choice { protocol, cases: &self.cases, trial, seed: self.seed })
    }
}

#[derive(Args)]
pub(crate) struct LiveArgs {
    /// The run's directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) directory: PathBuf,
    /// A file for the page; a page that is there already is replaced
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) html: PathBuf,
    /// Generations whose best individuals are in the page, such as 0,10,100 [default: the last]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub(crate) generations: Vec<u32>,
    /// The experiments as WebAssembly, compressed by gzip or xz, in place of those of this program
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) module: Option<PathBuf>,
    /// Write the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct ServeArgs {
    /// The run's directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) directory: PathBuf,
    /// The port of 127.0.0.1; 0 is any that is free
    #[arg(long, value_name = "N", default_value_t = 8377)]
    pub(crate) port: u16,
    /// The experiments as WebAssembly, compressed by gzip or xz, in place of those of this program
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) module: Option<PathBuf>,
    /// Write the address as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
#[command(allow_negative_numbers = true)]
pub(crate) struct DrawArgs {
    /// The run's directory
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) directory: PathBuf,
    /// The generation, from 0 [default: the last]
    #[arg(long, value_name = "N")]
    generation: Option<u32>,
    /// The individual, from 0 [default: the best of the generation]
    #[arg(long, value_name = "N")]
    individual: Option<u32>,
    /// The trial, from 0, or `best`, the one that earns most [default: 0]
    #[arg(long, value_name = "N", value_parser = which_trial)]
    trial: Option<WhichTrial>,
    /// The moment, in seconds of the trial [default: its end]
    #[arg(long, value_name = "S")]
    pub(crate) time: Option<f64>,
    /// So many moments from the trial's start to its end, as an animated PNG as fast as the trial, 100 a second at most
    #[arg(long, value_name = "N", conflicts_with_all = ["time", "protocol"], value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) frames: Option<u32>,
    /// The champion at the end of a trial of each case of a test protocol, as a sheet of SVG; `info` lists the protocols
    #[arg(long, value_name = "NAME", conflicts_with_all = ["generation", "individual", "time"])]
    protocol: Option<String>,
    #[command(flatten)]
    cases: CaseArgs,
    #[arg(long, value_name = "NAME", help = camera_help())]
    pub(crate) camera: Option<String>,
    /// Width and height in pixels [default: 1200x800; with --frames 480x320; of each of a protocol's 320x260]
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<(u32, u32)>,
    /// A new file, whose name ends in .svg or .png
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) out: PathBuf,
    /// Write the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

impl DrawArgs {
    pub(crate) fn which(&self) -> Which {
        let trial = self.trial.unwrap_or(WhichTrial::Number(0));
        Which { generation: self.generation, individual: self.individual, trial }
    }

    /// The sheet that is asked for, if one is.
    ///
    /// # Errors
    /// [`Error::Usage`] for a trial without a number.
    pub(crate) fn sheet(&self) -> Result<Option<Wish<'_>>, Error> {
        let Some(protocol) = self.protocol.as_deref() else { return Ok(None) };
        let choice = self.cases.choice(protocol, self.trial)?;
        Ok(Some(Wish { choice, camera: self.camera.as_deref(), size: self.size }))
    }
}

/// The cameras' own names, the default's first.
fn camera_help() -> String {
    let [first, others @ ..] = Camera::NAMES;
    format!("Where to look from: {first} [default], {}", others.join(", "))
}

/// Two numbers with an x between them.
fn size(text: &str) -> Result<(u32, u32), String> {
    let pair = text.split_once('x').and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    pair.ok_or_else(|| "not of the form 1200x800".into())
}

#[derive(Args)]
#[command(allow_negative_numbers = true)]
pub(crate) struct ReportArgs {
    /// The runs' directories
    #[arg(required = true, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) directories: Vec<PathBuf>,
    /// A new file for the page, whole in itself
    #[arg(long, value_name = "FILE", required_unless_present = "md", value_hint = ValueHint::FilePath)]
    pub(crate) html: Option<PathBuf>,
    /// A new file for the page as Markdown, with its pictures beside it as NAME-*.svg
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) md: Option<PathBuf>,
    /// A run is a success if at least this share, from 0 to 1, of its champion's test is [default: 0.5]
    #[arg(long, value_name = "S", value_parser = share)]
    success_share: Option<f64>,
    /// A run is a success if the best of a generation reaches this fitness
    #[arg(long, value_name = "F", conflicts_with = "success_share", value_parser = finite)]
    success_fitness: Option<f64>,
    /// Write the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

impl ReportArgs {
    /// When a run is a success, if that was said.
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
    /// Write a page for every command into a directory [default: the first page to the standard output]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) out: Option<PathBuf>,
}
