//! Configurations of the runs in a report: differences, complete tables, and commands.

use crate::error::Error;
use crate::experiment::settings::Setting;
use crate::report::page::Table;
use crate::report::run::{Group, Run};
use crate::strategy::settings::{GENERATIONS, POPULATION};

/// Finds the settings in which groups differ, a column per group, or `None` without differences.
pub(crate) fn differences(groups: &[Group<'_>]) -> Option<Table> {
    let mut table = Table::new(&["setting"]);
    table.head.extend(groups.iter().map(|group| group.label.clone()));
    table.head.push("unit".into());
    for setting in settings(groups).into_iter().filter(|setting| setting.key() != GENERATIONS) {
        let values: Vec<Option<String>> =
            groups.iter().map(|group| Some(group.runs.first()?.value(setting.key())?.to_string())).collect();
        if values.windows(2).any(|pair| pair[0] != pair[1]) {
            let values = values.into_iter().map(|value| value.unwrap_or_else(|| "no such setting".into()));
            let row = std::iter::once(setting.key().to_owned()).chain(values);
            table.rows.push(row.chain([setting.unit_name().to_owned()]).collect());
        }
    }
    (!table.rows.is_empty()).then_some(table)
}

/// Returns every setting with its values and sources.
pub(crate) fn complete(groups: &[Group<'_>]) -> Table {
    let mut table = Table::new(&["setting", "value", "unit", "source", "meaning"]);
    for setting in settings(groups) {
        let key = setting.key();
        let mut values: Vec<String> = Vec::new();
        let mut sources: Vec<String> = Vec::new();
        for run in groups.iter().flat_map(|group| &group.runs) {
            let (Some(value), Some(own)) = (run.value(key), own(run, key)) else { continue };
            let source = if value == own.default_value() {
                own.source().name().into()
            } else {
                format!("set; the default {} is {}", own.default_value(), own.source().name())
            };
            for (list, new) in [(&mut values, value.to_string()), (&mut sources, source)] {
                if !list.contains(&new) {
                    list.push(new);
                }
            }
        }
        table.rows.push(vec![
            key.into(),
            values.join(" / "),
            setting.unit_name().into(),
            sources.join(" / "),
            setting.doc_text().into(),
        ]);
    }
    table
}

/// Returns the command that repeats the run in another directory.
pub(crate) fn command(run: &Run<'_>, program: &str) -> Result<String, Error> {
    let plan = &run.plan;
    let mut words: Vec<String> = vec![program.into(), "run".into(), plan.experiment.name().into()];
    if !plan.condition.is_empty() {
        words.extend(["--condition".into(), plan.condition.clone()]);
    }
    words.extend(["--seed".into(), plan.seed.to_string()]);
    // Finished generations, not planned ones.
    words.extend(["--generations".into(), run.lines.len().to_string()]);
    for setting in plan.settings.table() {
        let (key, value) = (setting.key(), plan.settings.get(setting.key())?);
        if value != setting.default_value() && key != GENERATIONS {
            match key {
                POPULATION => words.extend(["--population".into(), value.to_string()]),
                _ => words.extend(["--set".into(), format!("{key}={value}")]),
            }
        }
    }
    words.extend(["--out".into(), format!("{}-again", run.name())]);
    shell(&words)
}

/// Quotes words for a shell.
pub(crate) fn shell(words: &[String]) -> Result<String, Error> {
    shlex::try_join(words.iter().map(String::as_str)).map_err(|error| Error::Other(error.to_string()))
}

/// Lists the settings of all groups without duplicates, in the order of the first.
fn settings<'r>(groups: &[Group<'r>]) -> Vec<&'r Setting> {
    let mut settings: Vec<&Setting> = Vec::new();
    for run in groups.iter().filter_map(|group| group.runs.first().copied()) {
        for setting in run.plan.settings.table() {
            if !settings.iter().any(|known| known.key() == setting.key()) {
                settings.push(setting);
            }
        }
    }
    settings
}

fn own<'r>(run: &'r Run<'_>, key: &str) -> Option<&'r Setting> {
    run.plan.settings.table().iter().find(|setting| setting.key() == key)
}
