//! `test.csv`: one line per trial of a test, and its summary.

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::Error;
use crate::evaluation::findings::{Finding, Findings, Share, mean, numbers};
use crate::experiment::evaluator::TaskInfo;
use crate::experiment::outcome::{Note, Outcome};
use crate::figures::bootstrap::mean_interval;
use crate::figures::proportion::Proportion;
use crate::figures::significant::significant;

/// Columns of every test. Several fitness terms and the notes follow.
const HEAD: [&str; 5] = ["index", "trial", "steps", "success", "fitness"];
/// Beginnings of the columns of each other population.
const FITNESS_OF: &str = "fitness of population ";
const SUCCESS_OF: &str = "success of population ";

/// Columns of a table besides those of every test.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Columns<'c> {
    /// Names of the terms.
    pub(crate) terms: &'c [String],
    /// Names of all populations but the first.
    pub(crate) others: &'c [String],
    /// False for a task without a criterion of success.
    pub(crate) has_success: bool,
}

impl<'c> Columns<'c> {
    /// Returns the columns of a task in which this number of populations is tested.
    pub(crate) fn new(info: &'c TaskInfo, populations: usize) -> Self {
        let others = info.populations.get(1..populations).unwrap_or(&[]);
        Self { terms: &info.terms, others, has_success: info.has_success }
    }
}

/// One trial.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TrialResult {
    /// Which of the experiment's trials it was.
    pub(crate) trial: u32,
    /// Outcome of the trial.
    pub(crate) outcome: Outcome,
    /// Fitness of the trial. NaN if it failed.
    pub(crate) fitness: f64,
    /// Reason why the trial, or that of an opponent, broke down.
    pub(crate) failure: Option<String>,
    /// Fitness and success of the opponents in the same trial, which is an episode of theirs in their populations.
    pub(crate) others: Vec<(f64, bool)>,
}

/// A trial of the test of a champion.
#[derive(Debug, Clone, PartialEq)]
pub struct TestTrial {
    /// Number of the trial in the experiment.
    pub trial: u32,
    /// Number of steps.
    pub steps: u32,
    /// Success of the trial.
    pub success: bool,
    /// Fitness of the trial, NaN after a failure.
    pub fitness: f64,
}

/// Trials of a test as lines of text of equal length, the head first.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Table {
    lines: Vec<Vec<String>>,
}

impl Table {
    /// Builds the table of some trials.
    pub(crate) fn new(columns: &Columns<'_>, trials: &[TrialResult]) -> Self {
        let Columns { others, has_success, .. } = *columns;
        let mut head: Vec<String> = HEAD.map(str::to_owned).into();
        let terms = own_columns(columns.terms);
        head.extend(terms.iter().cloned());
        // A trial that broke down has no notes: the names are those of the first that has.
        let names: Vec<&str> = trials
            .iter()
            .map(|results| &results.outcome.notes)
            .find(|notes| !notes.is_empty())
            .map_or_else(Vec::new, |notes| notes.iter().map(|(name, _)| *name).collect());
        head.extend(names.iter().map(|&name| name.to_owned()));
        // Ones and zeros, so that the mean of a success is its share.
        let of_others: &[&str] = if has_success { &[FITNESS_OF, SUCCESS_OF] } else { &[FITNESS_OF] };
        head.extend(others.iter().flat_map(|name| of_others.iter().map(move |what| format!("{what}{name}"))));
        let lines = trials.iter().enumerate().map(|(index, TrialResult { trial, outcome, fitness, others, .. })| {
            let success = outcome.success && fitness.is_finite();
            let mut line = vec![
                index.to_string(),
                trial.to_string(),
                outcome.steps.to_string(),
                if has_success { success.to_string() } else { String::new() },
                number(*fitness),
            ];
            line.extend((0..terms.len()).map(|term| number(outcome.terms.get(term).copied().unwrap_or(f64::NAN))));
            line.extend(names.iter().map(|&name| match outcome.notes.iter().find(|note| note.0 == name) {
                Some((_, Note::Number(x))) => number(*x),
                Some((_, Note::Text(text))) => text.clone(),
                None => String::new(),
            }));
            let of_other = |(fitness, success): &(f64, bool)| {
                let columns = [number(*fitness), u8::from(*success).to_string()];
                columns.into_iter().take(of_others.len())
            };
            line.extend(others.iter().flat_map(of_other));
            line
        });
        Self { lines: std::iter::once(head).chain(lines).collect() }
    }

    /// Parses the text of the file at `path`.
    ///
    /// # Errors
    /// [`Error::File`] when it is not the table of a test.
    pub(crate) fn from_text(path: &Path, text: &str) -> Result<Self, Error> {
        Self::parse(text).map_err(|why| Error::damaged(path, why))
    }

    fn parse(text: &str) -> Result<Self, String> {
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
        let mut lines: Vec<Vec<String>> = Vec::new();
        for record in reader.records() {
            // The reader reports lines of unequal length with their number.
            lines.push(record.map_err(|error| error.to_string())?.iter().map(str::to_owned).collect());
        }
        let table = Self::from_lines(lines, 2)?;
        if text.ends_with('\n') && table.lines.len() > 1 { Ok(table) } else { Err("truncated".into()) }
    }

    /// Builds the table of these lines, the head first. `line` is the number of the first trial's line in the file.
    ///
    /// # Errors
    /// Returns the fault as text.
    pub(crate) fn from_lines(lines: Vec<Vec<String>>, first: usize) -> Result<Self, String> {
        let head = lines.first().map(|line| line.iter().map(String::as_str).collect::<Vec<_>>()).unwrap_or_default();
        if !head.starts_with(&HEAD) {
            return Err("is not the table of a test".into());
        }
        for (index, line) in lines.iter().skip(1).enumerate() {
            let [number, trial, steps, success, fitness] = [0, 1, 2, 3, 4].map(|column| line[column].as_str());
            let good = number.parse() == Ok(index)
                && trial.parse::<u32>().is_ok()
                && steps.parse::<u32>().is_ok()
                && (success.is_empty() || success.parse::<bool>().is_ok())
                && fitness.parse::<f64>().is_ok();
            if !good {
                return Err(format!("line {} is not a trial of a test", index + first));
            }
        }
        Ok(Self { lines })
    }

    /// Divides it into tables of the given number of trials, each counted from 0.
    pub(super) fn divided(&self, trials: usize) -> Vec<Self> {
        let Some((head, lines)) = self.lines.split_first() else { return Vec::new() };
        let part = |lines: &[Vec<String>]| {
            let mut lines = lines.to_vec();
            for (index, field) in lines.iter_mut().filter_map(|line| line.first_mut()).enumerate() {
                *field = index.to_string();
            }
            Self { lines: std::iter::once(head.clone()).chain(lines).collect() }
        };
        lines.chunks(trials.max(1)).map(part).collect()
    }

    /// Gets the trials, without terms and notes.
    pub(crate) fn trials(&self) -> Vec<TestTrial> {
        let trial = |line: &Vec<String>| {
            let [_, trial, steps, success, fitness] = [0, 1, 2, 3, 4].map(|column| line[column].as_str());
            let (trial, steps) = (trial.parse().ok()?, steps.parse().ok()?);
            Some(TestTrial { trial, steps, success: success == "true", fitness: fitness.parse().ok()? })
        };
        self.lines.iter().skip(1).filter_map(trial).collect()
    }

    /// Iterates over the names of the columns.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.lines.iter().take(1).flatten().map(String::as_str)
    }

    /// Parses the finite numbers of a column, or returns `None` for an unknown one.
    pub(crate) fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let column = self.names().position(|other| other == name)?;
        let fields: Vec<String> = self.lines.iter().skip(1).filter_map(|line| line.get(column).cloned()).collect();
        Some(numbers(&fields))
    }

    /// Gets the lines, the head first.
    pub(super) fn lines(&self) -> &[Vec<String>] {
        &self.lines
    }

    /// Writes the content of the file for `path`.
    pub(crate) fn csv(&self, path: &Path) -> Result<Vec<u8>, Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        self.lines
            .iter()
            .try_for_each(|line| writer.write_record(line))
            .map_err(|error| Error::damaged(path, error))?;
        writer.into_inner().map_err(|error| Error::damaged(path, error.to_string()))
    }

    /// Formats the table with aligned columns. Numbers have four significant digits.
    pub(crate) fn aligned(&self) -> String {
        let short = |field: &String| match field.parse::<f64>() {
            Ok(x) if field.contains('.') => significant(x),
            _ => field.clone(),
        };
        let table: Vec<Vec<String>> = self.lines.iter().map(|line| line.iter().map(short).collect()).collect();
        let columns = table.first().map_or(0, Vec::len);
        let width = |column: usize| table.iter().filter_map(|line| Some(line.get(column)?.chars().count())).max();
        let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
        let mut text = String::new();
        for line in &table {
            let fields = line.iter().zip(&widths).map(|(field, &width)| format!("{field:>width$}"));
            text.push_str(fields.collect::<Vec<_>>().join("  ").trim_end());
            text.push('\n');
        }
        text
    }

    /// Summarizes the trials. `terms` holds the names of the fitness terms.
    pub(crate) fn findings(&self, terms: &[String]) -> Findings {
        let rows = self.lines.get(1..).unwrap_or_default();
        let field = |row: &[String], column: usize| row.get(column).cloned().unwrap_or_default();
        let head = self.lines.first().map(Vec::as_slice).unwrap_or_default();
        let is_fitness = |&column: &usize| column == 4 || head[column].starts_with(FITNESS_OF);
        let fitness: Vec<usize> = (4..head.len()).filter(is_fitness).collect();
        let is_finite = |row: &[String], column| field(row, column).parse::<f64>().is_ok_and(f64::is_finite);
        let is_finished = |row: &[String]| fitness.iter().all(|&column| is_finite(row, column));
        let finished: Vec<&Vec<String>> = rows.iter().filter(|row| is_finished(row)).collect();
        let column = |column: usize| finished.iter().map(|row| field(row, column)).collect::<Vec<_>>();
        // The column is empty without a criterion of success.
        let has_success = rows.iter().any(|row| !field(row, 3).is_empty());
        let mut by_trial: BTreeMap<u32, Share> = BTreeMap::new();
        for row in rows.iter().filter(|_| has_success) {
            let share = by_trial.entry(field(row, 1).parse().unwrap_or_default()).or_default();
            share.of += 1;
            share.successes += usize::from(field(row, 3) == "true" && is_finished(row));
            share.broken_down += usize::from(!is_finished(row));
        }
        let notes = head.iter().enumerate().skip(HEAD.len()).filter(|(_, name)| !own_columns(terms).contains(name));
        let total = Share {
            successes: by_trial.values().map(|share| share.successes).sum(),
            of: rows.len(),
            broken_down: rows.len() - finished.len(),
        };
        // As in the first population, a trial that broke down is no success.
        let note = |(index, name): (usize, &String)| match Finding::from_fields(column(index)) {
            Finding::Mean(_) if name.starts_with(SUCCESS_OF) => {
                let successes = numbers(&column(index)).iter().sum::<f64>() as usize;
                (name.clone(), Finding::Mean(Share { successes, ..total }.rate()))
            }
            finding => (name.clone(), finding),
        };
        let rate = if has_success { total.rate() } else { f64::NAN };
        let proportion = Proportion { successes: total.successes, of: total.of };
        Findings {
            trials: total.of,
            successes: has_success.then_some(total.successes),
            rate,
            interval: if rate.is_nan() { [f64::NAN; 2] } else { proportion.interval() },
            broken_down: total.broken_down,
            fitness: mean(&column(4)),
            fitness_interval: mean_interval(&numbers(&column(4))).unwrap_or([f64::NAN; 2]),
            by_trial,
            notes: notes.map(note).collect(),
        }
    }
}

/// An experiment with one term has it as its fitness and gives it no column.
pub(super) fn own_columns(terms: &[String]) -> &[String] {
    if terms.len() > 1 { terms } else { &[] }
}

fn number(x: f64) -> String {
    format!("{x:?}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let outcome = |phase: &str, height: f64, success| Outcome {
            terms: vec![1.0, 2.5],
            steps: 6,
            success,
            notes: vec![("phase", phase.into()), ("height", height.into())],
            ..Outcome::default()
        };
        let results =
            |trial, outcome, fitness| TrialResult { trial, outcome, fitness, failure: None, others: Vec::new() };
        let trials = [
            results(0, outcome("reach", 1.0, false), 3.5),
            results(1, outcome("lift", 6.0, true), 3.5),
            results(2, Outcome::failed(), f64::NAN),
            results(0, outcome("lift", 8.0, true), 7.0),
        ];
        Table::new(&columns(&["a".into(), "b".into()]), &trials)
    }

    fn columns(terms: &[String]) -> Columns<'_> {
        Columns { terms, others: &[], has_success: true }
    }

    #[test]
    fn opponents_have_columns_of_their_own() {
        let outcome = Outcome { terms: vec![2.0], steps: 6, notes: vec![("at", 1.0.into())], ..Outcome::default() };
        let results = |others: &[(f64, bool)]| TrialResult {
            trial: 0,
            outcome: outcome.clone(),
            fitness: 2.0,
            failure: None,
            others: others.into(),
        };
        let trials = [results(&[(3.0, true), (0.5, false)]), results(&[(1.0, false), (0.5, false)])];
        let (terms, others) = (["a".into()], ["prey".into(), "2".into()]);
        let columns = Columns { others: &others, ..columns(&terms) };
        let table = Table::new(&columns, &trials);
        assert_eq!(
            table.lines[0][5..].join(","),
            "at,fitness of population prey,success of population prey,fitness of population 2,success of population 2"
        );
        assert_eq!(table.lines[1].join(","), "0,0,6,false,2.0,1.0,3.0,1,0.5,0");
        let notes = table.findings(&["a".into()]).notes;
        assert_eq!(
            notes[1..3].iter().map(|note| note.1.clone()).collect::<Vec<_>>(),
            [Finding::Mean(2.0), Finding::Mean(0.5)]
        );
        // A trial in which only an opponent broke down is a failure of all: 1 of 2 succeeds in both populations.
        let mut broken = results(&[(f64::NAN, false), (0.5, true)]);
        let mut good = results(&[(3.0, true), (0.5, true)]);
        (good.outcome.success, broken.outcome.success) = (true, true);
        let findings = Table::new(&columns, &[broken, good]).findings(&["a".into()]);
        assert_eq!((findings.broken_down, findings.successes, findings.fitness), (1, Some(1), 2.0));
        let means = [1.0, 3.0, 0.5, 0.5, 0.5].map(Finding::Mean);
        assert!(findings.notes.iter().map(|note| &note.1).eq(&means), "{findings:?}");
        // Without a criterion nothing succeeds or fails.
        let table = Table::new(&Columns { has_success: false, ..columns }, &trials);
        assert_eq!(table.lines[0][5..].join(","), "at,fitness of population prey,fitness of population 2");
        assert_eq!(table.lines[1].join(","), "0,0,6,,2.0,1.0,3.0,0.5");
        let findings = table.findings(&["a".into()]);
        assert!(findings.text().starts_with("success: no criterion\nfitness of a trial: mean 2.000 "));
        assert!(findings.by_trial.is_empty() && findings.rate.is_nan());
        assert_eq!(serde_json::to_value(&findings).unwrap()["successes"], serde_json::Value::Null);
    }

    #[test]
    fn a_table_counts_words_and_averages_numbers() {
        let table = table();
        assert_eq!(table.lines[0].join(","), "index,trial,steps,success,fitness,a,b,phase,height");
        assert_eq!(table.lines[1].join(","), "0,0,6,false,3.5,1.0,2.5,reach,1.0");
        assert_eq!(table.lines[3].join(","), "2,2,0,false,NaN,NaN,NaN,,");
        let findings = table.findings(&["a".into(), "b".into()]);
        assert_eq!(
            findings.text(),
            "success: 2 of 4 (50.0 %, 95 % interval 15.0 to 85.0 %)\nbroken down: 1 of 4 (25.0 %)\n\
             fitness of a trial: mean 4.667 (95 % interval 3.500 to 7.000)\n\
             phase: lift 2 of 4 (50.0 %), reach 1 of 4 (25.0 %)\nheight: mean 5.000\n"
        );
        let shares = findings.by_trial.values().map(|share| (share.successes, share.of)).collect::<Vec<_>>();
        assert_eq!(shares, [(1, 2), (1, 1), (0, 1)]);
        assert!(table.aligned().lines().all(|line| line.len() <= table.aligned().lines().next().unwrap().len()));
    }

    #[test]
    fn trials_that_broke_down_are_counted_and_not_averaged() {
        let outcome = |terms: &[f64], success, height: f64| Outcome {
            terms: terms.into(),
            success,
            notes: vec![("height", height.into())],
            ..Outcome::default()
        };
        let result =
            |trial, fitness, outcome| TrialResult { trial, outcome, fitness, failure: None, others: Vec::new() };
        let good = result(0, 3.0, outcome(&[1.0, 2.0], true, 4.0));
        // Its other term, its note and its success are those of a trial that was not finished.
        let broken = result(1, f64::NAN, outcome(&[f64::NAN, 50.0], true, 60.0));
        let terms = ["a".to_owned(), "b".to_owned()];
        let found = Table::new(&columns(&terms), &[good.clone(), broken.clone(), good.clone()]).findings(&[]);
        assert_eq!((found.trials, found.successes, found.broken_down, found.fitness), (3, Some(2), 1, 3.0));
        let means = [("a", 1.0), ("b", 2.0), ("height", 4.0)].map(|(name, x)| (name.to_owned(), Finding::Mean(x)));
        assert_eq!(found.notes, means);
        assert_eq!((found.by_trial[&0].rate(), found.by_trial[&1].rate().is_nan()), (1.0, true));
        assert_eq!(found.rate, 2.0 / 3.0);

        let none = Table::new(&columns(&terms), &[broken.clone(), broken]).findings(&terms);
        assert_eq!(
            none.text(),
            "success: no value\nbroken down: 2 of 2 (100.0 %)\nfitness of a trial: no value\nheight: no value\n"
        );
        let json = serde_json::to_value(&none).unwrap();
        assert_eq!((&json["fitness"], &json["broken_down"]), (&serde_json::Value::Null, &2.into()));
        assert_eq!(json["notes"]["height"]["mean"], serde_json::Value::Null);
    }

    #[test]
    fn it_reads_back_and_damage_is_found() {
        let head = "index,trial,steps,success,fitness,at\n";
        let good = Table::parse(&format!("{head}0,0,6,true,1.5,0.25\n1,1,6,false,NaN,\n")).unwrap();
        let findings = good.findings(&["fitness".into()]);
        assert_eq!((findings.successes, findings.broken_down, findings.fitness), (Some(1), 1, 1.5));
        assert_eq!(findings.notes, [("at".to_owned(), Finding::Mean(0.25))]);
        for (text, why) in [
            ("", "is not the table of a test"),
            ("generation,best\n0,1\n", "is not the table of a test"),
            (head, "truncated"),
            (&format!("{head}0,0,6,true,1.5,0.2"), "truncated"),
            (&format!("{head}0,0,6,true,1.5,1\n1,0,6\n"), "3 fields"),
            (&format!("{head}0,0,6,true,1.5,1\n2,0,6,true,1.5,1\n"), "line 3 "),
            (&format!("{head}0,0,6,yes,1.5,1\n"), "line 2 "),
        ] {
            let found = Table::parse(text).unwrap_err();
            assert!(found.contains(why), "{text}: {found}");
        }
    }
}
