//! A file in another format as one that describes an experiment.

use std::fmt;

use serde::Serialize;

use crate::escaped::{OneLine, Quoted};

/// What came of a file in another format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImportedFile {
    /// The file that describes the experiment.
    pub text: String,
    /// What is lost, or other here than it was there.
    pub left: Vec<LeftOut>,
    /// What was passed over because it changes nothing that comes out.
    pub idle: Vec<LeftOut>,
    /// How many more lines than stand in `left` are lost; an importer bounds what it tells.
    pub more_left: usize,
    /// The same of `idle`.
    pub more_idle: usize,
}

/// A line that is not carried over as it is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// Where it stands, from 1; none for what the other program takes where nothing is said.
    pub line: Option<usize>,
    /// Its key, with those that it is in.
    pub key: String,
    /// Its value.
    pub value: String,
    /// Why, and what is nearest here.
    pub why: String,
}

impl fmt::Display for LeftOut {
    /// In one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { line, key, value, why } = self;
        match line {
            Some(line) => write!(f, "line {line}: ")?,
            None => write!(f, "by default: ")?,
        }
        let said = if value.is_empty() { key.clone() } else { format!("{key} = {value}") };
        write!(f, "{}: {}", Quoted(&said), OneLine(why))
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
