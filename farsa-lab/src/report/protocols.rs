//! Results of test protocols, a table and a figure for each.

use crate::error::Error;
use crate::evaluation::protocols::case_summary;
use crate::evaluation::protocols::files::ProtocolRecord;
use crate::experiment::protocol::{Case, Protocol};
use crate::figures::bar_list::{Bar, BarList};
use crate::figures::heat_map::{HeatCell, HeatMap};
use crate::figures::rates::{self, RateCurve, Rates};
use crate::figures::significant::{percent, significant};
use crate::figures::statistics::Quartiles;
use crate::report::generalisation::{HeldOut, generalisation};
use crate::report::page::{Block, Figure, Table};
use crate::report::run::{Group, Run};
use crate::report::settings::shell;
use crate::report::states::states;
use crate::report::tested_protocol::TestedProtocol;

/// Returns the command that repeats the test.
pub(crate) fn command_of(tested: &TestedProtocol, run: &Run<'_>, program: &str) -> Result<String, Error> {
    let mut words = vec![program.into(), "test".into(), run.name(), "--protocol".into(), tested.protocol.name.clone()];
    if let Some(ProtocolRecord { trials, seed, .. }) = &tested.record {
        words.extend(["--trials".into(), trials.to_string(), "--seed".into(), seed.to_string()]);
    }
    shell(&words)
}

/// Runs with the same tested cases.
struct Alike<'r> {
    label: &'r str,
    cases: Vec<Case>,
    runs: Vec<(&'r Run<'r>, &'r TestedProtocol)>,
}

/// Lists the results of each protocol in each group of runs.
pub(crate) fn protocols(groups: &[Group<'_>]) -> Vec<Block> {
    let mut names: Vec<&str> = Vec::new();
    for tested in groups.iter().flat_map(|group| &group.runs).flat_map(|run| &run.protocols) {
        if !names.contains(&tested.protocol.name.as_str()) {
            names.push(&tested.protocol.name);
        }
    }
    let mut blocks = Vec::new();
    for name in names {
        blocks.push(Block::Subheading(format!("Test protocol {name}")));
        let alike = alike(groups, name);
        if let Some((_, tested)) = alike.first().and_then(|alike| alike.runs.first()) {
            let summary = &tested.protocol.summary;
            let held_out = if tested.found.iter().any(|case| case.held_out) {
                " Held-out cases are of a kind that was not among the trials of the evolution."
            } else {
                ""
            };
            let how = "Every case has the same fresh starts. Intervals of 95 % by Wilson's score.";
            blocks.push(Block::Text(format!("{summary}. {how}{held_out}")));
        }
        let figures = alike.iter().flat_map(|alike| [alike.figure(), alike.curves()]).flatten().collect::<Vec<_>>();
        if !figures.is_empty() {
            blocks.push(Block::Figures(figures));
        }
        blocks.extend(generalisation(&alike.iter().filter_map(Alike::held_out).collect::<Vec<_>>()));
        for alike in &alike {
            blocks.extend(alike.halves().map(Block::Text));
            blocks.extend(alike.tables());
        }
    }
    blocks
}

/// Lists the protocols without tests of some runs, with a command for the first of these runs.
pub(crate) fn not_run(groups: &[Group<'_>], program: &str) -> Result<Vec<Block>, Error> {
    let mut others: Vec<(&Protocol, Vec<&Run<'_>>)> = Vec::new();
    for &run in groups.iter().flat_map(|group| &group.runs) {
        for protocol in &run.other_protocols {
            match others.iter_mut().find(|(other, _)| other.name == protocol.name) {
                Some((_, runs)) => runs.push(run),
                None => others.push((protocol, vec![run])),
            }
        }
    }
    let run_count = groups.iter().map(|group| group.runs.len()).sum::<usize>();
    let mut table = Table::new(&["protocol", "purpose", "not run with", "command"]);
    for (protocol, runs) in others {
        let Some(first) = runs.first() else { continue };
        let missing = if run_count == 1 { first.name() } else { format!("{} of {run_count} runs", runs.len()) };
        let words = [program.into(), "test".into(), first.name(), "--protocol".into(), protocol.name.clone()];
        table.rows.push(vec![protocol.name.clone(), protocol.summary.clone(), missing, shell(&words)?]);
    }
    let heading = Block::Subheading("Test protocols that were not run".into());
    Ok(if table.rows.is_empty() { Vec::new() } else { vec![heading, Block::Table(table)] })
}

/// Lists the runs of each group with the same tested cases.
fn alike<'r>(groups: &'r [Group<'r>], name: &str) -> Vec<Alike<'r>> {
    let mut alike: Vec<Alike<'r>> = Vec::new();
    for group in groups {
        let first = alike.len();
        for &run in &group.runs {
            let Some(tested) = run.protocols.iter().find(|tested| tested.protocol.name == name) else { continue };
            let cases = tested.cases();
            match alike.iter_mut().skip(first).find(|alike| alike.cases == cases) {
                Some(alike) => alike.runs.push((run, tested)),
                None => alike.push(Alike { label: &group.label, cases, runs: vec![(run, tested)] }),
            }
        }
    }
    alike
}

impl Alike<'_> {
    /// Gets the name of the run or group.
    fn whose(&self) -> String {
        match self.runs.as_slice() {
            [(run, _)] => run.name(),
            runs => format!("{}, {} runs", self.label, runs.len()),
        }
    }

    /// Returns the share of success of a case in each run, without runs in which all trials broke down.
    fn rates(&self, case: usize) -> Vec<f64> {
        let rates = self.runs.iter().filter_map(|(_, tested)| Some(tested.found.get(case)?.findings.rate));
        rates.filter(|rate| !rate.is_nan()).collect()
    }

    /// Returns the results in held-out cases, if any.
    fn held_out(&self) -> Option<HeldOut<'_>> {
        let cases: Vec<usize> = (0..self.cases.len()).filter(|case| self.cases[*case].held_out).collect();
        let names = cases.iter().map(|case| self.cases[*case].name()).collect();
        let rates = |tested: &TestedProtocol| cases.iter().map(|case| tested.found[*case].findings.rate).collect();
        let runs = self.runs.iter().map(|(_, tested)| rates(tested)).collect();
        (!cases.is_empty() && self.has_success()).then_some(HeldOut { label: self.label, cases: names, runs })
    }

    /// Returns the mean share of a case, a note, and the ends of its interval or the extremes of several runs.
    fn share(&self, case: usize) -> (f64, String, [f64; 2]) {
        let rates = self.rates(case);
        let mean = rates.iter().sum::<f64>() / rates.len() as f64;
        if let [(_, tested)] = self.runs.as_slice() {
            return tested.found.get(case).map_or((f64::NAN, String::new(), [f64::NAN; 2]), |case| {
                let successes = case.findings.successes.unwrap_or_default();
                (mean, format!("{successes} of {}", case.findings.trials), case.findings.interval)
            });
        }
        if rates.is_empty() {
            return (f64::NAN, String::new(), [f64::NAN; 2]);
        }
        let ends = rates.iter().fold([1.0, 0.0], |[low, high], x| [x.min(low), x.max(high)]);
        let [low, high] = ends.map(|share: f64| format!("{:.0}", 100.0 * share));
        (mean, format!("{low} to {high}"), ends)
    }

    /// Checks if the task has a criterion of success.
    fn has_success(&self) -> bool {
        let cases = self.runs.iter().flat_map(|(_, tested)| &tested.found);
        cases.into_iter().any(|case| case.findings.successes.is_some())
    }

    fn figure(&self) -> Option<Figure> {
        let (_, tested) = self.runs.first().filter(|_| self.has_success())?;
        let Protocol { name, axes, .. } = &tested.protocol;
        let rows = Protocol::places(&self.cases, |case| &case.row);
        let columns = Protocol::places(&self.cases, |case| &case.column);
        let title = format!("{name}: success");
        let several = if self.runs.len() > 1 { "mean of the runs, with the lowest and the highest" } else { "" };
        let picture = if rows.len() > 1 && columns.len() > 1 {
            let place = |names: &[&str], own: &str| names.iter().position(|name| *name == own);
            let cell = |(number, case): (usize, &Case)| {
                let (share, below, _) = self.share(number);
                let place = [place(&rows, &case.row)?, place(&columns, &case.column)?];
                Some(HeatCell { place, share, below, outlined: case.held_out })
            };
            let cells: Vec<HeatCell> = self.cases.iter().enumerate().filter_map(cell).collect();
            let axes = axes.each_ref().map(String::as_str);
            HeatMap { title: &title, axes, rows: &rows, columns: &columns, cells: &cells }.draw()?
        } else {
            let bar = |(number, case)| self.bar(number, case, columns.len() > 1);
            let bars: Vec<Bar<'_>> = self.cases.iter().enumerate().map(bar).collect();
            BarList { title: &title, bars: &bars }.draw()?
        };
        let end = if several.is_empty() { ".".to_owned() } else { format!(": {several}.") };
        let caption = format!("{}: share of the trials that succeeded{end}", self.whose());
        Some(Figure { kind: "protocol", picture, caption })
    }

    /// Returns a curve of shares per column over rows that are numbers, `None` for other rows or missing cells.
    fn rates_by_row(&self) -> Option<(Vec<&str>, Vec<RateCurve<'_>>)> {
        if !self.has_success() {
            return None;
        }
        let rows = Protocol::places(&self.cases, |case| &case.row);
        let columns = Protocol::places(&self.cases, |case| &case.column);
        rates::values(&rows)?;
        let curve = |name: &'_ str| -> Option<Vec<(f64, [f64; 2])>> {
            let of_row = |row: &&str| {
                let case = self.cases.iter().position(|case| case.row == *row && case.column == name)?;
                let (share, _, interval) = self.share(case);
                Some((share, interval))
            };
            rows.iter().map(of_row).collect()
        };
        let curves: Option<Vec<RateCurve<'_>>> =
            columns.into_iter().map(|name| Some(RateCurve { name, shares: curve(name)? })).collect();
        Some((rows, curves?))
    }

    /// Draws the shares over rows that are numbers.
    fn curves(&self) -> Option<Figure> {
        let (labels, curves) = self.rates_by_row()?;
        let (_, tested) = self.runs.first()?;
        let Protocol { name, axes: [axis, _], .. } = &tested.protocol;
        let picture = Rates { title: &format!("{name}: success"), axis, labels: &labels, curves: &curves }.draw()?;
        let bars = if self.runs.len() > 1 { "bars from the lowest run to the highest" } else { "bars of 95 %" };
        let caption = format!("{}: share of the trials that succeeded, {bars}.", self.whose());
        Some(Figure { kind: "rates", picture, caption })
    }

    /// Describes the rows at which shares fall to half of their first value.
    fn halves(&self) -> Option<String> {
        let (labels, curves) = self.rates_by_row()?;
        let (values, unit) = rates::values(&labels)?;
        let half = |curve: &RateCurve<'_>| {
            let at = curve.half(&values)?;
            let name = if curve.name.is_empty() { "the share".to_owned() } else { format!("“{}”", curve.name) };
            Some(format!("{name} falls to half of its first value at {} {unit}", significant(at)).trim_end().to_owned())
        };
        let halves: Vec<String> = curves.iter().filter_map(half).collect();
        (!halves.is_empty()).then(|| format!("{}: {}.", self.whose(), halves.join("; ")))
    }

    /// Returns the bar of a case, named after its column or row.
    fn bar<'c>(&self, number: usize, case: &'c Case, by_column: bool) -> Bar<'c> {
        let (share, _, interval) = self.share(number);
        let label = if by_column { &case.column } else { &case.row };
        Bar { label, share, interval, outlined: case.held_out }
    }

    fn tables(&self) -> Vec<Block> {
        let Some((run, tested)) = self.runs.first() else { return Vec::new() };
        let single = |tested: &TestedProtocol| {
            let (rows, _) = case_summary::rows(&tested.protocol, &tested.found);
            let mut rows = rows.into_iter();
            Table { head: rows.next().unwrap_or_default(), rows: rows.collect() }
        };
        let champion = |run: &Run<'_>, tested: &TestedProtocol| {
            let generation = match &tested.record {
                None => "which was not recorded".into(),
                Some(record) => {
                    let other = run.other_champion(record.generation).map(|other| format!(", {other}"));
                    format!("of generation {}{}", record.generation, other.unwrap_or_default())
                }
            };
            format!("{}: the champion {generation}.", run.name())
        };
        if self.runs.len() == 1 {
            let mut blocks = vec![Block::Text(champion(run, tested)), Block::Table(single(tested))];
            blocks.extend(states(run, tested));
            return blocks;
        }
        let mut table = Table::new(&["case", "median", "quartiles", "lowest", "highest"]);
        for (number, case) in self.cases.iter().enumerate() {
            let gap = Quartiles { lower: f64::NAN, median: f64::NAN, upper: f64::NAN };
            let Quartiles { lower, median, upper } = Quartiles::from_values(&self.rates(number)).unwrap_or(gap);
            let (_, _, ends) = self.share(number);
            let held_out = if case.held_out { ", held out" } else { "" };
            let mut row = vec![format!("{}{held_out}", case.name()), percent(median)];
            row.push(format!("{} to {}", percent(lower), percent(upper)));
            row.extend(ends.map(percent));
            table.rows.push(row);
        }
        let details = self.runs.iter().flat_map(|(run, tested)| {
            let blocks = [Block::Text(champion(run, tested)), Block::Table(single(tested))];
            blocks.into_iter().chain(states(run, tested))
        });
        let each = Block::Fold(format!("Each of the {} runs", self.runs.len()), details.collect());
        if !self.has_success() {
            return vec![each];
        }
        let text = format!("{}: share of the trials that succeeded.", self.whose());
        vec![Block::Text(text), Block::Table(table), each]
    }
}
