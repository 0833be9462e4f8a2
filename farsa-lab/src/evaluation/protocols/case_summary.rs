//! Summaries of the trials of each case.

use std::fmt::Write as _;

use serde::Serialize;

use crate::evaluation::findings::{Finding, Findings, Share, as_map};
use crate::evaluation::protocols::table::ProtocolTable;
use crate::evaluation::test_table::own_columns;
use crate::evaluation::trials::NO_VALUE;
use crate::experiment::protocol::{Case, Protocol};
use crate::figures::significant::significant;
use crate::run::text_table::text_table;

/// Summary of a case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct CaseSummary {
    pub(crate) row: String,
    pub(crate) column: String,
    pub(crate) held_out: bool,
    /// Means of the terms of the fitness, where there are several.
    #[serde(serialize_with = "as_map")]
    pub(crate) terms: Vec<(String, Finding)>,
    #[serde(flatten)]
    pub(crate) findings: Findings,
}

impl CaseSummary {
    /// Summarizes each case of a table. `terms` holds the names of the fitness terms.
    pub(crate) fn all(table: &ProtocolTable, terms: &[String]) -> Vec<Self> {
        table.cases.iter().map(|(case, table)| Self::new(case, table.findings(&[]), own_columns(terms))).collect()
    }

    fn new(case: &Case, mut findings: Findings, terms: &[String]) -> Self {
        let (terms, notes) = std::mem::take(&mut findings.notes).into_iter().partition(|note| terms.contains(&note.0));
        findings.notes = notes;
        let Case { row, column, held_out } = case.clone();
        Self { row, column, held_out, terms, findings }
    }

    /// Gets the case.
    pub(crate) fn case(&self) -> Case {
        Case { row: self.row.clone(), column: self.column.clone(), held_out: self.held_out }
    }

    /// Iterates over the means of terms and notes, by name.
    fn means(&self) -> impl Iterator<Item = (&str, &Finding)> {
        self.terms.iter().chain(&self.findings.notes).map(|(name, finding)| (name.as_str(), finding))
    }
}

/// The cases as a table of text, the head first, and how many of its columns are words.
pub(crate) fn rows(protocol: &Protocol, found: &[CaseSummary]) -> (Vec<Vec<String>>, usize) {
    let [row, column] = &protocol.axes;
    let named = |name: &String, else_: &str| if name.is_empty() { else_.to_owned() } else { name.clone() };
    let (columns, held_out) =
        (found.iter().any(|case| !case.column.is_empty()), found.iter().any(|case| case.held_out));
    let mut head = vec![named(row, if columns { "row" } else { "case" })];
    head.extend(columns.then(|| named(column, "column")));
    head.extend(held_out.then(|| "kind".to_owned()));
    let words = head.len();
    let broken_down = found.iter().any(|case| case.findings.broken_down > 0);
    head.push("trials".into());
    head.extend(broken_down.then(|| "broken down".to_owned()));
    let has_success = found.iter().any(|case| case.findings.successes.is_some());
    head.extend(["success", "rate", "95 % interval"].iter().filter(|_| has_success).map(|&name| name.to_owned()));
    head.push("fitness".into());
    let names = means(found);
    head.extend(names.iter().map(|&name| name.to_owned()));
    let line = |case: &CaseSummary| {
        let mut line = vec![case.row.clone()];
        line.extend(columns.then(|| case.column.clone()));
        line.extend(held_out.then(|| if case.held_out { "held out" } else { "trained" }.to_owned()));
        let Findings { trials, successes, rate, interval, fitness, .. } = &case.findings;
        line.push(trials.to_string());
        line.extend(broken_down.then(|| case.findings.broken_down.to_string()));
        match successes {
            _ if !has_success => {}
            Some(successes) if !rate.is_nan() => {
                let [low, high] = interval.map(|share| format!("{:.1}", 100.0 * share));
                line.extend([successes.to_string(), format!("{:.1} %", 100.0 * rate), format!("{low} to {high} %")]);
            }
            _ => line.extend(["–"; 3].map(str::to_owned)),
        }
        line.push(if fitness.is_finite() { significant(*fitness) } else { "–".into() });
        line.extend(names.iter().map(|&name| match case.means().find(|mean| mean.0 == name) {
            Some((_, Finding::Mean(mean))) if mean.is_finite() => significant(*mean),
            _ => "–".into(),
        }));
        line
    };
    (std::iter::once(head.clone()).chain(found.iter().map(line)).collect(), words)
}

/// Gets the terms and notes that are numbers in every case.
fn means(found: &[CaseSummary]) -> Vec<&str> {
    let is_mean = |case: &CaseSummary, name: &str| {
        case.means().any(|(own, finding)| own == name && matches!(finding, Finding::Mean(_)))
    };
    let first = found.first().into_iter().flat_map(CaseSummary::means);
    first.map(|(name, _)| name).filter(|name| found.iter().all(|case| is_mean(case, name))).collect()
}

/// Formats the same for a terminal, with what trained and held-out cases came to together.
pub(crate) fn text(protocol: &Protocol, found: &[CaseSummary]) -> String {
    let (rows, words) = rows(protocol, found);
    let mut text = text_table(&rows, words..usize::MAX);
    let has_success = found.iter().any(|case| case.findings.successes.is_some());
    if has_success && found.iter().any(|case| case.held_out) {
        text.push('\n');
        for (held_out, kind) in [(false, "trained"), (true, "held out")] {
            let cases = found.iter().filter(|case| case.held_out == held_out);
            let total = cases.fold(Share::default(), |total, case| {
                let Findings { trials, successes, broken_down, .. } = &case.findings;
                Share {
                    successes: total.successes + successes.unwrap_or_default(),
                    of: total.of + trials,
                    broken_down: total.broken_down + broken_down,
                }
            });
            let Share { successes, of, broken_down } = total;
            let rate = 100.0 * total.rate();
            // Writing into a string cannot fail.
            let _ = match broken_down {
                _ if of == 0 => Ok(()),
                _ if rate.is_nan() => writeln!(text, "{kind}: {NO_VALUE}, all {of} trials broke down"),
                0 => writeln!(text, "{kind}: {successes} of {of} ({rate:.1} %)"),
                _ => writeln!(text, "{kind}: {successes} of {of} ({rate:.1} %), {broken_down} broke down"),
            };
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::proportion::Proportion;
    use serde_json::Value;
    use std::path::Path;

    fn found(body: &str) -> Vec<CaseSummary> {
        let head = "case,row,column,held_out,index,trial,steps,success,fitness,find,act,way,phase\n";
        let table = ProtocolTable::from_text(Path::new("x"), &format!("{head}{body}")).unwrap();
        CaseSummary::all(&table, &["find".into(), "act".into()])
    }

    const BODY: &str = "0,TOUCH,red,false,0,0,6,true,1.5,1.0,0.5,3.0,far\n0,TOUCH,red,false,1,1,6,true,0.5,0.5,0.0,1.0,near\n\
        1,MOVE,red,true,0,0,6,false,NaN,NaN,NaN,,\n1,MOVE,red,true,1,1,6,true,2.0,1.0,1.0,0.5,far\n";

    #[test]
    fn cases_have_rates_intervals_and_means() {
        let found = found(BODY);
        assert_eq!([0, 1].map(|case| found[case].findings.rate), [1.0, 0.5]);
        assert_eq!(found[1].findings.interval, Proportion { successes: 1, of: 2 }.interval());
        assert_eq!(found[0].terms, [("find".into(), Finding::Mean(0.75)), ("act".into(), Finding::Mean(0.25))]);
        assert_eq!((found[1].findings.fitness, found[1].findings.broken_down), (2.0, 1));
        let protocol = Protocol::new("x", "").with_axes("action", "object");
        assert_eq!(
            text(&protocol, &found),
            "action  object  kind      trials  broken down  success     rate    95 % interval  fitness    find     act     way\n\
             TOUCH   red     trained        2            0        2  100.0 %  34.2 to 100.0 %    1.000  0.7500  0.2500   2.000\n\
             MOVE    red     held out       2            1        1   50.0 %    9.5 to 90.5 %    2.000   1.000   1.000  0.5000\n\
             \n\
             trained: 2 of 2 (100.0 %)\nheld out: 1 of 2 (50.0 %), 1 broke down\n"
        );
        let json = serde_json::to_value(&found[0]).unwrap();
        assert_eq!((&json["row"], &json["successes"]), (&"TOUCH".into(), &2.into()));
        assert_eq!(
            (&json["terms"]["find"]["mean"], &json["notes"]["phase"]["counts"]["far"]),
            (&0.75.into(), &1.into())
        );
    }

    #[test]
    fn a_list_has_no_columns_and_what_broke_down_no_means() {
        let found = found("0,intact,,false,0,0,6,true,1.5,1.0,0.5,3.0,far\n1,cut,,false,0,0,0,false,NaN,NaN,NaN,,\n");
        assert!(found[1].findings.fitness.is_nan());
        assert_eq!(
            text(&Protocol::new("x", ""), &found),
            "case    trials  broken down  success     rate    95 % interval  fitness   find     act    way\n\
             intact       1            0        1  100.0 %  20.7 to 100.0 %    1.500  1.000  0.5000  3.000\n\
             cut          1            1        –        –                –        –      –       –      –\n"
        );
        let json = serde_json::to_value(&found[1]).unwrap();
        assert_eq!((&json["fitness"], &json["rate"], &json["broken_down"]), (&Value::Null, &Value::Null, &1.into()));
        let held_out = self::found("0,cut,,true,0,0,0,false,NaN,NaN,NaN,,\n0,cut,,true,1,1,0,false,NaN,NaN,NaN,,\n");
        let text = self::text(&Protocol::new("x", ""), &held_out);
        assert!(text.ends_with("\nheld out: no value, all 2 trials broke down\n"), "{text}");
        // A task without a criterion of success has no columns about it.
        let without = self::found("0,cut,,true,0,0,6,,2.0,1.0,1.0,,far\n0,cut,,true,1,1,6,,4.0,1.0,1.0,,far\n");
        let text = self::text(&Protocol::new("x", ""), &without);
        assert_eq!(
            text,
            "case  kind      trials  fitness   find    act  way\ncut   held out       2    3.000  1.000  1.000    –\n"
        );
    }
}
