//! Number of runs that generalize to held-out cases.

use crate::figures::proportion::{Proportion, fisher};
use crate::figures::significant::percent;
use crate::report::outcome::probability;
use crate::report::page::{Block, Table};

/// Least share of successful trials of a held-out case for a run to generalize to it.
const GENERALISES: f64 = 0.75;

/// Results of a group's runs in held-out cases.
pub(crate) struct HeldOut<'r> {
    pub(crate) label: &'r str,
    /// Names of the cases.
    pub(crate) cases: Vec<String>,
    /// Shares of success of each run \[runs\] \[cases\].
    pub(crate) runs: Vec<Vec<f64>>,
}

impl HeldOut<'_> {
    /// Counts the runs that generalize to at least the given number of cases.
    fn count(&self, least: usize) -> Proportion {
        let enough = |rates: &&Vec<f64>| rates.iter().filter(|rate| **rate >= GENERALISES).count() >= least;
        // A run with a case of broken trials alone cannot be counted.
        let runs = self.runs.iter().filter(|rates| !rates.iter().any(|rate| rate.is_nan()));
        Proportion { successes: runs.clone().filter(enough).count(), of: runs.count() }
    }

    /// Counts the runs that generalize to a case.
    fn to(&self, case: usize) -> Proportion {
        let rates = self.runs.iter().filter_map(|rates| rates.get(case)).filter(|rate| !rate.is_nan());
        Proportion { successes: rates.clone().filter(|rate| **rate >= GENERALISES).count(), of: rates.count() }
    }
}

/// Returns the number of generalizing runs of each group and comparisons, nothing about a single run.
pub(crate) fn generalisation(groups: &[HeldOut<'_>]) -> Vec<Block> {
    let Some(first) = groups.first().filter(|_| groups.iter().map(|group| group.runs.len()).sum::<usize>() > 1) else {
        return Vec::new();
    };
    let words = |Proportion { successes, of }: Proportion| format!("{successes} of {of}");
    let mut table = Table::new(&["condition"]);
    table.head.extend(first.cases.iter().cloned());
    table.head.extend(["at least one", "all"].map(String::from));
    for group in groups {
        let mut row = vec![group.label.to_owned()];
        row.extend((0..first.cases.len()).map(|case| words(group.to(case))));
        row.extend([1, group.cases.len()].map(|least| words(group.count(least))));
        table.rows.push(row);
    }
    let least = percent(GENERALISES);
    let mut blocks = vec![
        Block::Text(format!("Runs that generalize: at least {least} of the trials of a held-out case succeed.")),
        Block::Table(table),
    ];
    let mut tests = Table::new(&["first", "second", "of the first", "of the second", "p"]);
    for (index, first) in groups.iter().enumerate() {
        for second in groups.iter().skip(index + 1) {
            let (a, b) = (first.count(1), second.count(1));
            if a.of > 1 && b.of > 1 {
                let labels = [first.label, second.label].map(str::to_owned);
                let cells = [words(a), words(b), probability(fisher(a, b))];
                tests.rows.push(labels.into_iter().chain(cells).collect());
            }
        }
    }
    if !tests.rows.is_empty() {
        let how = "Do the groups differ in runs that generalize to at least one case? Fisher's exact test, two-sided.";
        blocks.push(Block::Text(how.into()));
        blocks.push(Block::Table(tests));
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(label: &str, runs: &[[f64; 2]]) -> HeldOut<'static> {
        let cases = ["TOUCH green", "MOVE red"].map(String::from).to_vec();
        HeldOut { label: label.to_owned().leak(), cases, runs: runs.iter().map(|rates| rates.to_vec()).collect() }
    }

    fn tables(blocks: &[Block]) -> Vec<&Table> {
        blocks.iter().filter_map(|block| if let Block::Table(table) = block { Some(table) } else { None }).collect()
    }

    #[test]
    fn runs_are_counted_at_three_quarters() {
        let one = group("one", &[[0.75, 0.9], [0.74, 1.0], [0.0, 0.1]]);
        let other = group("other", &[[0.0, 0.0]; 3]);
        let blocks = generalisation(&[one, other]);
        let found = tables(&blocks);
        assert_eq!(found[0].head, ["condition", "TOUCH green", "MOVE red", "at least one", "all"]);
        assert_eq!(found[0].rows[0], ["one", "1 of 3", "2 of 3", "2 of 3", "1 of 3"]);
        assert_eq!(found[0].rows[1], ["other", "0 of 3", "0 of 3", "0 of 3", "0 of 3"]);
        let broken = group("broken", &[[f64::NAN, 0.9], [0.8, 0.9], [0.0, 0.9]]);
        let blocks = generalisation(&[broken]);
        assert_eq!(tables(&blocks)[0].rows[0], ["broken", "1 of 2", "3 of 3", "2 of 2", "1 of 2"]);
        // Two of six can be chosen in 15 ways, three of them within each group.
        assert_eq!(found[1].rows, [["one", "other", "2 of 3", "0 of 3", "0.4000"]]);
    }

    #[test]
    fn one_run_says_nothing_of_how_many() {
        assert!(generalisation(&[group("one", &[[1.0, 1.0]])]).is_empty());
        assert_eq!(tables(&generalisation(&[group("one", &[[1.0, 1.0]; 2])])).len(), 1);
    }
}
