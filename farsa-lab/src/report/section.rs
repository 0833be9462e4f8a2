//! Section of a report about one experiment.

use std::time::{Duration, UNIX_EPOCH};

use crate::error::{Error, FileFault};
use crate::evaluation::draw::{self, Portrait};
use crate::evaluation::findings::Finding;
use crate::experiment::outcome::NO_CRITERION;
use crate::experiment::settings::Value;
use crate::figures::significant::{counted, percent};
use crate::figures::statistics::median;
use crate::report::curves::figures;
use crate::report::outcome::{Success, outcome};
use crate::report::page::{Block, Figure, Table};
use crate::report::protocols::{command_of, not_run, protocols};
use crate::report::run::{Group, Run, duration, short, whose};
use crate::report::sampled::sampled;
use crate::report::settings::{command, complete, differences, shell};
use crate::report::starts::starts;
use crate::report::strategies::strategies;
use crate::strategy::settings::POPULATION;

/// Returns the section about an experiment's runs, with a heading if there are several experiments.
pub(crate) fn section(
    runs: &[&Run<'_>],
    heading: Option<&str>,
    success: Success,
    program: &str,
) -> Result<Vec<Block>, Error> {
    let Some(first) = runs.first() else { return Ok(Vec::new()) };
    let experiment = first.plan.experiment;
    let groups = Group::all(runs);
    let runs: Vec<&Run<'_>> = groups.iter().flat_map(|group| group.runs.iter().copied()).collect();
    let mut blocks = Vec::new();
    if let Some(heading) = heading {
        blocks.push(Block::Heading(heading.into()));
    }
    blocks.push(Block::Text(sentence(experiment.summary())));
    blocks.extend(twins(&groups));
    blocks.push(Block::Table(task(&groups)?));
    if let Some(table) = differences(&groups) {
        blocks.push(Block::Subheading("Differences".into()));
        blocks.push(Block::Table(table));
    }
    blocks.push(Block::Subheading("Fitness".into()));
    blocks.push(Block::Figures(figures(&groups)));
    if runs.len() > 1 {
        blocks.extend(outcome(&groups, success));
    }
    blocks.extend(strategies(&groups));
    blocks.push(Block::Subheading("Champions on fresh starts".into()));
    blocks.extend(tests(&groups, program)?);
    blocks.extend(starts(&groups));
    blocks.extend(sampled(&groups));
    blocks.extend(protocols(&groups));
    blocks.extend(not_run(&groups, program)?);
    let (mut pictures, mut others) = (Vec::new(), Vec::new());
    for (place, run) in runs.iter().enumerate() {
        match champion(run, place) {
            Ok(picture) => pictures.extend(picture),
            // This program cannot replay that champion, but it can report the rest of the run.
            Err(error @ Error::File { fault: FileFault::OtherVersion, .. }) => {
                others.push(Block::Text(format!("Not drawn: {error}")));
            }
            Err(error) => return Err(error),
        }
    }
    if !pictures.is_empty() || !others.is_empty() {
        blocks.push(Block::Subheading("Behavior of the champions".into()));
        blocks.push(Block::Figures(pictures));
        blocks.extend(others);
    }
    blocks.push(Block::Subheading("Runs".into()));
    blocks.push(Block::Table(table_of_runs(&groups)));
    blocks.push(Block::Fold("Configuration in full".into(), vec![Block::Table(complete(&groups))]));
    blocks.push(Block::Fold("Versions, machines and times".into(), vec![Block::Table(sessions(&runs))]));
    let mut commands = Vec::new();
    for run in &runs {
        commands.push(command(run, program)?);
        commands.push(test_command(run, program)?);
        for tested in &run.protocols {
            commands.push(command_of(tested, run, program)?);
        }
        commands.push(shell(&[program.into(), "replay".into(), run.name()])?);
    }
    blocks.push(Block::Subheading("Commands".into()));
    blocks.push(Block::Commands(commands));
    Ok(blocks)
}

fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    let end = if text.ends_with(['.', '?', '!']) { "" } else { "." };
    first.map_or_else(String::new, |first| format!("{first}{}{end}", letters.as_str()))
}

/// Warns about identical runs.
fn twins(groups: &[Group<'_>]) -> Vec<Block> {
    let mut blocks = Vec::new();
    for group in groups {
        for pair in group.runs.windows(2).filter(|pair| pair[0].plan.seed == pair[1].plan.seed) {
            blocks.push(Block::Text(format!(
                "Warning: {} and {} have the same configuration and seed: they are one run counted twice.",
                pair[0].name(),
                pair[1].name()
            )));
        }
    }
    blocks
}

/// Returns the task of the runs, a column per group.
fn task(groups: &[Group<'_>]) -> Result<Table, Error> {
    let mut table = Table::new(&["condition"]);
    let rows = ["seeds", "generations", "individuals", "trials", "steps of a trial", "network", "genome", "fitness"];
    table.rows = rows.iter().map(|&row| vec![row.to_owned()]).collect();
    for group in groups {
        let Some(run) = group.runs.first() else { continue };
        let evaluator = run.plan.evaluator()?;
        let description = evaluator.info().description;
        let list = |numbers: &mut dyn Iterator<Item = String>| {
            let mut numbers: Vec<String> = numbers.collect();
            numbers.dedup();
            numbers.join(", ")
        };
        let seconds = description.step_seconds * description.steps as f64;
        let clock = if seconds > 0.0 { format!(" ({seconds:?} s)") } else { String::new() };
        let cells = [
            list(&mut group.runs.iter().map(|run| run.plan.seed.to_string())),
            list(&mut group.runs.iter().map(|run| match run.plan.generations() {
                Ok(all) if all as usize > run.lines.len() => format!("{} of {all}", run.lines.len()),
                _ => run.lines.len().to_string(),
            })),
            match (run.value(POPULATION), evaluator.info().populations.len()) {
                // The strategy chooses the size.
                (Some(Value::Whole(0)), _) => "chosen by the strategy".into(),
                (Some(size), 1) => size.to_string(),
                (Some(size), populations) => format!("{populations} populations of {size}"),
                (None, _) => "1 parent and 1 mutant".into(),
            },
            evaluator.info().trials.to_string(),
            format!("at most {}{clock}", description.steps),
            description.network,
            {
                let (genes, bits) = (evaluator.info().parameters.len(), run.plan.experiment.gene_bits());
                format!("{} of {}", counted(genes, "gene"), counted(bits as usize, "bit"))
            },
            match (evaluator.info().combined(), evaluator.info().terms.join(" + ")) {
                (combined, terms) if combined.is_empty() => terms,
                (combined, terms) => format!("{combined}: {terms}"),
            },
        ];
        table.head.push(group.label.clone());
        for (row, cell) in table.rows.iter_mut().zip(cells) {
            row.push(cell);
        }
    }
    Ok(table)
}

/// Lists the results of tests, or the commands that run them.
fn tests(groups: &[Group<'_>], program: &str) -> Result<Vec<Block>, Error> {
    let mut names: Vec<&str> = Vec::new();
    for test in groups.iter().flat_map(|group| &group.runs).filter_map(|run| run.test.as_ref()) {
        for (name, _) in &test.findings.notes {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
    }
    let tests = groups.iter().flat_map(|group| &group.runs).filter_map(|run| run.test.as_ref());
    let broken_down = tests.clone().any(|test| test.findings.broken_down > 0);
    let mut table = Table::new(&["run", "champion of", "trials"]);
    table.head.extend(broken_down.then(|| "broken down".to_owned()));
    table.head.extend(["success", "fitness"].map(str::to_owned));
    table.head.extend(names.iter().map(|&name| name.to_owned()));
    // Last, since it is the widest.
    table.head.push("trial by trial".into());
    let mut missing = Vec::new();
    for group in groups {
        let mut rows: Vec<Vec<String>> = Vec::new();
        for run in &group.runs {
            let Some(test) = &run.test else {
                missing.push(test_command(run, program)?);
                continue;
            };
            let findings = &test.findings;
            let champion = match &test.record {
                None => "not recorded".into(),
                Some(record) => {
                    let other = run.other_champion(record.generation).map(|other| format!(": {other}"));
                    format!("generation {}{}", record.generation, other.unwrap_or_default())
                }
            };
            let by_trial = findings.by_trial.values();
            let by_trial: Vec<String> = by_trial.map(|share| percent(share.rate())).collect();
            let mut row = vec![run.name(), champion, findings.trials.to_string()];
            row.extend(broken_down.then(|| findings.broken_down.to_string()));
            row.extend([
                if findings.successes.is_none() { NO_CRITERION.into() } else { percent(findings.rate) },
                short(findings.fitness),
            ]);
            for &name in &names {
                let found = findings.notes.iter().find(|note| note.0 == name);
                row.push(match found.map(|note| &note.1) {
                    None => String::new(),
                    Some(Finding::Mean(mean)) => short(*mean),
                    Some(Finding::Counts(counts)) => {
                        let share =
                            |(word, &count): (&String, &usize)| format!("{word} {}", percent(findings.part(count)));
                        counts.iter().map(share).collect::<Vec<_>>().join(", ")
                    }
                });
            }
            // Many kinds of trials are only counted.
            row.push(if by_trial.len() > 8 { format!("{} kinds", by_trial.len()) } else { by_trial.join(", ") });
            rows.push(row);
        }
        let middle = (rows.len() > 1).then(|| middle(group, &names, broken_down));
        table.rows.append(&mut rows);
        table.rows.extend(middle);
    }
    let mut blocks = Vec::new();
    if !table.rows.is_empty() {
        let without = if broken_down { " that did not break down" } else { "" };
        blocks.push(Block::Text(format!(
            "Success as the experiment defines it, of all trials and of each kind of trial, and means over the \
             trials{without}. The last row of a condition is the median of its runs."
        )));
        blocks.push(Block::Table(table));
    }
    if !missing.is_empty() {
        blocks.push(Block::Text("Not tested yet. These commands run the tests:".into()));
        blocks.push(Block::Commands(missing));
    }
    Ok(blocks)
}

/// Lists the medians of a group's tests.
fn middle(group: &Group<'_>, names: &[&str], broken_down: bool) -> Vec<String> {
    let findings: Vec<_> = group.runs.iter().filter_map(|run| Some(&run.test.as_ref()?.findings)).collect();
    // A test in which every trial broke down has no value.
    let shown = |values: Vec<f64>, show: fn(f64) -> String| {
        let values: Vec<f64> = values.into_iter().filter(|x| !x.is_nan()).collect();
        median(&values).map_or_else(|| "–".into(), show)
    };
    let mut row = vec![format!("median, {}", group.label), String::new(), String::new()];
    row.extend(broken_down.then(String::new));
    row.extend([
        shown(findings.iter().map(|found| found.rate).collect(), percent),
        shown(findings.iter().map(|found| found.fitness).collect(), short),
    ]);
    for &name in names {
        let means = findings.iter().filter_map(|found| match found.notes.iter().find(|note| note.0 == name)?.1 {
            Finding::Mean(mean) => Some(mean),
            Finding::Counts(_) => None,
        });
        row.push(shown(means.collect(), short));
    }
    row.push(String::new());
    row
}

fn test_command(run: &Run<'_>, program: &str) -> Result<String, Error> {
    let mut words = vec![program.to_owned(), "test".into(), run.name()];
    if let Some(test) = &run.test {
        words.extend(["--trials".into(), test.findings.trials.to_string()]);
        words.extend(test.record.iter().flat_map(|record| ["--seed".into(), record.seed.to_string()]));
    }
    shell(&words)
}

fn table_of_runs(groups: &[Group<'_>]) -> Table {
    const FITNESS: [&str; 3] = ["last best", "last mean", "highest best"];
    let populations = Group::populations(groups);
    let mut table = Table::new(&["run", "condition", "seed", "generations"]);
    table.head.extend(populations.iter().flat_map(|(_, name)| FITNESS.map(|what| whose(what, name))));
    table.head.extend(["evaluations", "failed", "time"].map(String::from));
    for (group, run) in groups.iter().flat_map(|group| group.runs.iter().map(move |run| (group, run))) {
        let sum = |what: fn(&crate::store::log::Line) -> u64| run.lines.iter().map(what).sum::<u64>().to_string();
        let mut row = vec![run.name(), group.label.clone(), run.plan.seed.to_string(), run.lines.len().to_string()];
        for (population, _) in &populations {
            let best = (0..run.lines.len()).map(|at| run.fitness(*population, at, 0));
            row.extend([0, 1].map(|which| short(run.fitness(*population, run.last(), which))));
            row.push(short(best.fold(f64::NEG_INFINITY, f64::max)));
        }
        row.extend([sum(|line| line.evaluations), sum(|line| line.failed), duration(run.seconds())]);
        table.rows.push(row);
    }
    table
}

/// Returns a row for every process that worked on a run.
fn sessions(runs: &[&Run<'_>]) -> Table {
    let mut table = Table::new(&[
        "run",
        "from",
        "FARSA",
        "values",
        "machine",
        "threads",
        "lanes",
        "generations",
        "evaluations",
        "time",
        "a second",
    ]);
    for run in runs {
        for session in &run.manifest.sessions {
            let start = UNIX_EPOCH.checked_add(Duration::from_secs(session.started_unix));
            table.rows.push(vec![
                run.name(),
                start.map(|start| humantime::format_rfc3339_seconds(start).to_string()).unwrap_or_default(),
                session.farsa.clone(),
                format!("{}, {}", run.manifest.values_version, run.manifest.experiment_version),
                session.machine.describe(),
                session.threads.to_string(),
                format!("{}, {}", session.lanes.lanes, session.lanes.simd),
                session.generations.to_string(),
                session.evaluations.to_string(),
                duration(session.seconds),
                short(session.evaluations as f64 / session.seconds),
            ]);
        }
    }
    table
}

/// Returns a champion's picture with its caption. The index `place` makes its names unique on the page.
fn champion(run: &Run<'_>, place: usize) -> Result<Option<Figure>, Error> {
    let prefix = format!("{}-{place}", run.plan.experiment.name());
    let portrait = draw::champion(&run.plan, &run.directory, &prefix)?;
    Ok(portrait.map(|Portrait { picture, cut }| {
        let moment = match cut {
            None => "the end of its champion's best trial".into(),
            Some(time) => format!("its champion's best trial after {time:.2} s, as the rest exceeds memory"),
        };
        Figure { kind: "champion", picture, caption: format!("{}: {moment}.", run.name()) }
    }))
}
