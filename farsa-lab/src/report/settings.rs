//! The configurations of the runs in a report: what differs, everything, and the commands that say it again.

use crate::error::Error;
use crate::experiment::settings::Setting;
use crate::report::page::Table;
use crate::report::run::{Group, Run};
use crate::strategy::settings::{GENERATIONS, POPULATION};

/// The settings in which the groups differ, a column for each group; none if they differ in nothing.
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

/// Every setting with its values and where they come from.
pub(crate) fn complete(groups: &[Group<'_>]) -> Table {
    let mut table = Table::new(&["setting", "value", "unit", "source", "what it is"]);
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

/// The command that makes the run again, in a directory beside it.
pub(crate) fn command(run: &Run<'_>, program: &str) -> Result<String, Error> {
    let plan = &run.plan;
    let mut words: Vec<String> = vec![program.into(), "run".into(), plan.experiment.name().into()];
    if !plan.condition.is_empty() {
        words.extend(["--condition".into(), plan.condition.clone()]);
    }
    words.extend(["--seed".into(), plan.seed.to_string()]);
    // The generations that are there, not those that may still come.
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

/// Words as a shell takes them.
pub(crate) fn shell(words: &[String]) -> Result<String, Error> {
    shlex::try_join(words.iter().map(String::as_str)).map_err(|error| Error::Other(error.to_string()))
}

/// The settings of all groups, in the order of the first, each once.
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
