//! A table of runs, with their differences and results.

use std::path::Path;

use crate::error::Error;
use crate::evaluation::test;
use crate::experiment::settings::Value;
use crate::merge::gather::Gathered;
use crate::store::log::Line;
use crate::strategy::settings::{GENERATIONS, STRATEGY};

/// Formats a CSV line for each generation of each population of each run, with the given place of the run.
///
/// # Errors
/// [`Error::File`] if the table cannot be written, and the errors of preparing an experiment.
pub(crate) fn curves(runs: &[(&Gathered<'_>, &Path)]) -> Result<Vec<u8>, Error> {
    let keys = differing(runs);
    let mut writer = csv::Writer::from_writer(Vec::new());
    let refused = |error: &dyn std::fmt::Display| Error::damaged(Path::new("the table of the curves"), error);
    let columns = ["population", "generation", "evaluations", "failed", "best", "mean", "worst"];
    let head = HEAD.into_iter().chain(keys.iter().copied()).chain(columns);
    writer.write_record(head).map_err(|error| refused(&error))?;
    for (run, place) in runs {
        let (start, names) = (labels(run, place, &keys), names(run)?);
        for (generation, line) in run.lines.iter().enumerate() {
            let Line { evaluations, failed, .. } = line;
            let rows = if line.each.is_empty() { std::slice::from_ref(&line.row) } else { &line.each };
            for (population, row) in rows.iter().enumerate() {
                let name = names.get(population).cloned().unwrap_or_default();
                let mut cells = vec![name, generation.to_string(), evaluations.to_string(), failed.to_string()];
                cells.extend(row.iter().map(|x| number(Some(*x))));
                writer.write_record(start.iter().chain(&cells)).map_err(|error| refused(&error))?;
            }
        }
    }
    writer.into_inner().map_err(|error| refused(&error))
}

/// First columns, which name a run.
const HEAD: [&str; 5] = ["directory", "experiment", "condition", "strategy", "seed"];

/// Lists the fields of a run for [`HEAD`] and for these settings.
fn labels(run: &Gathered<'_>, place: &Path, keys: &[&str]) -> Vec<String> {
    let plan = &run.plan;
    let mut row = vec![
        place.display().to_string(),
        plan.experiment.name().to_owned(),
        plan.condition.clone(),
        plan.definition().name().to_owned(),
        plan.seed.to_string(),
    ];
    row.extend(keys.iter().map(|key| plan.settings.get(key).map(plain).unwrap_or_default()));
    row
}

/// Formats a number, or nothing without a successful evaluation.
fn number(x: Option<f64>) -> String {
    x.filter(|x| x.is_finite()).map(|x| format!("{x:?}")).unwrap_or_default()
}

/// Formats a CSV line for each run, with the given place.
///
/// # Errors
/// The errors of reading a test, and [`Error::File`] if the table cannot be written.
pub(crate) fn csv(runs: &[(&Gathered<'_>, &Path)]) -> Result<Vec<u8>, Error> {
    let keys = differing(runs);
    let populations = populations(runs)?;
    let mut head: Vec<String> = HEAD.map(str::to_owned).into();
    head.extend(keys.iter().map(|&key| key.to_owned()));
    head.extend(
        ["generations", "finished", "evaluations", "failed", "best", "mean", "highest best"].map(str::to_owned),
    );
    head.extend(populations.iter().flat_map(|name| [format!("best {name}"), format!("mean {name}")]));
    let test = ["test generation", "test trials", "test broken down", "test success", "test fitness"];
    head.extend(test.map(str::to_owned));
    let mut writer = csv::Writer::from_writer(Vec::new());
    let refused = |error: &dyn std::fmt::Display| Error::damaged(Path::new("the table of the runs"), error);
    writer.write_record(&head).map_err(|error| refused(&error))?;
    for (run, place) in runs {
        writer.write_record(row(run, place, &keys, &populations)?).map_err(|error| refused(&error))?;
    }
    writer.into_inner().map_err(|error| refused(&error))
}

fn row(run: &Gathered<'_>, place: &Path, keys: &[&str], populations: &[String]) -> Result<Vec<String>, Error> {
    let mut row = labels(run, place, keys);
    let sum = |what: fn(&Line) -> u64| run.lines.iter().map(what).sum::<u64>().to_string();
    row.extend([run.lines.len().to_string(), run.is_finished().to_string()]);
    row.extend([sum(|line| line.evaluations), sum(|line| line.failed)]);
    let last = run.lines.last();
    row.extend([0, 1].map(|which| number(last.map(|line| line.row[which]))));
    row.push(number(run.lines.iter().map(|line| line.row[0]).reduce(f64::max)));
    let names = names(run)?;
    for name in populations {
        let place = names.iter().position(|other| other == name);
        let each = place.and_then(|place| last?.each.get(place));
        row.extend([0, 1].map(|which| number(each.map(|row| row[which]))));
    }
    let test = match test::read(&run.directory)? {
        None => Default::default(),
        Some((table, record)) => {
            let findings = table.findings(&run.plan.evaluator()?.info().terms);
            [
                record.map(|record| record.generation.to_string()).unwrap_or_default(),
                findings.trials.to_string(),
                findings.broken_down.to_string(),
                number(Some(findings.rate)),
                number(Some(findings.fitness)),
            ]
        }
    };
    row.extend(test);
    Ok(row)
}

/// Lists the names of a run's populations, if there are several.
fn names(run: &Gathered<'_>) -> Result<Vec<String>, Error> {
    let several = run.lines.last().is_some_and(|line| !line.each.is_empty());
    Ok(if several { run.plan.evaluator()?.info().populations } else { Vec::new() })
}

/// Returns the distinct names of all populations of runs with several.
fn populations(runs: &[(&Gathered<'_>, &Path)]) -> Result<Vec<String>, Error> {
    let mut populations: Vec<String> = Vec::new();
    let mut kinds: Vec<(&str, &str)> = Vec::new();
    for (run, _) in runs {
        let kind = (run.plan.experiment.name(), run.plan.condition.as_str());
        if !kinds.contains(&kind) && !run.lines.is_empty() {
            kinds.push(kind);
            populations.extend(names(run)?.into_iter().filter(|name| !populations.contains(name)).collect::<Vec<_>>());
        }
    }
    Ok(populations)
}

/// Lists the settings in which two runs differ, in the order of their tables.
fn differing<'r>(runs: &[(&'r Gathered<'_>, &Path)]) -> Vec<&'r str> {
    let mut keys: Vec<(&str, &Value, bool)> = Vec::new();
    for (run, _) in runs {
        let settings = &run.plan.settings;
        for key in settings.table().iter().map(crate::experiment::settings::Setting::key) {
            let Some(value) = settings.get(key).ok().filter(|_| ![GENERATIONS, STRATEGY].contains(&key)) else {
                continue;
            };
            match keys.iter_mut().find(|known| known.0 == key) {
                Some((_, first, differs)) => *differs |= *first != value,
                None => keys.push((key, value, false)),
            }
        }
    }
    keys.into_iter().filter(|key| key.2).map(|key| key.0).collect()
}

/// Formats a value without the quotes of a word.
fn plain(value: &Value) -> String {
    match value {
        Value::Word(word) => word.clone(),
        other => other.to_string(),
    }
}
