//! Success of the champions by kind of trial, such as start positions.

use crate::figures::mann_whitney::compare;
use crate::figures::significant::percent;
use crate::figures::statistics::Quartiles;
use crate::report::outcome::probability;
use crate::report::page::{Block, Table};
use crate::report::run::{Group, Run};

/// Most kinds of trials that a table shows.
const MAX_KINDS: usize = 8;

/// Returns tables of the success in each kind of trial, nothing for a single run and for a single kind.
pub(crate) fn starts(groups: &[Group<'_>]) -> Vec<Block> {
    let tested: Vec<Tested<'_>> = groups.iter().map(Tested::new).collect();
    let rates = || tested.iter().flat_map(|group| &group.rates);
    let kinds = rates().map(Vec::len).max().unwrap_or(0);
    if !(2..=MAX_KINDS).contains(&kinds) || rates().count() < 2 || rates().any(|rates| rates.len() != kinds) {
        return Vec::new();
    }
    let mut table = Table::new(&["condition", "tested runs"]);
    table.head.extend((0..kinds).map(|kind| format!("trial {kind}")));
    for group in &tested {
        let mut row = vec![group.label.to_owned(), group.rates.len().to_string()];
        row.extend((0..kinds).map(|kind| spread(&group.of(kind))));
        table.rows.push(row);
    }
    let mut blocks = vec![
        Block::Text(
            "Success by kind of trial, such as a start position: median and quartiles of the champions' shares.".into(),
        ),
        Block::Table(table),
    ];
    let mut tests = Table::new(&["first", "second", "of", "U", "P(first larger)", "p"]);
    for (index, first) in tested.iter().enumerate() {
        for second in tested.iter().skip(index + 1).filter(|second| first.is_complete && second.is_complete) {
            for kind in 0..kinds {
                let Some(comparison) = compare(&first.of(kind), &second.of(kind)) else { continue };
                let labels = [first.label, second.label].map(str::to_owned);
                let (u, larger) = (format!("{:?}", comparison.u), format!("{:.3}", comparison.larger));
                let numbers = [format!("trial {kind}"), u, larger, probability(comparison.p)];
                tests.rows.push(labels.into_iter().chain(numbers).collect());
            }
        }
    }
    if !tests.rows.is_empty() {
        let how = "Do the conditions differ in a kind of trial? Mann-Whitney U test, two-sided, as above.";
        blocks.push(Block::Text(how.into()));
        blocks.push(Block::Table(tests));
    }
    blocks
}

/// Shares of success of a group's champions.
struct Tested<'g> {
    label: &'g str,
    /// A share for each kind of trial \[tested runs\] \[kinds\].
    rates: Vec<Vec<f64>>,
    /// True if every run has a share for each kind of trial.
    is_complete: bool,
}

impl<'g> Tested<'g> {
    fn new(group: &'g Group<'_>) -> Self {
        let rates = |run: &&Run<'_>| -> Option<Vec<f64>> {
            let by_trial = &run.test.as_ref()?.findings.by_trial;
            Some(by_trial.values().map(|share| share.rate()).collect())
        };
        let rates: Vec<Vec<f64>> = group.runs.iter().filter_map(rates).filter(|rates| !rates.is_empty()).collect();
        let finite = rates.iter().flatten().all(|rate| rate.is_finite());
        Self { label: &group.label, is_complete: finite && rates.len() == group.runs.len(), rates }
    }

    /// Lists the shares of a kind of trial.
    fn of(&self, kind: usize) -> Vec<f64> {
        let rates = self.rates.iter().filter_map(|rates| rates.get(kind).copied());
        rates.filter(|rate| rate.is_finite()).collect()
    }
}

fn spread(rates: &[f64]) -> String {
    Quartiles::from_values(rates).map_or_else(
        || "–".into(),
        |Quartiles { lower, median, upper }| format!("{} ({} to {})", percent(median), percent(lower), percent(upper)),
    )
}
