//! Results of checks: published and computed figures with verdicts.

use std::fmt::Write as _;

use serde::Serialize;

use crate::experiment::settings::Value;
use crate::figures::significant::significant;
use crate::run::text_table::text_table;
use crate::sweep::checks_file::{Check, number};
use crate::sweep::measure::Estimate;

/// Comparison of an interval with the range that agrees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Verdict {
    /// The interval is inside the range.
    Agrees,
    /// The interval and the range have no value in common.
    Differs,
    /// The interval is partly inside the range, or there is no interval.
    Undecided,
    /// The check ended with an error.
    Failed,
}

impl Verdict {
    pub(crate) fn new(interval: Option<[f64; 2]>, [least, greatest]: [f64; 2]) -> Self {
        match interval {
            Some([low, high]) if least <= low && high <= greatest => Self::Agrees,
            Some([low, high]) if high < least || greatest < low => Self::Differs,
            _ => Self::Undecided,
        }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Differs => "differs",
            Self::Undecided => "undecided",
            Self::Failed => "failed",
        }
    }
}

/// Result of a check.
#[derive(Debug, Serialize)]
pub(crate) struct CheckResult {
    check: String,
    experiment: String,
    measure: String,
    /// Published figure: a number or a text.
    published: serde_json::Value,
    source: String,
    /// Range that agrees, null where it has no end.
    expected: [Option<f64>; 2],
    /// True if the range was declared for `--quick`.
    quick: bool,
    replications: usize,
    /// Number of runs with their tests.
    finished: usize,
    ours: Option<f64>,
    interval: Option<[Option<f64>; 2]>,
    verdict: Verdict,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    /// Cells of the table from the third to the last but one.
    #[serde(skip)]
    cells: [String; 5],
}

/// Results of all checks of a file.
#[derive(Debug, Default, Serialize)]
pub(crate) struct CheckResults {
    checks: Vec<CheckResult>,
}

/// Head of the table.
const HEAD: [&str; 8] =
    ["check", "measure", "published (source)", "expected", "runs", "ours", "95 % interval", "verdict"];

impl CheckResults {
    /// Adds the result of a check with its number of finished runs. Without all of them the check is undecided.
    pub(crate) fn add(&mut self, check: &Check, estimate: Result<(Option<Estimate>, usize), String>) {
        let ((estimate, finished), error) = match estimate {
            Ok(found) => (found, None),
            Err(error) => ((None, 0), Some(error)),
        };
        let replications = check.sweep.seeds.len();
        let interval = estimate.and_then(|estimate| estimate.interval);
        let verdict = match &error {
            Some(_) => Verdict::Failed,
            None => Verdict::new(interval.filter(|_| finished == replications), check.expected),
        };
        let published = match &check.published {
            Value::Word(word) => word.clone(),
            value => value.to_string(),
        };
        let json = match &check.published {
            Value::Word(word) => word.clone().into(),
            value => number(value).into(),
        };
        let [least, greatest] = check.expected.map(significant);
        let expected = match check.expected.map(f64::is_finite) {
            [true, true] => format!("{least} to {greatest}"),
            [true, false] => format!(">= {least}"),
            _ => format!("<= {greatest}"),
        };
        let cells = [
            format!("{published} ({})", check.source),
            expected + if check.is_quick { " (quick)" } else { "" },
            format!("{finished} of {replications}"),
            estimate.map_or_else(|| "–".into(), |estimate| significant(estimate.value)),
            interval.map_or_else(|| "–".into(), |[low, high]| format!("{} to {}", significant(low), significant(high))),
        ];
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        self.checks.push(CheckResult {
            check: check.name.clone(),
            experiment: check.sweep.base.experiment.as_ref().map_or_else(String::new, |name| name.value.clone()),
            measure: check.measure.text(),
            published: json,
            source: check.source.clone(),
            expected: check.expected.map(finite),
            quick: check.is_quick,
            replications,
            finished,
            ours: estimate.and_then(|estimate| finite(estimate.value)),
            interval: interval.map(|ends| ends.map(finite)),
            verdict,
            error,
            cells,
        });
    }

    /// Returns the rows of the table, the head first.
    fn rows(&self) -> Vec<Vec<String>> {
        let mut rows = vec![HEAD.map(str::to_owned).to_vec()];
        rows.extend(self.checks.iter().map(|check| {
            let mut row = vec![check.check.clone(), check.measure.clone()];
            row.extend(check.cells.iter().cloned());
            row.push(check.verdict.text().into());
            row
        }));
        rows
    }

    /// Formats a table with a line for each check, and the errors below.
    pub(crate) fn text(&self) -> String {
        let errors =
            self.checks.iter().filter_map(|check| Some(format!("{}: {}\n", check.check, check.error.as_ref()?)));
        text_table(&self.rows(), 0..0) + &errors.collect::<String>()
    }

    /// Formats the table as Markdown.
    pub(crate) fn markdown(&self) -> String {
        let mut text = String::new();
        for (number, row) in self.rows().iter().enumerate() {
            let cells: Vec<String> = row.iter().map(|cell| cell.replace('|', "\\|")).collect();
            // Writing into a string cannot fail.
            let _ = writeln!(text, "| {} |", cells.join(" | "));
            if number == 0 {
                let _ = writeln!(text, "|{}", "---|".repeat(row.len()));
            }
        }
        text
    }

    /// Describes the checks that differ or failed, `None` without any.
    pub(crate) fn faults(&self) -> Option<String> {
        let named = |verdict: Verdict| {
            let names = self.checks.iter().filter(|check| check.verdict == verdict).map(|check| check.check.as_str());
            let names: Vec<&str> = names.collect();
            (!names.is_empty()).then(|| format!("{} {}: {}", names.len(), verdict.text(), names.join(", ")))
        };
        let faults: Vec<String> = [Verdict::Differs, Verdict::Failed].into_iter().filter_map(named).collect();
        (!faults.is_empty()).then(|| format!("of {} checks {}", self.checks.len(), faults.join("; ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::Study;
    use proptest::prelude::*;

    const FILE: &str = "[[checks]]\nname = \"NAME\"\nexperiment = \"toy\"\nreplications = 2\ntest.trials = 20\nmeasure = \"trials\"\n\
                        published = \"ab|c\"\nsource = \"Garcia1998\"\nexpected = [0.4, inf]\n";

    fn checks() -> Vec<Check> {
        let text: String = ["a", "b", "c", "d"].map(|name| FILE.replace("NAME", name)).concat();
        match Study::parse("my.toml", &text, false) {
            Ok(Study::Checks(checks)) => checks,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn rows_have_verdicts_and_faults_have_names() {
        let checks = checks();
        let mut results = CheckResults::default();
        let estimate = |value, low, high| Some(Estimate { value, interval: Some([low, high]) });
        results.add(&checks[0], Ok((estimate(0.6, 0.5, 0.7), 2)));
        assert_eq!(results.faults(), None);
        results.add(&checks[1], Ok((estimate(0.2, 0.1, 0.3), 2)));
        results.add(&checks[2], Ok((estimate(0.2, 0.1, 0.3), 1)));
        results.add(&checks[3], Err("no space".into()));
        assert_eq!(results.faults().unwrap(), "of 4 checks 1 differs: b; 1 failed: d");
        let text = results.text();
        let lines: Vec<Vec<&str>> =
            text.lines().map(|line| line.split("  ").filter(|cell| !cell.is_empty()).collect()).collect();
        assert_eq!(lines[0].iter().map(|cell| cell.trim()).collect::<Vec<_>>(), HEAD);
        let verdicts: Vec<&str> = lines[1..5].iter().map(|row| row[row.len() - 1].trim()).collect();
        assert_eq!(verdicts, ["agrees", "differs", "undecided", "failed"]);
        assert_eq!(lines[5], ["d: no space"]);
        let md = results.markdown();
        assert!(md.contains("\n|---|---|---|---|---|---|---|---|\n"), "{md}");
        let row =
            "| a | successful trials | ab\\|c (Garcia1998) | >= 0.4000 | 2 of 2 | 0.6000 | 0.5000 to 0.7000 | agrees |";
        assert!(md.contains(row), "{md}");
        let json = serde_json::to_value(&results).unwrap();
        let first = &json["checks"][0];
        assert_eq!(first["expected"], serde_json::json!([0.4, null]));
        assert_eq!((&first["verdict"], &first["published"]), (&"agrees".into(), &"ab|c".into()));
        assert_eq!((&json["checks"][3]["error"], &json["checks"][3]["ours"]), (&"no space".into(), &().into()));
    }

    #[test]
    fn nothing_is_decided_without_an_interval() {
        assert_eq!(Verdict::new(None, [f64::NEG_INFINITY, f64::INFINITY]), Verdict::Undecided);
        assert_eq!(Verdict::new(Some([f64::NAN; 2]), [0.0, 1.0]), Verdict::Undecided);
        assert_eq!(Verdict::new(Some([1.0, f64::INFINITY]), [1.0, f64::INFINITY]), Verdict::Agrees);
    }

    proptest! {
        /// The oracle looks at every point of a grid.
        #[test]
        fn verdicts_are_those_of_points(ends in prop::array::uniform4(0_u8..8)) {
            let [low, high, least, greatest] = ends.map(f64::from);
            let ([low, high], [least, greatest]) = ([low.min(high), low.max(high)], [least.min(greatest), least.max(greatest)]);
            let points = (0_u8..8).map(f64::from).filter(|x| (low..=high).contains(x));
            let inside: Vec<bool> = points.map(|x| (least..=greatest).contains(&x)).collect();
            let expected = match (inside.contains(&true), inside.contains(&false)) {
                (true, false) => Verdict::Agrees,
                (false, _) => Verdict::Differs,
                (true, true) => Verdict::Undecided,
            };
            prop_assert_eq!(Verdict::new(Some([low, high]), [least, greatest]), expected);
        }
    }
}
