//! Help with examples, completions and manual pages.

use std::ffi::OsString;
use std::fs;
use std::path::Path;

use clap::builder::PossibleValuesParser;
use clap::{Command, CommandFactory as _};
use clap_complete::Shell;
use farsa_view::Camera;

use crate::command::arguments::subcommands::Cli;
use crate::error::Error;
use crate::run::laboratory::Laboratory;
use crate::store::replace::create_results;

/// Help of the program, short enough for 24 lines together with the first tour.
const TEMPLATE: &str = "{about}\n{usage-heading} {usage}; -q: no progress and no summary\n{subcommands}\n";

/// Returns the arguments of the command line, with those for ranks if the program is named after MPI.
fn arguments(program: &str) -> Command {
    let command = Cli::command();
    if program.ends_with("-mpi") {
        return command.mut_subcommand("run", |run| run.mut_arg("groups", |groups| groups.hide(false)));
    }
    command
}

/// Returns the command line of a program, with examples for its first experiment.
pub(crate) fn command(program: &str, laboratory: &Laboratory<'_>) -> Command {
    let first = laboratory.experiments().first();
    let experiment = first.map_or("EXPERIMENT", |experiment| experiment.name());
    let conditions = first.map_or(&[][..], |experiment| experiment.conditions());
    let run = match conditions.first() {
        None => format!("runs/{experiment}-1"),
        Some(condition) => format!("runs/{experiment}-{condition}-1"),
    };
    let other = conditions.get(1).map(|name| format!(" --condition {name}")).unwrap_or_default();
    let examples = |lines: &[String]| {
        let lines: Vec<String> = lines.iter().map(|line| format!("  {program} {line}")).collect();
        format!("{}\n{}", if lines.len() == 1 { "Example:" } else { "Examples:" }, lines.join("\n"))
    };
    let tour = [format!("run {experiment} --generations 20"), format!("replay {run} --html trial.html")];
    let tour = examples(&tour).replacen("Examples:\n", "A first tour:", 1);
    let mut command = arguments(program)
        .name(program.to_owned())
        .bin_name(program.to_owned())
        .version(version(program))
        .disable_help_subcommand(true)
        .help_template(format!("{TEMPLATE}{tour}"))
        .after_help(tour);
    for (name, lines) in subcommand_examples(program, experiment, &run, &other) {
        command = command.mut_subcommand(name, |subcommand| subcommand.after_help(examples(&lines)));
    }
    // The parser of each number names its range, also for `--seed -1`.
    command.mut_subcommands(|subcommand| {
        subcommand.allow_negative_numbers(true).mut_subcommands(|nested| nested.allow_negative_numbers(true))
    })
}

/// Rewrites `help SUBCOMMAND` as `SUBCOMMAND --help`. A subcommand `help` would take a line of the tour.
pub(crate) fn help_last(mut words: Vec<OsString>) -> Vec<OsString> {
    let is_option = |word: &OsString| word.as_encoded_bytes().starts_with(b"-");
    let first = words.iter().skip(1).take_while(|word| is_option(word)).count() + 1;
    let helps = words.iter().skip(first).take_while(|word| *word == "help").count();
    if helps > 0 {
        words.drain(first..first + helps);
        words.push("--help".into());
    }
    words
}

/// Returns examples for each subcommand, with an experiment, one of its runs and another condition.
fn subcommand_examples(program: &str, experiment: &str, run: &str, other: &str) -> Vec<(&'static str, Vec<String>)> {
    vec![
        ("list", vec!["list".into(), "list --json".into()]),
        ("info", vec![format!("info {experiment}"), format!("info {experiment}{other} --json")]),
        ("new", vec!["new follow".into(), "new follow --from light".into(), "new --from list".into()]),
        ("check", vec!["check follow.toml --graph follow.svg".into(), format!("check {experiment}{other} --json")]),
        ("schema", vec!["schema > farsa.schema.json".into()]),
        (
            "run",
            vec![
                format!("run {experiment}{other} --seed 2"),
                format!("run {experiment} --set evolution.mutation_rate=0.02 --out mine"),
                format!("run --resume {run} --generations 2000"),
                format!("run --config {run}/config.toml --out again"),
                format!("run {experiment}{other} --replications 20"),
                format!("run {experiment} --strategy cma-es --seed 3"),
            ],
        ),
        (
            "sweep",
            vec![
                "sweep friction.toml --list".into(),
                "sweep friction.toml --point 3".into(),
                "sweep friction.toml --archive friction.farsa".into(),
            ],
        ),
        ("merge", vec!["merge runs > runs.csv".into(), "merge node1/runs node2/runs --out runs --csv runs.csv".into()]),
        ("strategies", vec!["strategies".into(), "strategies cma-es".into()]),
        (
            "test",
            vec![format!("test {run} --trials 1000 --seed 2"), format!("test {run} --protocol NAME --trials 200")],
        ),
        (
            "evaluate",
            vec![
                format!("evaluate {experiment} --genes-file best.gen --trials 2000"),
                format!("evaluate {experiment} --genes 90,93,0,220 --seed 2 --json"),
                format!("evaluate {experiment} --stdin < parameters.jsonl > outcomes.jsonl"),
            ],
        ),
        (
            "import",
            vec![
                format!("import G500S53.gen --experiment {experiment} --out original"),
                format!("import *.gen --experiment {experiment} --out originals"),
            ],
        ),
        (
            "replay",
            vec![
                format!("replay {run} --trial 0 --out trial.csv"),
                format!("replay {run} --html trial.html"),
                format!("replay {run} --protocol NAME --case 3 --html case.html"),
                format!("replay {run} --generation 0 --individual 7 | head"),
            ],
        ),
        (
            "live",
            vec![format!("live {run} --html live.html"), format!("live {run} --generations 0,10,19 --html live.html")],
        ),
        ("lab", vec!["lab".into(), "lab study --read-only".into()]),
        ("serve", vec![format!("serve {run}"), format!("serve {run} --port 0")]),
        (
            "draw",
            vec![
                format!("draw {run} --out end.svg"),
                format!("draw {run} --trial 2 --time 1.5 --camera {} --out moment.png", Camera::NAMES[1]),
                format!("draw {run} --trial best --frames 60 --out trial.png"),
                format!("draw {run} --protocol start-positions --trial 2 --out cases.svg"),
            ],
        ),
        (
            "report",
            vec![
                format!("report {run} --html report.html"),
                "report runs/* --html report.html --md report.md".to_owned(),
                "report runs/* --html report.html --success-share 0.8".to_owned(),
            ],
        ),
        (
            "export",
            vec![
                format!("export robot {experiment} --format mjcf --out {experiment}.xml"),
                format!("export robot {experiment} --format urdf"),
                format!("export controller {run} --format json --out controller.json"),
                format!("export controller {run} --format bytes --out champion.farsa"),
                format!("export genotype {run} --out champion.gen"),
                format!("export starts {run} --trials 100 --seed 1 --format json --out starts.json"),
            ],
        ),
        (
            "robot",
            vec!["robot panda.urdf --packages share".into(), "robot ant.xml --format urdf --out ant.urdf".into()],
        ),
        ("bench", vec![format!("bench {experiment}"), format!("bench --run {run} --threads 1 --lanes 1 --seconds 60")]),
        ("completions", vec![format!("completions bash > ~/.local/share/bash-completion/completions/{program}")]),
        ("man", vec!["man | man -l -".into(), "man --out ~/.local/share/man/man1".into()]),
    ]
}

/// Formats the version, marked as that of FARSA in other programs.
fn version(program: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    if program == "farsa" { version.into() } else { format!("(FARSA {version})") }
}

/// Returns a script of completions, with the names of experiments, conditions and strategies.
pub(crate) fn completions(shell: Shell, program: &str, laboratory: &Laboratory<'_>) -> String {
    let names: Vec<&'static str> = laboratory.experiments().iter().map(|experiment| experiment.name()).collect();
    let mut conditions: Vec<&'static str> = Vec::new();
    for condition in laboratory.experiments().iter().flat_map(|experiment| experiment.conditions()) {
        if !conditions.contains(condition) {
            conditions.push(condition);
        }
    }
    let mut command = command(program, laboratory);
    // The command itself accepts any name and suggests the nearest valid one.
    let possible = |words: &[&'static str]| PossibleValuesParser::new(words.to_vec());
    let with_names = |subcommand: Command| {
        subcommand
            .mut_arg("experiment", |arg| arg.value_parser(possible(&names)))
            .mut_arg("condition", |arg| arg.value_parser(possible(&conditions)))
    };
    for subcommand in ["info", "run", "bench", "evaluate", "import"] {
        command = command.mut_subcommand(subcommand, with_names);
    }
    command = command.mut_subcommand("export", |export| export.mut_subcommand("robot", with_names));
    command = command.mut_subcommand("draw", |subcommand| {
        subcommand.mut_arg("camera", |arg| arg.value_parser(PossibleValuesParser::new(Camera::NAMES)))
    });
    let strategies: Vec<&'static str> = laboratory.strategies().iter().map(|strategy| strategy.name()).collect();
    for subcommand in ["info", "run", "strategies"] {
        let with_names =
            |subcommand: Command| subcommand.mut_arg("strategy", |arg| arg.value_parser(possible(&strategies)));
        command = command.mut_subcommand(subcommand, with_names);
    }
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, program, &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

/// Returns the first manual page.
pub(crate) fn page(program: &str, laboratory: &Laboratory<'_>) -> Result<String, Error> {
    let mut command = command(program, laboratory);
    command.build();
    render(command)
}

/// Writes all manual pages into a directory and returns their number.
///
/// # Errors
/// [`Error::Usage`] for an existing page and a folder that cannot be made, [`Error::Io`].
pub(crate) fn pages(directory: &Path, program: &str, laboratory: &Laboratory<'_>) -> Result<usize, Error> {
    let mut command = command(program, laboratory);
    command.build();
    let subcommands = command.get_subcommands().filter(|subcommand| subcommand.get_name() != "help").cloned();
    let mut files = Vec::new();
    for subcommand in std::iter::once(command.clone()).chain(subcommands) {
        let name = subcommand.get_display_name().unwrap_or(program).to_owned();
        files.push((directory.join(format!("{name}.1")), render(subcommand)?));
    }
    if let Err(error) = fs::create_dir_all(directory) {
        return Err(Error::Usage(format!("cannot make {}: {error}", directory.display())));
    }
    create_results(&files)?;
    Ok(files.len())
}

fn render(command: Command) -> Result<String, Error> {
    let mut page = Vec::new();
    let rendered = clap_mangen::Man::new(command).render(&mut page);
    rendered.map_err(Error::io("write", "the manual".as_ref()))?;
    Ok(String::from_utf8_lossy(&page).into_owned())
}
