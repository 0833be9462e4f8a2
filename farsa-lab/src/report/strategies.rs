//! Values that strategies report per generation, and the archives that they keep.

use crate::figures::chart::Chart;
use crate::figures::statistics::median;
use crate::report::curves::curves;
use crate::report::moment::Moment;
use crate::report::page::{Block, Figure, Table};
use crate::report::run::{Group, Run, short};

/// Returns curves, last values and archives of each strategy that has them.
pub(crate) fn strategies(groups: &[Group<'_>]) -> Vec<Block> {
    let mut names: Vec<&str> = Vec::new();
    for run in groups.iter().flat_map(|group| &group.runs) {
        let name = run.plan.definition().name();
        if (run.plan.definition().diagnostics().is_some() || run.kept.is_some()) && !names.contains(&name) {
            names.push(name);
        }
    }
    let mut blocks = Vec::new();
    for name in names {
        let has_strategy = |group: &&Group<'_>| group.runs.iter().any(|run| run.plan.definition().name() == name);
        let groups: Vec<Group<'_>> = groups.iter().filter(has_strategy).cloned().collect();
        blocks.push(Block::Subheading(format!("Values of {name}")));
        blocks.extend(values(&groups));
        let archives = groups.iter().flat_map(|group| &group.runs).filter_map(|run| {
            let caption = format!("{}: the archive or front of the last generation.", run.name());
            Some(Figure { kind: "archive", picture: run.kept.clone()?, caption })
        });
        let archives: Vec<Figure> = archives.collect();
        if !archives.is_empty() {
            blocks.push(Block::Figures(archives));
        }
    }
    blocks
}

/// Returns curves and last values of runs of one strategy.
fn values(groups: &[Group<'_>]) -> Vec<Block> {
    let diagnostics = groups.iter().flat_map(|group| &group.runs).find_map(|run| run.plan.definition().diagnostics());
    let charts = diagnostics.map_or(&[][..], |diagnostics| diagnostics.charts);
    let columns = charts.iter().flat_map(|chart| chart.curves.iter().map(move |(name, label)| (chart, *name, *label)));
    let columns: Vec<_> = columns.enumerate().collect();
    if columns.is_empty() {
        return Vec::new();
    }
    let across = Moment::common(groups).axis(groups);
    let number = |run: &Run<'_>, generation: usize, column: usize| {
        run.diagnostics.get(generation).and_then(|row| row.get(column)).copied().unwrap_or(f64::NAN)
    };
    let mut figures = Vec::new();
    let mut table = Table::new(&["run"]);
    for &(column, (chart, name, label)) in &columns {
        let title = format!("{}, {label}", chart.title);
        let curves = curves(groups, across, &|run, generation| number(run, generation, column));
        let picture = Chart { title: title.clone(), axis: chart.axis, across, curves }.draw();
        figures.push(Figure { kind: "strategy", picture, caption: format!("{title}, in every generation.") });
        table.head.push(name.into());
    }
    for group in groups {
        let last = |run: &Run<'_>, column: usize| number(run, run.last(), column);
        for run in &group.runs {
            let numbers = columns.iter().map(|(column, _)| short(last(run, *column)));
            table.rows.push([run.name()].into_iter().chain(numbers).collect());
        }
        if group.runs.len() > 1 {
            let column_values = |column: usize| group.runs.iter().map(|run| last(run, column)).collect::<Vec<_>>();
            let medians =
                columns.iter().map(|(column, _)| median(&column_values(*column)).map(short).unwrap_or_default());
            table.rows.push([format!("median, {}", group.label)].into_iter().chain(medians).collect());
        }
    }
    let text = "Values of the last generation of each run. The last row of a condition is the median of its runs.";
    vec![Block::Figures(figures), Block::Text(text.into()), Block::Table(table)]
}
