//! `main` for any set of experiments.

use std::ffi::OsString;
use std::io::{self, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::rc::Rc;

use clap::FromArgMatches as _;

use crate::command::arguments::export::ExportArgs;
use crate::command::arguments::subcommands::{
    BenchArgs, Cli, Command, CompletionsArgs, InfoArgs, ListArgs, ManArgs, RunArgs, TestArgs,
};
use crate::command::champion_test::Tests;
use crate::command::interrupt::{INTERRUPTED, START_AGAIN, stop_on_signals, under_scheduler};
use crate::command::invocation::Invocation;
use crate::command::on_ranks::{Part, awaits_orders};
use crate::command::{info, manual, next};
use crate::error::Error;
use crate::escaped::escaped;
use crate::evaluation::protocols::sheet;
use crate::evaluation::{draw, evaluate, lines, protocols, replay, test};
use crate::experiment::settings::Value;
use crate::export::files::Exported;
use crate::export::robot_file;
use crate::json::pretty;
use crate::ranks::exchange::Exchange;
use crate::ranks::{Alone, Ranks};
use crate::report::write;
use crate::run::begin;
use crate::run::bench::{self, Bench};
use crate::run::config_file::{ConfigFile, Entry};
use crate::run::experiment::Experiment;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::replications::{self, Replications};
use crate::run::sample::Sample;
use crate::run::summary::Summary;
use crate::run::{evolve, world_choice};
use crate::shell::resume_command;
use crate::store::directory::Directory;
use crate::store::replace::create_results;
use crate::strategy::settings::{GENERATIONS, POPULATION};

/// Runs the command with the arguments of the process over these experiments, as a complete `main`.
///
/// The exit code is 0 for success and 2 for an invalid command line or configuration. After Ctrl-C, SIGTERM or SIGHUP it is
/// 130, or 75 if a scheduler of a cluster has started the process. It is 1 for other errors.
pub fn main(experiments: &[&dyn Experiment]) -> ExitCode {
    Laboratory::new(experiments).main()
}

/// Runs the command on one of several ranks with the same arguments.
///
/// The ranks evaluate the trials of `run` together. Only rank 0 writes files and reports errors, and all ranks end with its
/// exit code.
pub fn main_on_ranks(experiments: &[&dyn Experiment], ranks: &dyn Ranks) -> ExitCode {
    Laboratory::new(experiments).main_on_ranks(ranks)
}

impl Laboratory<'_> {
    /// Runs the command with the arguments of the process over this laboratory, as [`main`] does.
    pub fn main(&self) -> ExitCode {
        ExitCode::from(execute(self, &Alone, std::env::args_os().collect()))
    }

    /// Runs the command on one of several ranks, as [`main_on_ranks`] does.
    pub fn main_on_ranks(&self, ranks: &dyn Ranks) -> ExitCode {
        ExitCode::from(execute(self, ranks, std::env::args_os().collect()))
    }

    /// Runs the command with the given words, of which the first is the name of the program, and returns the exit code.
    pub fn command(&self, words: impl IntoIterator<Item = impl Into<OsString>>) -> u8 {
        execute(self, &Alone, words.into_iter().map(Into::into).collect())
    }
}

/// Runs a command line on one rank and returns the exit code.
fn execute(laboratory: &Laboratory<'_>, ranks: &dyn Ranks, words: Vec<OsString>) -> u8 {
    let program = program(words.first());
    let exchange = Rc::new(Exchange::new(ranks));
    let sharing = exchange.sharing().unwrap_or(1);
    let cli = match read(&program, laboratory, words) {
        Ok(cli) => cli,
        Err(error) => {
            let text = error.to_string();
            let _ = exchange.begin(Err(Error::Usage(text.trim_start_matches("error: ").into())));
            if !exchange.is_follower() {
                // Help and version are printed here, too, with exit code 0. A failure to print cannot be reported.
                let _ = error.print();
            }
            return u8::try_from(error.exit_code()).unwrap_or(2);
        }
    };
    let invocation = Invocation { program: &program, laboratory, quiet: cli.quiet, exchange, sharing };
    let followed = awaits_orders(&cli.command);
    let result = match invocation.take_part(&cli.command) {
        Ok(Part::Followed(code)) => return code,
        Ok(Part::Leads) => invocation.execute(cli.command),
        Err(error) => return invocation.report(Err(error)),
    };
    let code = invocation.report(result);
    let dismissed = if followed { invocation.dismiss(code) } else { Ok(()) };
    dismissed.map_or_else(|error| invocation.report(Err(error)), |()| code)
}

/// Parses a command line, whose first word is the program.
///
/// # Errors
/// Invalid arguments, and requests for help and version.
pub(crate) fn read(
    program: &str,
    laboratory: &Laboratory<'_>,
    words: impl IntoIterator<Item = impl Into<OsString> + Clone>,
) -> Result<Cli, clap::Error> {
    read_by(&mut manual::command(program, laboratory), words)
}

/// Parses a command line with the help of this program.
pub(crate) fn read_by(
    command: &mut clap::Command,
    words: impl IntoIterator<Item = impl Into<OsString> + Clone>,
) -> Result<Cli, clap::Error> {
    let words = manual::help_last(words.into_iter().map(Into::into).collect());
    Cli::from_arg_matches(&command.try_get_matches_from_mut(words)?)
}

/// Gets the name of the program.
fn program(first: Option<&OsString>) -> String {
    let path = first.map(PathBuf::from);
    let name = path.and_then(|path| path.file_name()?.to_str().map(str::to_owned));
    // The suffix of Windows is not typed.
    name.map_or_else(|| "farsa".into(), |name| name.trim_end_matches(std::env::consts::EXE_SUFFIX).into())
}

impl<'e> Invocation<'e, '_> {
    /// Reports an error on rank 0, and returns the exit code.
    fn report(&self, result: Result<(), Error>) -> u8 {
        match result {
            Ok(()) => 0,
            // A closed pipe is no error: `farsa replay ... | head`.
            Err(error) if replay::reader_left(&error) => 0,
            Err(error) => {
                if !self.exchange.is_follower() {
                    let errors = match &error {
                        Error::Several(errors) => errors.as_slice(),
                        single => std::slice::from_ref(single),
                    };
                    for error in errors {
                        // An interrupted run is saved.
                        let mark = if matches!(error, Error::Interrupted { .. }) { "" } else { "error: " };
                        let _ = writeln!(io::stderr(), "{mark}{}", escaped(&error.to_string()));
                    }
                }
                let again = error.exit_code() == INTERRUPTED && under_scheduler();
                if again { START_AGAIN } else { error.exit_code() }
            }
        }
    }

    fn execute(&self, command: Command) -> Result<(), Error> {
        let Self { program, laboratory, quiet, .. } = *self;
        match command {
            Command::List(ListArgs { json: false }) => tell(&info::list(laboratory.experiments())),
            Command::List(ListArgs { json: true }) => say(&info::list_as_json(laboratory.experiments())?),
            Command::Strategies(args) => self.strategies(&args),
            Command::Info(InfoArgs { experiment, condition, strategy, json }) => {
                let strategy = strategy.map(|name| laboratory.strategy(&name, "--strategy")).transpose()?;
                let plan = Plan::with_strategy(self.find(&experiment)?, condition.as_deref(), "", strategy)?;
                if json { say(&info::as_json(&plan)?) } else { tell(&info::as_text(&plan)?) }
            }
            Command::New(args) => self.new_file(&args),
            Command::Check(args) => self.check(&args),
            Command::Schema => say(&(laboratory.files()?.schema)(laboratory.vocabulary().parts)?),
            Command::Run(args @ RunArgs { replications: Some(count), .. }) => {
                let summary = match args.groups {
                    None => Some(self.replicate(&args, count, args.replication)?),
                    Some(groups) => self.replicate_in_groups(&args, count, groups)?,
                };
                let Some(mut summary) = summary else { return Ok(()) };
                self.test_champions(summary.summaries(), Tests::of_champions(args.test), &args.workers)?;
                self.summary(args.json, &summary.text(), &|| pretty(&summary))
            }
            Command::Run(args) => {
                let (summary, plan) = match &args.from {
                    Some(file) => self.run_from_page(file, &args)?,
                    None => self.start_or_resume(&args)?,
                };
                let text = format!("{}\n{}", summary.text(), next::after_run(&summary, &plan));
                self.summary(args.json, &text, &|| pretty(&summary))
            }
            Command::Sweep(args) => self.sweep(&args),
            Command::Merge(args) => self.merge(&args),
            Command::Test(args) => self.test(args),
            Command::Evaluate(args) => {
                let mut plan = args.variant.plan(self.find(&args.experiment)?)?;
                if args.stdin {
                    plan.seed = args.seed;
                    let pool = args.workers.pool(&plan)?;
                    return lines::serve(&plan, pool, &mut io::stdin().lock(), &mut io::stdout().lock());
                }
                let (pool, trials) = (args.workers.pool(&plan)?, args.trials as usize);
                let summary = evaluate::evaluate(&plan, pool, &args.genes(), trials, args.seed, quiet)?;
                if args.json { say(&pretty(&summary)?) } else { tell(&summary.text()) }
            }
            Command::Import(args) => self.import(&args),
            Command::Replay(args) => self.replay(&args),
            Command::Live(args) => self.live(&args),
            Command::Serve(args) => self.serve(&args),
            Command::Lab(args) => self.lab(&args),
            Command::Draw(args) => {
                let (directory, plan) = self.existing(&args.directory)?;
                if let Some(wish) = args.sheet()? {
                    let drawing = sheet::draw(&plan, &directory, &wish, &args.out)?;
                    return self.summary(args.json, &format!("{}\n", drawing.summary), &|| pretty(&drawing));
                }
                let (which, camera) = (args.which(), args.camera.as_deref());
                let wish = draw::DrawRequest { which, time: args.time, frames: args.frames, camera, size: args.size };
                let drawing = draw::draw(&plan, &directory, wish, &args.out)?;
                self.summary(args.json, &format!("{}\n", drawing.summary), &|| pretty(&drawing))
            }
            Command::Report(args) => {
                let runs = args.directories.iter().map(|path| self.existing(path)).collect::<Result<Vec<_>, _>>()?;
                let summary = write::report(runs, args.html.as_deref(), args.md.as_deref(), args.success(), program)?;
                self.summary(args.json, &summary.text(), &|| pretty(&summary))
            }
            Command::Export(ExportArgs { what }) => match self.exported(what)? {
                Exported::Text(content) => say(&content),
                Exported::Files(files) => create_results(&files),
            },
            Command::Robot(args) => {
                let reading = robot_file::read(&args.file, &args.options())?;
                let summary = robot_file::Summary::new(&args.file, &reading);
                match (args.format, args.out) {
                    (None, _) if args.json => say(&pretty(&summary)?),
                    (None, _) => tell(&summary.text()),
                    (Some(format), None) => say(&robot_file::written(&reading, format)?),
                    (Some(format), Some(path)) => {
                        create_results(&[(path, robot_file::written(&reading, format)?)])?;
                        self.summary(false, &summary.text(), &|| Ok(String::new()))
                    }
                }
            }
            Command::Bench(args) => {
                let summary = self.bench(&args)?;
                self.summary(args.json, &summary.text(), &|| pretty(&summary))
            }
            Command::Completions(CompletionsArgs { shell }) => say(&manual::completions(shell, program, laboratory)),
            Command::Man(ManArgs { out: None }) => say(&manual::page(program, laboratory)?),
            Command::Man(ManArgs { out: Some(path) }) => {
                let pages = manual::pages(&path, program, laboratory)?;
                self.summary(false, &format!("{}: {pages} pages\n", path.display()), &|| Ok(String::new()))
            }
        }
    }

    fn test(&self, args: TestArgs) -> Result<(), Error> {
        let (which, quiet) = (args.which(), self.quiet);
        let TestArgs { directory, trials, protocol, lesion, seed, workers, world, json, .. } = args;
        let (mut directory, mut plan) = self.existing(&directory)?;
        let other = world_choice::visit(&mut plan, world.name.as_deref())?;
        if let Some(other) = world.name.filter(|_| other) {
            directory.tests_in(&other);
        }
        let (threads, lanes) = (workers.threads(), workers.lanes());
        let trials = trials.map(|trials| trials as usize);
        let effort = protocols::test::TestOptions { trials, seed, threads, lanes, quiet };
        let summary = match protocol.as_deref() {
            name if !lesion.is_empty() => Some(protocols::test::lesions(&plan, &directory, name, &lesion, effort)?),
            Some(name) => Some(protocols::test::test(&plan, &directory, name, effort)?),
            None => None,
        };
        if let Some(summary) = summary {
            return self.summary(json, &summary.text(), &|| pretty(&summary));
        }
        let trials = trials.unwrap_or(test::TRIALS);
        let summary = test::test(&plan, &directory, which, trials, seed, threads, lanes, quiet)?;
        self.summary(json, &summary.text(io::stdout().is_terminal()), &|| pretty(&summary))
    }

    /// Prints the summary, or JSON even with `--quiet`.
    pub(super) fn summary(
        &self,
        json: bool,
        text: &str,
        value: &dyn Fn() -> Result<String, Error>,
    ) -> Result<(), Error> {
        match (json, self.quiet) {
            (true, _) => say(&value()?),
            (false, true) => Ok(()),
            (false, false) => tell(text),
        }
    }

    /// Returns the experiment of a name.
    pub(super) fn find(&self, name: &str) -> Result<&'e dyn Experiment, Error> {
        self.laboratory.experiment(name, "")
    }

    /// Returns an existing run with the plan of its configuration.
    pub(super) fn existing(&self, path: &Path) -> Result<(Directory, Plan<'e>), Error> {
        let directory = Directory::open(path)?;
        let plan = Plan::from_file(self.laboratory, &ConfigFile::read_regular(&directory.config())?)?;
        Ok((directory, plan))
    }

    fn bench(&self, args: &BenchArgs) -> Result<Bench, Error> {
        let run = args.run.as_deref().map(|path| self.existing(path)).transpose()?;
        let (evolved, plan) = match (run, &args.experiment, self.laboratory.experiments().first()) {
            (Some((directory, mut plan)), ..) => {
                let evolved = Sample::from_run(&plan, &directory)?;
                args.variant.apply(&mut plan)?;
                (Some(evolved), plan)
            }
            (None, Some(name), _) => (None, args.variant.plan(self.find(name)?)?),
            (None, None, Some(first)) => (None, args.variant.plan(*first)?),
            (None, None, None) => return Err(Error::Usage("there is no experiment".into())),
        };
        let pool = args.workers.pool(&plan)?;
        let sample = evolved.map_or_else(|| Sample::random(&plan), Ok)?;
        bench::bench(&plan, &sample, pool, args.seconds)
    }

    /// Starts, continues or skips the replications of a plan, or only the one of a number from 1.
    pub(crate) fn replicate(&self, args: &RunArgs, count: u32, only: Option<u32>) -> Result<Replications, Error> {
        let (_, plan) = self.planned_from_file(args)?;
        self.warn(&plan.evaluator()?.info().warnings);
        let root = args.out.clone().unwrap_or_else(|| PathBuf::from("runs"));
        let pool = |plan: &Plan<'e>| self.pool(args, plan);
        let which = replications::Selection { count, only };
        replications::run(&plan, which, &root, &pool, stop_on_signals, self.program, self.quiet)
    }

    fn start_or_resume(&self, args: &RunArgs) -> Result<(Summary, Plan<'e>), Error> {
        let file = args.config.as_deref().map(ConfigFile::read).transpose()?;
        let (directory, plan) = self.planned(args, file.as_ref())?;
        // A refused run leaves no directory.
        let pool = self.pool(args, &plan)?;
        self.warn(&plan.evaluator()?.info().warnings);
        let directory = if let Some(directory) = directory {
            self.same_names(args, file.as_ref(), &plan, &directory)?;
            directory
        } else {
            let path = args.out.clone().unwrap_or_else(|| PathBuf::from("runs").join(plan.name()));
            self.make_room(args.force, &plan, &path)?;
            begin::create(&plan, &path)?
        };
        let summary = evolve::continue_run(&plan, &directory, pool, stop_on_signals(), self.program, self.quiet);
        let summary = summary.and_then(|mut summary| {
            self.test_run(&mut summary, Tests::of_champions(args.test), &args.workers)?;
            Ok(summary)
        });
        let summary = summary.map_err(|error| match error {
            Error::Interrupted { .. } => {
                let test = args.test.map_or_else(String::new, |trials| format!(" --test {trials}"));
                Error::Interrupted { resume: resume_command(self.program, directory.path()) + &test }
            }
            error => error,
        })?;
        Ok((summary, plan))
    }

    /// Renames an existing run for `--force`, if the new one can start.
    pub(super) fn make_room(&self, force: bool, plan: &Plan<'_>, path: &Path) -> Result<(), Error> {
        if !force {
            return Ok(());
        }
        plan.strategy()?;
        if let Some(moved) = Directory::move_aside(path)?.filter(|_| !self.quiet) {
            let text = format!("{}: the run that was there is kept as {}", path.display(), moved.display());
            let _ = writeln!(io::stderr(), "{}", escaped(&text));
        }
        Ok(())
    }

    /// Refuses to resume a run of another experiment. Settings and seed are compared with the checkpoint later.
    fn same_names(
        &self,
        args: &RunArgs,
        file: Option<&ConfigFile>,
        plan: &Plan<'_>,
        directory: &Directory,
    ) -> Result<(), Error> {
        let in_file = |entry: Option<&Entry<String>>| entry.map(|entry| entry.value.clone());
        let file_name = args.experiment.as_ref().and_then(|name| self.laboratory.file(name));
        let named = file_name.map(|name| self.find(&name)).transpose()?;
        let other = |experiment: &&dyn Experiment| {
            experiment.name() == plan.experiment.name() && experiment.definition() != plan.experiment.definition()
        };
        if named.as_ref().is_some_and(other) {
            let asked = args.experiment.clone().unwrap_or_default();
            return Err(Error::other_configuration(directory.path(), "definition", plan.experiment.name(), &asked));
        }
        let experiment = named.map(|experiment| experiment.name().to_owned()).or_else(|| args.experiment.clone());
        let experiment = experiment.or_else(|| in_file(file?.experiment.as_ref()));
        let condition = args.variant.condition.clone().or_else(|| in_file(file?.condition.as_ref()));
        let strategy = args.strategy.clone().or_else(|| in_file(file?.strategy.as_ref()));
        for (key, run, asked) in [
            ("experiment", plan.experiment.name(), experiment),
            ("condition", plan.condition.as_str(), condition),
            ("strategy", plan.definition().name(), strategy),
        ] {
            if let Some(asked) = asked.filter(|asked| asked != run) {
                return Err(Error::other_configuration(directory.path(), key, run, &asked));
            }
        }
        Ok(())
    }

    /// Creates the threads of this rank.
    pub(crate) fn pool(&self, args: &RunArgs, plan: &Plan<'e>) -> Result<Pool<'e>, Error> {
        Ok(args.workers.pool_shared(plan, self.sharing)?.on(self.exchange.clone()))
    }

    /// Returns the plan of the command line and its file.
    pub(crate) fn planned_from_file(&self, args: &RunArgs) -> Result<(Option<Directory>, Plan<'e>), Error> {
        self.planned(args, args.config.as_deref().map(ConfigFile::read).transpose()?.as_ref())
    }

    /// Returns the plan of the command line and its file, and the directory to resume.
    fn planned(&self, args: &RunArgs, file: Option<&ConfigFile>) -> Result<(Option<Directory>, Plan<'e>), Error> {
        let (directory, mut plan) = match &args.resume {
            Some(path) => {
                let (directory, plan) = self.existing(path)?;
                (Some(directory), plan)
            }
            None => (None, self.fresh(args, file)?),
        };
        if let Some(file) = file {
            plan.apply(file)?;
        }
        args.variant.apply(&mut plan)?;
        world_choice::choose(&mut plan, args.world.name.as_deref())?;
        for (option, key, value) in
            [("--generations", GENERATIONS, args.generations), ("--population", POPULATION, args.population)]
        {
            if let Some(value) = value {
                plan.set(option, key, Value::Whole(value))?;
            }
        }
        if let Some(seed) = args.seed {
            plan.seed = seed;
        }
        Ok((directory, plan))
    }

    /// Returns the defaults of the experiment and condition of the command line or the file.
    fn fresh(&self, args: &RunArgs, file: Option<&ConfigFile>) -> Result<Plan<'e>, Error> {
        let named = file.filter(|file| file.experiment.is_some());
        let experiment = match (&args.experiment, named) {
            (Some(name), named) => {
                let experiment = self.find(name)?;
                let other = named.and_then(|file| file.experiment.as_ref());
                if let Some(other) = other.filter(|entry| entry.value != experiment.name()) {
                    let why = format!("is {:?} here and `{name}` on the command line", other.value);
                    return Err(Error::Setting { place: other.place.clone(), key: "experiment".into(), why });
                }
                experiment
            }
            (None, Some(file)) => self.laboratory.of_configuration(file)?,
            (None, None) => {
                return Err(Error::Usage("neither the command line nor the file names an experiment".into()));
            }
        };
        let strategy = match (&args.strategy, file.and_then(|file| file.strategy.as_ref())) {
            (Some(name), _) => Some(self.laboratory.strategy(name, "--strategy")?),
            (None, Some(entry)) => Some(self.laboratory.strategy(&entry.value, &entry.place)?),
            (None, None) => None,
        };
        match (&args.variant.condition, file.and_then(|file| file.condition.as_ref())) {
            (Some(name), _) => Plan::with_strategy(experiment, Some(name), "", strategy),
            (None, Some(entry)) => Plan::with_strategy(experiment, Some(&entry.value), &entry.place, strategy),
            (None, None) => Plan::with_strategy(experiment, None, "", strategy),
        }
    }
}

/// Prints text for people, with control characters of external names escaped.
pub(super) fn tell(text: &str) -> Result<(), Error> {
    say(&*escaped(text))
}

/// Prints data unchanged.
pub(super) fn say(text: &(impl AsRef<[u8]> + ?Sized)) -> Result<(), Error> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_ref()).and_then(|()| out.flush()).map_err(Error::io("write", "the output".as_ref()))
}
