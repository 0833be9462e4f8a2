//! Tests of an individual under conditions that its evolution may never have had: a table of cases.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::error::Error;
use crate::escaped::{OneLine, Quoted};

/// Most cases of a protocol.
const MAX_CASES: usize = 10_000;
/// Most neurons whose states are recorded.
const MAX_STATES: usize = 256;
/// Most bytes of a protocol's name, and of a row's or a column's.
const MAX_NAME_BYTES: [usize; 2] = [64, 120];

/// A test of an individual, given as a table of cases that all use the same starts.
///
/// Use `farsa test DIR --protocol NAME` to run it. Your evaluator finds the case of a trial in
/// [`Evaluation::case`](crate::Evaluation::case). If you only need a list of cases, this is a table of one column.
///
/// ```
/// use farsa_lab::advanced::Protocol;
///
/// let words = Protocol::from_table("instructions", "every instruction", ["TOUCH", "MOVE"], ["red", "green"])
///     .with_axes("action", "object")
///     .with_held_out(|row, column| row == "MOVE" && column == "red");
/// assert_eq!(words.cases.len(), 4);
/// assert_eq!((words.cases[2].row.as_str(), words.cases[2].column.as_str()), ("MOVE", "red"));
/// assert!(words.cases[2].held_out && !words.cases[3].held_out);
/// assert_eq!(words.with_trials(80).trials, 80);
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Protocol {
    /// Name of the protocol, which may contain lowercase letters, digits and hyphens.
    pub name: String,
    /// Purpose, in one line.
    pub summary: String,
    /// Default number of trials per case.
    pub trials: u32,
    /// Titles of rows and columns: `["action", "object"]`. Empty for none.
    pub axes: [String; 2],
    /// Cells of the table, in the order of evaluation.
    ///
    /// Rows and columns are shown in order of first appearance. Note that a table may have holes.
    pub cases: Vec<Case>,
    /// Neurons of the [`Schema`](farsa_view::Schema) that form the internal state. The first trials of each case are
    /// recorded, and reports draw the first two principal components. Empty for no recording.
    pub states: Range<usize>,
}

/// A cell of a protocol's table.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Case {
    /// Row of the case.
    pub row: String,
    /// Column of the case. Empty in a list.
    pub column: String,
    /// True if the case was absent from the trials of evolution.
    pub held_out: bool,
}

impl Case {
    /// Creates a case that was part of evolution, so `held_out` is `false`.
    pub fn new(row: impl Into<String>, column: impl Into<String>) -> Self {
        Self { row: row.into(), column: column.into(), held_out: false }
    }

    /// Formats the name of the case, for example `TOUCH red`. In a list this is just the row.
    pub fn name(&self) -> String {
        if self.column.is_empty() { self.row.clone() } else { format!("{} {}", self.row, self.column) }
    }
}

/// Identifies the case that a trial belongs to, together with its protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CaseId {
    /// Index of the protocol in [`TaskInfo::protocols`](crate::TaskInfo::protocols).
    pub protocol: usize,
    /// Index of the case in [`Protocol::cases`].
    pub case: usize,
}

impl Protocol {
    /// Creates a protocol without cases, and with 20 trials per case.
    ///
    /// Note that a protocol without cases does not pass [`check`](Self::check). Add some using
    /// [`with_case`](Self::with_case).
    pub fn new(name: impl Into<String>, summary: impl Into<String>) -> Self {
        Self { name: name.into(), summary: summary.into(), trials: 20, ..Self::default() }
    }

    /// Creates a protocol from a list of cases.
    pub fn from_list<R: Into<String>>(
        name: impl Into<String>,
        summary: impl Into<String>,
        rows: impl IntoIterator<Item = R>,
    ) -> Self {
        let cases = rows.into_iter().map(|row| Case::new(row, "")).collect();
        Self { cases, ..Self::new(name, summary) }
    }

    /// Creates a protocol from a full table, row by row.
    ///
    /// This means that the case in row `r` and column `c` has index `r * columns + c`.
    pub fn from_table<R: Into<String>, C: Into<String>>(
        name: impl Into<String>,
        summary: impl Into<String>,
        rows: impl IntoIterator<Item = R>,
        columns: impl IntoIterator<Item = C>,
    ) -> Self {
        let columns: Vec<String> = columns.into_iter().map(Into::into).collect();
        let of_row = |row: R| {
            let row: String = row.into();
            columns.iter().map(|column| Case::new(row.clone(), column.clone())).collect::<Vec<_>>()
        };
        let cases = rows.into_iter().flat_map(of_row).collect();
        Self { cases, ..Self::new(name, summary) }
    }

    /// Sets the number of trials per case.
    #[must_use]
    pub fn with_trials(self, trials: u32) -> Self {
        Self { trials, ..self }
    }

    /// Sets the titles of rows and columns.
    #[must_use]
    pub fn with_axes(self, rows: impl Into<String>, columns: impl Into<String>) -> Self {
        Self { axes: [rows.into(), columns.into()], ..self }
    }

    /// Sets the neurons whose states are recorded in the first trials of each case.
    #[must_use]
    pub fn with_states(self, states: Range<usize>) -> Self {
        Self { states, ..self }
    }

    /// Appends a case.
    #[must_use]
    pub fn with_case(mut self, case: Case) -> Self {
        self.cases.push(case);
        self
    }

    /// Marks the cases for which `held_out` returns `true` as absent from evolution.
    ///
    /// The closure is called with the row and the column of each case. This overwrites earlier marks.
    #[must_use]
    pub fn with_held_out(mut self, held_out: impl Fn(&str, &str) -> bool) -> Self {
        for case in &mut self.cases {
            case.held_out = held_out(&case.row, &case.column);
        }
        self
    }

    /// Gets the number of the protocol of this name among those of an experiment, all of which are looked at.
    ///
    /// # Errors
    /// [`Error::Setting`] with the nearest name that there is, [`Error::Usage`] where there is no protocol at all, and
    /// [`Error::Other`] for protocols that cannot be run: see [`check`](Self::check).
    pub(crate) fn find(protocols: &[Self], name: &str, experiment: &str) -> Result<usize, Error> {
        Self::check(protocols)?;
        if protocols.is_empty() {
            let why = format!("no test protocol {}: experiment `{experiment}` has none", Quoted(name));
            return Err(Error::Usage(why));
        }
        let names = || protocols.iter().map(|protocol| protocol.name.as_str());
        let place = format!("experiment `{experiment}`, which has {}", names().collect::<Vec<_>>().join(", "));
        let number = protocols.iter().position(|protocol| protocol.name == name);
        number.ok_or_else(|| Error::unknown(&place, "test protocol", name, names()))
    }

    /// Gets the number of the case of this name, or of this number from 0 if none has the name.
    ///
    /// # Errors
    /// [`Error::Setting`] with the nearest name that there is.
    pub(crate) fn case(&self, name: &str) -> Result<usize, Error> {
        let names: Vec<String> = self.cases.iter().map(Case::name).collect();
        let number = || name.parse().ok().filter(|number| *number < names.len());
        let place =
            format!("protocol `{}`, whose cases are numbered 0 to {}", self.name, names.len().saturating_sub(1));
        let position = names.iter().position(|other| other == name).or_else(number);
        position.ok_or_else(|| Error::unknown(&place, "case", name, names.iter().map(String::as_str)))
    }

    /// Checks the names, cases and trials of all protocols.
    ///
    /// # Errors
    /// Returns [`Error::Other`] with the name of the first invalid protocol and the reason.
    pub fn check(protocols: &[Self]) -> Result<(), Error> {
        let mut names = BTreeSet::new();
        for protocol in protocols {
            let wrong = match protocol.wrong() {
                None if !names.insert(protocol.name.as_str()) => Some("is there twice".into()),
                wrong => wrong,
            };
            if let Some(wrong) = wrong {
                return Err(Error::Other(format!("the experiment's protocol `{}` {wrong}", OneLine(&protocol.name))));
            }
        }
        Ok(())
    }

    /// Checks this protocol by itself.
    fn wrong(&self) -> Option<String> {
        let word = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'-';
        let [name, place] = MAX_NAME_BYTES;
        if !self.name.bytes().all(word) || !self.name.starts_with(|first: char| first.is_ascii_alphanumeric()) {
            return Some("has no name of small letters, digits and hyphens".into());
        }
        if self.name.len() > name {
            return Some(format!("has a name of {} bytes, at most {name}", self.name.len()));
        }
        if self.trials == 0 {
            return Some("has 0 trials a case".into());
        }
        if !(1..=MAX_CASES).contains(&self.cases.len()) {
            return Some(format!("has {} cases, not 1 to {MAX_CASES}", self.cases.len()));
        }
        if self.states.len() > MAX_STATES {
            return Some(format!("records the states of {} neurons, at most {MAX_STATES}", self.states.len()));
        }
        let mut cells = BTreeSet::new();
        for (number, Case { row, column, .. }) in self.cases.iter().enumerate() {
            if row.is_empty() || [row, column].into_iter().any(|text| text.len() > place) {
                return Some(format!("has case {number} without a row, or with a name of more than {place} bytes"));
            }
            if [row, column].into_iter().any(|text| text.chars().any(char::is_control)) {
                return Some(format!("has a control character in the names of case {number}"));
            }
            if !cells.insert((row, column)) {
                return Some(format!("has the case of row `{row}` and column `{column}` twice"));
            }
        }
        None
    }

    /// Gets the names of the rows, or of the columns, each once in the order of the cases.
    pub(crate) fn places<'c>(cases: &'c [Case], of: impl Fn(&'c Case) -> &'c str) -> Vec<&'c str> {
        let mut seen = BTreeSet::new();
        cases.iter().map(of).filter(|name| seen.insert(*name)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lesions() -> Protocol {
        Protocol::from_list("lesions", "each neuron is cut", ["intact", "neuron 1"])
    }

    #[test]
    fn tables_are_row_after_row_and_lists_have_no_columns() {
        let table = Protocol::from_table("grid", "", ["a", "b"], ["1", "2", "3"]);
        let names: Vec<String> = table.cases.iter().map(Case::name).collect();
        assert_eq!(names, ["a 1", "a 2", "a 3", "b 1", "b 2", "b 3"]);
        assert_eq!(Protocol::places(&table.cases, |case| &case.column), ["1", "2", "3"]);
        assert_eq!(Protocol::places(&table.cases, |case| &case.row), ["a", "b"]);
        let list = lesions().with_case(Case { held_out: true, ..Case::new("neuron 2", "") });
        assert_eq!(list.cases.iter().map(Case::name).collect::<Vec<_>>(), ["intact", "neuron 1", "neuron 2"]);
        assert_eq!((list.trials, list.cases[2].held_out), (20, true));
        Protocol::check(&[table, list]).unwrap();
    }

    #[test]
    fn protocols_are_found_by_name_and_others_get_the_nearest() {
        let two = [Protocol::from_list("noise", "", ["0"]), lesions()];
        assert_eq!(Protocol::find(&two, "lesions", "toy").unwrap(), 1);
        let error = Protocol::find(&two, "lesion", "toy").unwrap_err();
        let text = error.to_string();
        assert!(text.contains("the nearest is `lesions`"), "{text}");
        assert!(text.contains("noise, lesions") && text.contains("`lesion`"), "{text}");
        assert_eq!(two[1].case("neuron 1").unwrap(), 1);
        assert_eq!(two[1].case("1").unwrap(), 1);
        assert_eq!(two[0].case("0").unwrap(), 0, "the name before the number");
        let error = two[1].case("neuron 2").unwrap_err().to_string();
        assert!(
            error.contains("`lesions`, whose cases are numbered 0 to 1") && error.contains("`neuron 1`"),
            "{error}"
        );
        assert!(two[1].case("2").is_err() && two[1].case("-1").is_err());
        let none = Protocol::find(&[], "lesions", "toy").unwrap_err();
        assert!(matches!(none, Error::Usage(_)) && none.to_string().contains("experiment `toy` has none"), "{none}");
    }

    #[test]
    fn protocols_that_cannot_be_run_are_refused_with_numbers() {
        let named = |name: &str| Protocol { name: name.into(), ..lesions() };
        let cases = |cases: Vec<Case>| Protocol { cases, ..lesions() };
        for (wrong, why) in [
            (named(""), "small letters"),
            (named("../up"), "small letters"),
            (named("-x"), "small letters"),
            (named("Noise"), "small letters"),
            (named(&"n".repeat(65)), "65 bytes, at most 64"),
            (lesions().with_trials(0), "0 trials"),
            (lesions().with_states(1..258), "257 neurons, at most 256"),
            (cases(vec![]), "0 cases"),
            (cases((0..=10_000).map(|row| Case::new(row.to_string(), "")).collect()), "10001 cases, not 1 to 10000"),
            (cases(vec![Case::new("", "red")]), "case 0 without a row"),
            (cases(vec![Case::new("a", "b"), Case::new("a", "x".repeat(121))]), "case 1"),
            (cases(vec![Case::new("a\n", "")]), "control character"),
            (cases(vec![Case::new("a", "b"), Case::new("c", "b"), Case::new("a", "b")]), "`a` and column `b` twice"),
        ] {
            let error = Protocol::check(&[lesions(), wrong]).unwrap_err().to_string();
            assert!(error.contains(why), "{error}");
        }
        let error = Protocol::check(&[lesions(), lesions()]).unwrap_err().to_string();
        assert!(error.contains("`lesions` is there twice"), "{error}");
    }
}
