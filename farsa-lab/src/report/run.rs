//! A run as a report reads it, and groups of runs that differ only in their seeds.

use std::cmp::Ordering;
use std::time::Duration;

use crate::error::Error;
use crate::evaluation::findings::Findings;
use crate::evaluation::generations::{self, SampledTest, SampledTests};
use crate::evaluation::test::{self, Record};
use crate::evaluation::test_table::Table;
use crate::experiment::protocol::Protocol;
use crate::experiment::settings::Value;
use crate::report::tested_protocol::TestedProtocol;
use crate::run::begin::resumed;
use crate::run::collection::CollectionTable;
use crate::run::plan::Plan;
use crate::run::record_file::RunRecord;
use crate::run::records::{Checkpoint, evolved};
use crate::store::directory::Directory;
use crate::store::log::Line;
use crate::store::manifest::Manifest;
use crate::strategy::settings::GENERATIONS;

/// Parts of a run that a report shows.
pub(crate) struct Run<'e> {
    pub(crate) directory: Directory,
    pub(crate) plan: Plan<'e>,
    pub(crate) manifest: Manifest,
    /// Names of the populations, none of a single one.
    pub(crate) populations: Vec<String>,
    /// Finished generations, at least one.
    pub(crate) lines: Vec<Line>,
    /// Generation of the champion.
    champion: u32,
    /// Values of the strategy in each generation, if it reports any.
    pub(crate) diagnostics: Vec<Vec<f64>>,
    /// Figure of the strategy's archive or front, if it has one.
    pub(crate) kept: Option<String>,
    /// Best fitness up to each generation, empty unless the champion is the best of all.
    best: Vec<f64>,
    pub(crate) test: Option<Tested>,
    /// Tests of the best of every n-th generation.
    pub(crate) sampled: Option<SampledTests>,
    /// Tested protocols, in the experiment's order.
    pub(crate) protocols: Vec<TestedProtocol>,
    /// Other protocols, in the same order.
    pub(crate) other_protocols: Vec<Protocol>,
}

/// Test of a run's champion.
pub(crate) struct Tested {
    pub(crate) findings: Findings,
    /// `None` for a test of an early version.
    pub(crate) record: Option<Record>,
}

impl<'e> Run<'e> {
    /// Reads a run up to its last checkpoint. It may still be running.
    ///
    /// # Errors
    /// [`Error::File`] for a damaged file and without a finished generation, [`Error::Usage`] for a changed
    /// configuration, [`Error::Io`].
    pub(crate) fn read(directory: Directory, plan: Plan<'e>) -> Result<Self, Error> {
        evolved(&directory)?;
        let checkpoint = Checkpoint::read(&plan, &directory)?;
        let run_record = RunRecord::read(&plan, &directory, &checkpoint)?;
        let manifest = Manifest::read_or_new(&directory.manifest(), &run_record.identity)?;
        let Some(champion) = run_record.champion() else {
            return Err(Error::damaged(&directory.record(), "no generation is finished yet"));
        };
        let so_far = |best: &mut f64, line: &Line| {
            *best = best.max(line.row[0]);
            Some(*best)
        };
        let is_best =
            |row: &SampledTest| run_record.record.champion(0, row.generation) == Some(row.individual as usize);
        // Other individuals are those of an earlier run.
        let sampled = generations::read(&directory)?.filter(|tests| tests.rows.iter().all(is_best));
        let best =
            run_record.lines.iter().filter(|_| run_record.keeps_champion).scan(f64::NEG_INFINITY, so_far).collect();
        let evaluator = plan.evaluator()?;
        let kept = if plan.strategy()?.collection().is_some() {
            let search = resumed(&plan, &directory, &checkpoint, &run_record.record)?;
            CollectionTable::new(&search, evaluator.as_ref()).map(|table| table.drawn(&search, &plan.name()))
        } else {
            None
        };
        let RunRecord { lines, diagnostics, .. } = run_record;
        let (populations, terms) = (evaluator.info().populations, evaluator.info().terms);
        let populations = if populations.len() > 1 { populations } else { Vec::new() };
        let tested = |(table, record): (Table, Option<Record>)| Tested { findings: table.findings(&terms), record };
        let test = test::read(&directory)?.map(tested);
        let (protocols, other_protocols) = TestedProtocol::all(&directory, evaluator.as_ref())?;
        Ok(Self {
            directory,
            plan,
            manifest,
            populations,
            lines,
            champion,
            diagnostics,
            kept,
            best,
            test,
            sampled,
            protocols,
            other_protocols,
        })
    }

    /// Returns the name of the experiment, with its origin if one of the runs is of another origin.
    pub(crate) fn experiment(&self, runs: &[Self]) -> String {
        let (name, from_file) = (self.plan.experiment.name(), self.plan.experiment.definition().is_some());
        let differs = |other: &Self| {
            let other = other.plan.experiment;
            other.name() == name && other.definition().is_some() != from_file
        };
        match (runs.iter().any(differs), from_file) {
            (false, _) => name.into(),
            (true, true) => format!("{name} (from a file)"),
            (true, false) => format!("{name} (built in)"),
        }
    }

    /// Formats the directory as the user named it.
    pub(crate) fn name(&self) -> String {
        self.directory.path().display().to_string()
    }

    /// Gets the best (0), mean (1) or worst (2) fitness of a generation, of one population or of all.
    ///
    /// The best is the best so far where the champion is the best of all generations.
    pub(crate) fn fitness(&self, population: Option<usize>, generation: usize, which: usize) -> f64 {
        if let (0, Some(best)) = (which, self.best.get(generation)) {
            return *best;
        }
        let row = |line: &Line| match population {
            None => Some(line.row),
            Some(population) => line.each.get(population).copied(),
        };
        self.lines.get(generation).and_then(row).map_or(f64::NAN, |row| row[which])
    }

    /// Lists the populations with their names. A single population has no name.
    pub(crate) fn populations(&self) -> Vec<(Option<usize>, String)> {
        match self.populations.as_slice() {
            [] => vec![(None, String::new())],
            several => several.iter().enumerate().map(|(number, name)| (Some(number), name.clone())).collect(),
        }
    }

    /// Gets the last finished generation.
    pub(crate) fn last(&self) -> usize {
        self.lines.len().saturating_sub(1)
    }

    /// Compares the tested champion with the current one, which differs in a continued run and in runs of early versions.
    pub(crate) fn other_champion(&self, generation: u32) -> Option<&'static str> {
        match generation.cmp(&self.champion) {
            Ordering::Less => Some("an earlier one"),
            Ordering::Equal => None,
            Ordering::Greater => Some("a later one"),
        }
    }

    /// Gets the share of successful trials of the test, if it has one.
    pub(crate) fn success(&self) -> Option<f64> {
        self.test.as_ref().map(|Tested { findings, .. }| findings.rate).filter(|rate| !rate.is_nan())
    }

    /// Computes the time of all sessions [s].
    pub(crate) fn seconds(&self) -> f64 {
        self.manifest.sessions.iter().map(|session| session.seconds).sum()
    }

    /// Finds the value of a setting, `None` if this condition has no such setting.
    pub(crate) fn value(&self, key: &str) -> Option<&Value> {
        self.plan.settings.get(key).ok()
    }

    /// Returns keys and values of all settings that distinguish runs.
    fn settings(&self) -> impl Iterator<Item = (&str, Option<&Value>)> {
        let keys = self.plan.settings.table().iter().map(crate::experiment::settings::Setting::key);
        keys.filter(|&key| key != GENERATIONS).map(|key| (key, self.value(key)))
    }
}

/// Runs that differ only in seed and length.
#[derive(Clone)]
pub(crate) struct Group<'r> {
    /// Condition, with the settings that distinguish it from other groups of the same condition.
    pub(crate) label: String,
    pub(crate) runs: Vec<&'r Run<'r>>,
}

impl<'r> Group<'r> {
    /// Groups the runs of one experiment, in the order of its conditions.
    pub(crate) fn all(runs: &[&'r Run<'r>]) -> Vec<Self> {
        let Some(first) = runs.first() else { return Vec::new() };
        let conditions = first.plan.experiment.conditions();
        let place = |run: &Run<'_>| conditions.iter().position(|&condition| condition == run.plan.condition);
        let mut sorted = runs.to_vec();
        sorted.sort_by_key(|run| (place(run), run.plan.seed));
        let mut groups: Vec<Self> = Vec::new();
        for run in sorted {
            let same = |group: &&mut Self| {
                group.runs.first().is_some_and(|other| {
                    other.plan.condition == run.plan.condition && other.settings().eq(run.settings())
                })
            };
            match groups.iter_mut().find(same) {
                Some(group) => group.runs.push(run),
                None => groups.push(Self { label: String::new(), runs: vec![run] }),
            }
        }
        let labels: Vec<String> = groups.iter().map(|group| group.name(&groups)).collect();
        for (group, label) in groups.iter_mut().zip(labels) {
            group.label = label;
        }
        groups
    }

    /// Formats the condition, with the settings that distinguish this group from others of the condition.
    fn name(&self, groups: &[Self]) -> String {
        let Some(run) = self.runs.first() else { return String::new() };
        let plan = &run.plan;
        let condition = if plan.condition.is_empty() { plan.experiment.name() } else { &plan.condition };
        let others: Vec<&&Run<'_>> = groups
            .iter()
            .filter_map(|group| group.runs.first())
            .filter(|other| other.plan.condition == plan.condition)
            .collect();
        let strategy = |run: &Run<'_>| run.plan.definition().name();
        // Settings of a strategy do not distinguish it from another strategy, because the names do.
        let of_strategy = |key: &str| ["strategy.", "evolution."].iter().any(|section| key.starts_with(section));
        let differs = |key: &str, value: Option<&Value>| {
            let comparable = |other: &Run<'_>| strategy(other) == strategy(run) || !of_strategy(key);
            others.iter().any(|other| comparable(other) && other.value(key) != value)
        };
        let mut differences: Vec<String> = Vec::new();
        if others.iter().any(|other| strategy(other) != strategy(run)) {
            differences.push(strategy(run).to_owned());
        }
        // The last part of a key is enough for a name. The table of differences has whole keys.
        let settings = run.settings().filter(|(key, value)| differs(key, *value));
        differences.extend(settings.filter_map(|(key, value)| Some(format!("{}={}", key.rsplit('.').next()?, value?))));
        if differences.is_empty() { condition.into() } else { format!("{condition}, {}", differences.join(", ")) }
    }

    /// Describes the groups whose best is the best so far, or nothing.
    pub(crate) fn best_so_far(groups: &[Self]) -> String {
        let keeps = |group: &&Self| group.runs.iter().any(|run| !run.best.is_empty());
        let labels: Vec<&str> = groups.iter().filter(keeps).map(|group| group.label.as_str()).collect();
        if labels.is_empty() {
            return String::new();
        }
        format!(" The best so far where the champion is the best of all generations: {}.", labels.join("; "))
    }

    /// Lists the populations of the condition with the most of them.
    pub(crate) fn populations(groups: &[Self]) -> Vec<(Option<usize>, String)> {
        let runs = groups.iter().flat_map(|group| &group.runs);
        runs.map(|run| run.populations()).max_by_key(Vec::len).unwrap_or_default()
    }

    /// Gets the last common generation of the runs.
    pub(crate) fn common(&self) -> usize {
        self.runs.iter().map(|run| run.last()).min().unwrap_or(0)
    }
}

/// Formats the name of a column about a population.
pub(crate) fn whose(what: &str, name: &str) -> String {
    if name.is_empty() { what.into() } else { format!("{what}, {name}") }
}

/// Formats a number with five digits, or all digits of the integer part.
pub(crate) fn short(x: f64) -> String {
    if !x.is_finite() {
        return "–".into();
    }
    let (mut decimals, mut size) = (4, x.abs());
    while size >= 10.0 && decimals > 0 {
        (size, decimals) = (size / 10.0, decimals - 1);
    }
    if x != 0.0 && x.abs() < 1e-3 { format!("{x:.3e}") } else { format!("{x:.decimals$}") }
}

/// Formats a time.
pub(crate) fn duration(seconds: f64) -> String {
    let whole = seconds.clamp(0.0, 1e12);
    let duration =
        if whole < 1.0 { Duration::from_millis((1e3 * whole) as u64) } else { Duration::from_secs(whole as u64) };
    humantime::format_duration(duration).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_true() {
        let cases = [
            (0.0, "0.0000"),
            (1.25, "1.2500"),
            (-12.345678, "-12.346"),
            (3464.7337, "3464.7"),
            (123456.7, "123457"),
            (0.00012345, "1.234e-4"),
            (f64::NEG_INFINITY, "–"),
        ];
        for (x, text) in cases {
            assert_eq!(short(x), text);
        }
        assert_eq!((duration(442.9), duration(0.25), duration(-1.0)), ("7m 22s".into(), "250ms".into(), "0s".into()));
    }
}
