//! `protocols/NAME.csv`: a line per trial, case after case.

use std::path::Path;

use crate::error::Error;
use crate::evaluation::test_table::{Columns, Table, TrialResult};
use crate::experiment::protocol::{Case, Protocol};

/// Columns of the case. The columns of a test follow, and their index counts the trials of the case.
const HEAD: [&str; 4] = ["case", "row", "column", "held_out"];

/// Trials of a protocol, a table for each case.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ProtocolTable {
    pub(crate) cases: Vec<(Case, Table)>,
}

impl ProtocolTable {
    /// Builds the table of a number of trials of each case.
    pub(crate) fn new(cases: &[Case], trials: usize, columns: &Columns<'_>, results: &[TrialResult]) -> Self {
        // One table first, so that all cases have the same columns.
        let tables = Table::new(columns, results).divided(trials);
        Self { cases: cases.iter().cloned().zip(tables).collect() }
    }

    /// Parses the text of the file at `path`.
    ///
    /// # Errors
    /// [`Error::File`] when it is not the table of a protocol.
    pub(crate) fn from_text(path: &Path, text: &str) -> Result<Self, Error> {
        Self::parse(text).map_err(|why| Error::damaged(path, why))
    }

    fn parse(text: &str) -> Result<Self, String> {
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
        let mut records = reader.records();
        let mut next = || -> Result<Option<[Vec<String>; 2]>, String> {
            // The reader reports lines of unequal length with their number.
            let Some(record) = records.next().transpose().map_err(|error| error.to_string())? else { return Ok(None) };
            let (of_case, rest) = (record.iter().take(HEAD.len()), record.iter().skip(HEAD.len()));
            Ok(Some([of_case.map(str::to_owned).collect(), rest.map(str::to_owned).collect()]))
        };
        let head = match next()? {
            Some([of_case, head]) if of_case == HEAD => head,
            _ => return Err("is not the table of a protocol".into()),
        };
        let mut cases: Vec<(Case, Vec<Vec<String>>)> = Vec::new();
        let mut line = 1;
        while let Some([of_case, trial]) = next()? {
            line += 1;
            let (number, case) = case(&of_case).ok_or_else(|| format!("line {line} names no case"))?;
            match cases.last_mut() {
                Some((last, lines)) if *last == case => lines.push(trial),
                _ => cases.push((case, vec![head.clone(), trial])),
            }
            if number.checked_add(1) != Some(cases.len()) {
                return Err(format!("line {line} is of case {number}, not {}", cases.len().saturating_sub(1)));
            }
        }
        if cases.is_empty() || !text.ends_with('\n') {
            return Err("truncated".into());
        }
        let named = Protocol { cases: cases.iter().map(|(case, _)| case.clone()).collect(), ..Protocol::new("x", "") };
        Protocol::check(std::slice::from_ref(&named)).map_err(|error| error.to_string())?;
        let mut first = 2;
        let tables = cases.into_iter().map(|(case, lines)| {
            let next = first + lines.len() - 1;
            let table = Table::from_lines(lines, std::mem::replace(&mut first, next))?;
            Ok((case, table))
        });
        Ok(Self { cases: tables.collect::<Result<_, String>>()? })
    }

    /// Writes the content of the file for `path`.
    ///
    /// # Errors
    /// [`Error::File`], should the writer refuse.
    pub(crate) fn csv(&self, path: &Path) -> Result<Vec<u8>, Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let written = self.cases.iter().enumerate().try_for_each(|(number, (case, table))| {
            let Some((head, trials)) = table.lines().split_first() else { return Ok(()) };
            if number == 0 {
                writer.write_record(HEAD.into_iter().chain(head.iter().map(String::as_str)))?;
            }
            let of_case = [number.to_string(), case.row.clone(), case.column.clone(), case.held_out.to_string()];
            trials.iter().try_for_each(|trial| writer.write_record(of_case.iter().chain(trial)))
        });
        written.map_err(|error: csv::Error| Error::damaged(path, error))?;
        writer.into_inner().map_err(|error| Error::damaged(path, error.to_string()))
    }
}

/// Finds the number of a case, and the case.
fn case(fields: &[String]) -> Option<(usize, Case)> {
    let [number, row, column, held_out] = fields else { return None };
    let case = Case { row: row.clone(), column: column.clone(), held_out: held_out.parse().ok()? };
    Some((number.parse().ok()?, case))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::outcome::Outcome;

    const CASES: &str = "case,row,column,held_out,index,trial,steps,success,fitness,at\n\
        0,\"TOUCH, softly\",red,false,0,0,6,true,1.5,0.25\n0,\"TOUCH, softly\",red,false,1,1,6,false,0.5,0.5\n\
        1,MOVE,red,true,0,0,6,false,NaN,\n1,MOVE,red,true,1,1,6,true,2.0,1.0\n";

    #[test]
    fn a_case_of_the_greatest_number_is_refused() {
        let head = HEAD.join(",");
        let why = ProtocolTable::parse(&format!("{head},trial\n{},a,b,true,0\n", usize::MAX)).map(drop).unwrap_err();
        assert_eq!(why, format!("line 2 is of case {}, not 0", usize::MAX));
    }

    #[test]
    fn what_is_written_is_read_back() {
        let outcome =
            |success, at: f64| Outcome { success, steps: 6, notes: vec![("at", at.into())], ..Outcome::default() };
        let result =
            |trial, fitness, outcome| TrialResult { trial, outcome, fitness, failure: None, others: Vec::new() };
        let results = [
            result(0, 1.5, outcome(true, 0.25)),
            result(1, 0.5, outcome(false, 0.5)),
            result(0, f64::NAN, Outcome { steps: 6, ..Outcome::failed() }),
            result(1, 2.0, outcome(true, 1.0)),
        ];
        let cases = [Case::new("TOUCH, softly", "red"), Case { held_out: true, ..Case::new("MOVE", "red") }];
        let columns = Columns { terms: &["fitness".into()], others: &[], has_success: true };
        let table = ProtocolTable::new(&cases, 2, &columns, &results);
        let path = Path::new("x.csv");
        assert_eq!(String::from_utf8(table.csv(path).unwrap()).unwrap(), CASES);
        assert_eq!(ProtocolTable::from_text(path, CASES).unwrap(), table);
    }

    #[test]
    fn damage_is_found_with_its_line() {
        let head = CASES.lines().next().unwrap();
        let with = |line: &str| format!("{head}\n0,a,x,false,0,0,6,true,1.5,1\n{line}\n");
        ProtocolTable::parse(&with("1,a,y,false,0,0,6,true,1.5,1")).unwrap();
        for (text, why) in [
            (String::new(), "is not the table of a protocol"),
            ("index,trial,steps,success,fitness\n0,0,6,true,1\n".into(), "is not the table of a protocol"),
            ("case,row,column,held_out\n0,a,b,true\n".into(), "is not the table of a test"),
            (format!("{head}\n"), "truncated"),
            (CASES.trim_end().to_owned(), "truncated"),
            (with("0,a,x,false,1,1,6,true,1.5"), "9 fields"),
            (with("0,a,x,false,0,1,6,true,1.5,1"), "line 3 is not a trial"),
            (with("0,a,x,false,1,1,6,yes,1.5,1"), "line 3 is not a trial"),
            (with("1,a,y,false,1,1,6,true,1.5,1"), "line 3 is not a trial"),
            (with("0,a,x,maybe,1,1,6,true,1.5,1"), "line 3 names no case"),
            (with("-1,a,x,false,1,1,6,true,1.5,1"), "line 3 names no case"),
            (with("0,a,y,false,1,1,6,true,1.5,1"), "line 3 is of case 0, not 1"),
            (with("2,a,y,false,0,0,6,true,1.5,1"), "line 3 is of case 2, not 1"),
            (with("1,a,x,true,0,0,6,true,1.5,1"), "row `a` and column `x` twice"),
            (with("1,,y,true,0,0,6,true,1.5,1"), "case 1 without a row"),
            (with("1,\"\u{1b}\",y,true,0,0,6,true,1.5,1"), "control character"),
        ] {
            let found = ProtocolTable::parse(&text).unwrap_err();
            assert!(found.contains(why), "{text}: {found}");
        }
    }
}
