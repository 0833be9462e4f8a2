//! A file in another format, converted to a file that describes an experiment.

use std::fmt;

use serde::Serialize;

use crate::escaped::{OneLine, Quoted};

/// Result of an import.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImportedFile {
    /// Text of the file that describes the experiment.
    pub text: String,
    /// Lines that were lost or changed.
    pub left: Vec<LeftOut>,
    /// Lines that were skipped, since they have no effect.
    pub idle: Vec<LeftOut>,
    /// Number of further lost lines. This is not zero if the importer limits the length of `left`.
    pub more_left: usize,
    /// Number of further skipped lines.
    pub more_idle: usize,
}

/// A line that was not imported as it is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// Number of the line, from 1. If this is `None`, it is a default of the other program.
    pub line: Option<usize>,
    /// Key, including the groups around it.
    pub key: String,
    /// Value of the key.
    pub value: String,
    /// Reason, together with the nearest setting.
    pub why: String,
}

impl fmt::Display for LeftOut {
    /// Formats the line as one line of text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { line, key, value, why } = self;
        match line {
            Some(line) => write!(f, "line {line}: ")?,
            None => write!(f, "by default: ")?,
        }
        let setting = if value.is_empty() { key.clone() } else { format!("{key} = {value}") };
        write!(f, "{}: {}", Quoted(&setting), OneLine(why))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remarks_are_lines_of_their_own() {
        let left = |line, value: &str| LeftOut { line, key: "A/b".into(), value: value.into(), why: "is\nlost".into() };
        assert_eq!(left(Some(3), "x\u{1b}").to_string(), "line 3: `A/b = x\\u{1b}`: is\\nlost");
        assert_eq!(left(None, "").to_string(), "by default: `A/b`: is\\nlost");
    }
}
