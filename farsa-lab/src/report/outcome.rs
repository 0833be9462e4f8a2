//! Results of groups of runs: medians, successes and comparisons.

use crate::figures::bootstrap::{RESAMPLES, median_interval};
use crate::figures::mann_whitney::{Comparison, compare};
use crate::figures::proportion::{Proportion, fisher};
use crate::figures::significant::percent;
use crate::figures::statistics::Quartiles;
use crate::report::moment::Moment;
use crate::report::page::{Block, Table};
use crate::report::run::{Group, Run, short, whose};

/// Criterion of a successful run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Success {
    /// Least share of successful trials in the champion's test.
    Share(f64),
    /// Fitness to be reached by the best of a generation.
    Fitness(f64),
}

/// A number of a run, if it has one.
type Number = Box<dyn Fn(&Run<'_>) -> Option<f64>>;

/// A quantity by which runs are compared.
struct Measure {
    name: String,
    of: Number,
    show: fn(f64) -> String,
}

impl Success {
    /// Returns true for a successful run, `None` for an untested one.
    fn of(self, run: &Run<'_>) -> Option<bool> {
        match self {
            Self::Share(least) => run.success().map(|share| share >= least),
            Self::Fitness(least) => {
                let populations = run.populations();
                let best = |at: usize| populations.iter().any(|(which, _)| run.fitness(*which, at, 0) >= least);
                Some((0..run.lines.len()).any(best))
            }
        }
    }

    fn words(self) -> String {
        match self {
            Self::Share(least) => {
                format!("A run is successful if at least {} of the trials of its champion's test are", percent(least))
            }
            Self::Fitness(least) => {
                format!("A run is successful if the best of a generation reaches a fitness of {}", short(least))
            }
        }
    }
}

/// Returns medians at the last common moment, successes and comparisons.
pub(crate) fn outcome(groups: &[Group<'_>], success: Success) -> Vec<Block> {
    let moment = Moment::common(groups);
    let measures = measures(groups, moment);
    let mut blocks = vec![
        Block::Text(format!(
            "Median and quartiles of the runs, {}. Success as tested below.{}",
            moment.words(),
            Group::best_so_far(groups)
        )),
        Block::Table(medians(groups, &measures)),
    ];
    if groups.iter().any(|group| group.runs.len() > 1) {
        blocks.push(Block::Text(format!(
            "95 % intervals of those medians (bootstrap, {RESAMPLES} resamples of the runs, percentiles)."
        )));
        blocks.push(Block::Table(intervals(groups, &measures)));
    }
    let counts = counts(groups, success);
    if counts.iter().any(|count| count.is_some_and(|count| count.of > 1)) {
        blocks.push(Block::Text(format!("{}. Intervals of 95 % by Wilson's score.", success.words())));
        blocks.push(Block::Table(successes(groups, &counts)));
    }
    blocks.extend(tests(groups, &measures, &counts));
    blocks
}

/// Lists the measures: best and mean of each population at a moment, and the success of champions.
fn measures(groups: &[Group<'_>], moment: Moment) -> Vec<Measure> {
    let mut measures: Vec<Measure> = Vec::new();
    for (population, name) in Group::populations(groups) {
        for (which, what) in [(0, "best"), (1, "mean")] {
            let of = move |run: &Run<'_>| Some(run.fitness(population, moment.generation(run)?, which));
            measures.push(Measure { name: whose(what, &name), of: Box::new(of), show: short });
        }
    }
    let of = Box::new(|run: &Run<'_>| run.success());
    measures.push(Measure { name: "success of the champions".into(), of, show: percent });
    measures
}

impl Measure {
    /// Lists the values of the runs of a group that have one.
    fn values(&self, group: &Group<'_>) -> Vec<f64> {
        group.runs.iter().filter_map(|run| (self.of)(run)).collect()
    }
}

fn medians(groups: &[Group<'_>], measures: &[Measure]) -> Table {
    let mut table = Table::new(&["condition", "runs"]);
    table.head.extend(measures.iter().map(|measure| measure.name.clone()));
    for group in groups {
        let mut row = vec![group.label.clone(), group.runs.len().to_string()];
        for measure in measures {
            let (values, show) = (measure.values(group), measure.show);
            let spread = Quartiles::from_values(&values).map_or_else(
                || "–".into(),
                |Quartiles { lower, median, upper }| format!("{} ({} to {})", show(median), show(lower), show(upper)),
            );
            let some = !values.is_empty() && values.len() < group.runs.len();
            row.push(if some { format!("{spread}, {} tested", values.len()) } else { spread });
        }
        table.rows.push(row);
    }
    table
}

fn intervals(groups: &[Group<'_>], measures: &[Measure]) -> Table {
    let mut table = Table::new(&["condition"]);
    table.head.extend(measures.iter().map(|measure| measure.name.clone()));
    for group in groups {
        let mut row = vec![group.label.clone()];
        row.extend(measures.iter().map(|measure| match median_interval(&measure.values(group)) {
            Some([low, high]) => format!("{} to {}", (measure.show)(low), (measure.show)(high)),
            None => "–".into(),
        }));
        table.rows.push(row);
    }
    table
}

/// Counts the successful runs among the tested runs of each group, `None` without tests.
fn counts(groups: &[Group<'_>], success: Success) -> Vec<Option<Proportion>> {
    let count = |group: &Group<'_>| {
        let results: Vec<bool> = group.runs.iter().filter_map(|run| success.of(run)).collect();
        let successes = results.iter().filter(|success| **success).count();
        (!results.is_empty()).then_some(Proportion { successes, of: results.len() })
    };
    groups.iter().map(count).collect()
}

fn successes(groups: &[Group<'_>], counts: &[Option<Proportion>]) -> Table {
    let mut table = Table::new(&["condition", "successful runs", "of", "share", "95 % interval"]);
    for (group, count) in groups.iter().zip(counts) {
        let cells = match count {
            None => ["–"; 4].map(str::to_owned),
            Some(count) => {
                let [low, high] = count.interval();
                let share = count.successes as f64 / count.of as f64;
                let interval = format!("{} to {}", percent(low), percent(high));
                [count.successes.to_string(), count.of.to_string(), percent(share), interval]
            }
        };
        table.rows.push(std::iter::once(group.label.clone()).chain(cells).collect());
    }
    table
}

/// Compares the groups in pairs.
fn tests(groups: &[Group<'_>], measures: &[Measure], counts: &[Option<Proportion>]) -> Vec<Block> {
    let mut ranks = Table::new(&["first", "second", "of", "U", "P(first larger)", "p"]);
    let mut tables = Table::new(&["first", "second", "successes of the first", "of the second", "p"]);
    let mut exact = true;
    for (index, first) in groups.iter().enumerate() {
        for (place, second) in groups.iter().enumerate().skip(index + 1) {
            let pair = [&first.label, &second.label].map(String::clone);
            for measure in measures {
                // Without the value of every run the comparison would be about other runs.
                let of = |group: &Group<'_>| group.runs.iter().map(|run| (measure.of)(run)).collect::<Option<Vec<_>>>();
                let comparison = of(first).zip(of(second)).and_then(|(first, second)| compare(&first, &second));
                if let Some(Comparison { u, larger, p, exact: counted }) = comparison {
                    exact &= counted;
                    let name = measure.name.split(" of the champions").next().unwrap_or_default().to_owned();
                    let numbers = [name, format!("{u:?}"), format!("{larger:.3}"), probability(p)];
                    ranks.rows.push(pair.iter().cloned().chain(numbers).collect());
                }
            }
            if let (Some(Some(a)), Some(Some(b))) = (counts.get(index), counts.get(place))
                && a.of > 1
                && b.of > 1
            {
                let share = |count: &Proportion| format!("{} of {}", count.successes, count.of);
                let cells = [share(a), share(b), probability(fisher(*a, *b))];
                tables.rows.push(pair.into_iter().chain(cells).collect());
            }
        }
    }
    // Many pairs are folded.
    let shown = |table: Table| match table.rows.len() {
        rows @ 41.. => Block::Fold(format!("All {rows} comparisons"), vec![Block::Table(table)]),
        _ => Block::Table(table),
    };
    let mut blocks = Vec::new();
    if !ranks.rows.is_empty() {
        let how = if exact { "exact" } else { "exact up to 200 runs, beyond that by the normal distribution" };
        blocks.push(Block::Text(format!(
            "Do they differ? Mann-Whitney U test, two-sided, {how}, not corrected for the number of comparisons. \
             P(first larger) is the probability that a run of the first is above one of the second, with ties as half."
        )));
        blocks.push(shown(ranks));
    }
    if !tables.rows.is_empty() {
        blocks.push(Block::Text(
            "Does one succeed more often? Fisher's exact test, two-sided, not corrected for the number of comparisons."
                .into(),
        ));
        blocks.push(shown(tables));
    }
    blocks
}

/// Formats a probability, with small ones in scientific notation.
pub(crate) fn probability(p: f64) -> String {
    if p >= 1e-4 { format!("{p:.4}") } else { format!("{p:.1e}") }
}
