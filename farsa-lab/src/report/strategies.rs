//! What strategies say of their generations beside the fitness, and what they keep.

use std::path::Path;

use crate::error::Error;
use crate::figures::plot::Chart;
use crate::figures::statistics::median;
use crate::report::curves::curves;
use crate::report::moment::Moment;
use crate::report::page::{Block, Figure, Table};
use crate::report::run::{Group, Run, short};

/// For each strategy that says something or keeps something its curves, its last numbers, and what each run has kept.
pub(crate) fn strategies(groups: &[Group<'_>]) -> Result<Vec<Block>, Error> {
    let mut names: Vec<&str> = Vec::new();
    for run in groups.iter().flat_map(|group| &group.runs) {
        let name = run.plan.definition().name();
        if (run.plan.definition().diagnostics().is_some() || run.kept.is_some()) && !names.contains(&name) {
            names.push(name);
        }
    }
    let mut blocks = Vec::new();
    for name in names {
        let of_it = |group: &&Group<'_>| group.runs.iter().any(|run| run.plan.definition().name() == name);
        let own: Vec<Group<'_>> = groups.iter().filter(of_it).cloned().collect();
        blocks.push(Block::Subheading(format!("What {name} says")));
        blocks.extend(said(&own)?);
        let kept = own.iter().flat_map(|group| &group.runs).filter_map(|run| {
            let caption = format!("{}: what it has kept, by the last generation.", run.name());
            Some(Figure { kind: "archive", picture: run.kept.clone()?, caption })
        });
        let kept: Vec<Figure> = kept.collect();
        if !kept.is_empty() {
            blocks.push(Block::Figures(kept));
        }
    }
    Ok(blocks)
}

/// Curves and last numbers of runs of one strategy.
fn said(groups: &[Group<'_>]) -> Result<Vec<Block>, Error> {
    let refused = |why: String| Error::damaged(Path::new("the figure of a strategy"), why);
    let diagnostics = groups.iter().flat_map(|group| &group.runs).find_map(|run| run.plan.definition().diagnostics());
    let charts = diagnostics.map_or(&[][..], |diagnostics| diagnostics.charts);
    let columns = charts.iter().flat_map(|chart| chart.curves.iter().map(move |(name, label)| (chart, *name, *label)));
    let columns: Vec<_> = columns.enumerate().collect();
    if columns.is_empty() {
        return Ok(Vec::new());
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
        let picture = Chart { title: title.clone(), axis: chart.axis, across, curves }.draw().map_err(refused)?;
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
            let of_all = |column: usize| group.runs.iter().map(|run| last(run, column)).collect::<Vec<_>>();
            let medians = columns.iter().map(|(column, _)| median(&of_all(*column)).map(short).unwrap_or_default());
            table.rows.push([format!("median, {}", group.label)].into_iter().chain(medians).collect());
        }
    }
    let text = "Of the last generation of each run; the last row of a condition is the median of its runs.";
    Ok(vec![Block::Figures(figures), Block::Text(text.into()), Block::Table(table)])
}
