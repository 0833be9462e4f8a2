//! The command: `main` for any set of experiments.

use std::io::{self, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use clap::{Args, Parser, Subcommand, value_parser};

use crate::directory::{Directory, create_result};
use crate::error::Error;
use crate::evolution::{GENERATIONS, POPULATION};
use crate::exam;
use crate::experiment::Experiment;
use crate::info;
use crate::plan::{self, ConfigFile, LARGEST_SEED, Plan};
use crate::replay::{self, Which};
use crate::run;
use crate::settings::Value;

/// Evolve robots, test the champions, and see any life of a run again.
#[derive(Parser)]
#[command(name = "farsa", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// List the experiments
    List,
    /// Tell all about an experiment: sensors, network, genome, trials, and every setting with its source
    Info(InfoArgs),
    /// Evolve, or go on with a run
    Run(RunArgs),
    /// Put the champion of a run to the test on fresh starts
    Test(TestArgs),
    /// Live a life of a run again, exactly, and write every step as CSV
    Replay(ReplayArgs),
}

#[derive(Args)]
struct InfoArgs {
    /// The experiment
    experiment: String,
    /// One of its conditions
    #[arg(long, value_name = "NAME")]
    condition: Option<String>,
    /// Write JSON
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
#[command(allow_negative_numbers = true)]
struct RunArgs {
    /// The experiment
    #[arg(required_unless_present_any = ["resume", "config"])]
    experiment: Option<String>,
    /// One of its conditions [default: its first]
    #[arg(long, value_name = "NAME")]
    condition: Option<String>,
    /// Where all random numbers come from [default: 1]
    #[arg(long, value_name = "N", value_parser = value_parser!(u64).range(..=LARGEST_SEED))]
    seed: Option<u64>,
    /// Generations to evaluate (evolution.generations)
    #[arg(long, value_name = "G")]
    generations: Option<i64>,
    /// Individuals of a generation (evolution.population)
    #[arg(long, value_name = "P")]
    population: Option<i64>,
    #[command(flatten)]
    threads: Threads,
    /// The run's directory [default: runs/EXPERIMENT-CONDITION-SEED]
    #[arg(long, value_name = "DIR", conflicts_with = "resume")]
    out: Option<PathBuf>,
    /// Take settings from a TOML file
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Change a setting; may be repeated, goes before the file
    #[arg(long, value_name = "KEY=VALUE", value_parser = plan::assignment)]
    set: Vec<(String, Value)>,
    /// Go on with the run in a directory; generations may be added
    #[arg(long, value_name = "DIR")]
    resume: Option<PathBuf>,
}

#[derive(Args)]
struct Threads {
    /// Threads to use [default: all processors]; the results are the same with any number
    #[arg(long, value_name = "T", value_parser = value_parser!(u16).range(1..=4096))]
    threads: Option<u16>,
}

impl Threads {
    fn count(&self) -> usize {
        self.threads.map_or_else(|| thread::available_parallelism().map_or(1, usize::from), usize::from)
    }
}

#[derive(Args)]
struct TestArgs {
    /// The run's directory
    directory: PathBuf,
    /// Fresh trials
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = value_parser!(u32).range(1..=100_000_000))]
    trials: u32,
    /// Where the test's random numbers come from; never those of a run
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = value_parser!(u64).range(..=LARGEST_SEED))]
    seed: u64,
    #[command(flatten)]
    threads: Threads,
}

#[derive(Args)]
struct ReplayArgs {
    /// The run's directory
    directory: PathBuf,
    /// The generation, from 0 [default: the last]
    #[arg(long, value_name = "N")]
    generation: Option<u32>,
    /// The individual, from 0 [default: the best of the generation]
    #[arg(long, value_name = "N")]
    individual: Option<u32>,
    /// The trial, from 0 [default: all]
    #[arg(long, value_name = "N")]
    trial: Option<u32>,
    /// A new file to write to [default: the standard output]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Runs the command over these experiments with the process's arguments: the whole of a `main`.
///
/// The exit code is 0; 2 for a wrong command line or configuration; 130 after Ctrl-C; 1 otherwise.
pub fn main(experiments: &[&dyn Experiment]) -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version are printed this way too, with exit code 0. There is nowhere to complain about a failure.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    match execute(cli.command, experiments) {
        Ok(()) => ExitCode::SUCCESS,
        // The reader has seen enough: `farsa replay ... | head`.
        Err(error) if replay::reader_left(&error) => ExitCode::SUCCESS,
        Err(error) => {
            let _ = writeln!(io::stderr(), "error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn execute(command: Command, experiments: &[&dyn Experiment]) -> Result<(), Error> {
    match command {
        Command::List => say(&info::list(experiments)),
        Command::Info(InfoArgs { experiment, condition, json }) => {
            let plan = Plan::new(plan::find(experiments, &experiment, "")?, condition.as_deref(), "")?;
            say(&if json { info::as_json(&plan)? } else { info::as_text(&plan)? })
        }
        Command::Run(args) => {
            let summary = start_or_resume(&args, experiments)?;
            say(&format!("{summary}\n"))
        }
        Command::Test(TestArgs { directory, trials, seed, threads }) => {
            let (directory, plan) = existing(&directory, experiments)?;
            say(&exam::test(&plan, &directory, trials as usize, seed, threads.count())?)
        }
        Command::Replay(ReplayArgs { directory, generation, individual, trial, out }) => {
            let (directory, plan) = existing(&directory, experiments)?;
            let which = Which { generation, individual, trial };
            let summary = match out {
                None => replay::replay(&plan, &directory, which, &mut io::stdout().lock())?,
                Some(path) => replay::replay(&plan, &directory, which, &mut create_result(&path)?)?,
            };
            let _ = writeln!(io::stderr(), "{summary}");
            Ok(())
        }
    }
}

fn say(text: &str) -> Result<(), Error> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(Error::io("write", "the output".as_ref()))
}

/// A run that exists, with the plan in its configuration.
fn existing<'e>(path: &std::path::Path, experiments: &[&'e dyn Experiment]) -> Result<(Directory, Plan<'e>), Error> {
    let directory = Directory::open(path)?;
    let plan = Plan::of_file(experiments, &ConfigFile::read(&directory.config())?)?;
    Ok((directory, plan))
}

fn start_or_resume(args: &RunArgs, experiments: &[&dyn Experiment]) -> Result<String, Error> {
    let file = args.config.as_deref().map(ConfigFile::read).transpose()?;
    let (directory, mut plan) = match &args.resume {
        Some(path) => {
            let (directory, plan) = existing(path, experiments)?;
            (Some(directory), plan)
        }
        None => (None, fresh(args, file.as_ref(), experiments)?),
    };
    if let Some(file) = &file {
        plan.apply(file)?;
    }
    for (key, value) in &args.set {
        plan.settings.set("--set", key, value.clone())?;
    }
    for (option, key, value) in
        [("--generations", GENERATIONS, args.generations), ("--population", POPULATION, args.population)]
    {
        if let Some(value) = value {
            plan.settings.set(option, key, Value::Whole(value))?;
        }
    }
    if let Some(seed) = args.seed {
        plan.seed = seed;
    }
    let directory = match directory {
        Some(directory) => {
            same_names(args, file.as_ref(), &plan, &directory)?;
            directory
        }
        None => run::create(&plan, &args.out.clone().unwrap_or_else(|| PathBuf::from("runs").join(plan.name())))?,
    };
    let program = std::env::args_os().next().map(PathBuf::from);
    let program = program.as_deref().and_then(|path| path.file_name()?.to_str()).unwrap_or("farsa");
    run::go_on(&plan, &directory, args.threads.count(), stop_on_interrupt(), program)
}

/// The defaults of the experiment and condition that are named on the command line or else in the file.
fn fresh<'e>(args: &RunArgs, file: Option<&ConfigFile>, experiments: &[&'e dyn Experiment]) -> Result<Plan<'e>, Error> {
    let named = file.and_then(|file| file.experiment.as_ref());
    let experiment = match (&args.experiment, named) {
        (Some(name), named) => {
            let experiment = plan::find(experiments, name, "")?;
            if let Some(other) = named.filter(|entry| entry.value != *name) {
                let why = format!("is {:?} here and `{name}` on the command line", other.value);
                return Err(Error::Setting { place: other.place.clone(), key: "experiment".into(), why });
            }
            experiment
        }
        (None, Some(entry)) => plan::find(experiments, &entry.value, &entry.place)?,
        (None, None) => return Err(Error::Usage("neither the command line nor the file names an experiment".into())),
    };
    match (&args.condition, file.and_then(|file| file.condition.as_ref())) {
        (Some(name), _) => Plan::new(experiment, Some(name), ""),
        (None, Some(entry)) => Plan::new(experiment, Some(&entry.value), &entry.place),
        (None, None) => Plan::new(experiment, None, ""),
    }
}

/// Refuses a resumed run under another name; its settings and seed are compared with the checkpoint later.
fn same_names(args: &RunArgs, file: Option<&ConfigFile>, plan: &Plan<'_>, directory: &Directory) -> Result<(), Error> {
    let in_file = |entry: Option<&plan::Entry<String>>| entry.map(|entry| entry.value.clone());
    let experiment = args.experiment.clone().or_else(|| in_file(file?.experiment.as_ref()));
    let condition = args.condition.clone().or_else(|| in_file(file?.condition.as_ref()));
    for (key, run, asked) in
        [("experiment", plan.experiment.name(), experiment), ("condition", plan.condition.as_str(), condition)]
    {
        if let Some(asked) = asked.filter(|asked| asked != run) {
            let directory = directory.path().into();
            return Err(Error::OtherConfiguration { directory, key: key.into(), run: run.into(), asked });
        }
    }
    Ok(())
}

/// Becomes true at the first Ctrl-C; the second ends the process, which loses no more than a kill.
fn stop_on_interrupt() -> &'static AtomicBool {
    static STOP: AtomicBool = AtomicBool::new(false);
    // Without a handler Ctrl-C ends the process, and resuming works all the same.
    let _ = ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        let _ = writeln!(io::stderr(), "stopping after the lives that are under way; again to stop at once");
    });
    &STOP
}
