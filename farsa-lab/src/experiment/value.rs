//! Values of settings.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Value of a setting.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Value {
    /// Yes or no.
    Flag(bool),
    /// A whole number.
    Whole(i64),
    /// A number.
    Number(f64),
    /// One of a few words, or any text.
    Word(String),
    /// A list of numbers.
    Numbers(Vec<f64>),
}

impl fmt::Display for Value {
    /// The value as TOML writes it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flag(flag) => write!(f, "{flag}"),
            Self::Whole(n) => write!(f, "{n}"),
            // The debug form is the shortest that reads back as the same number, and always looks like a float.
            Self::Number(x) => write!(f, "{x:?}"),
            Self::Word(word) => write_string(f, word),
            Self::Numbers(list) => write!(f, "{list:?}"),
        }
    }
}

/// Writes a text as a basic string of TOML.
fn write_string(f: &mut fmt::Formatter<'_>, text: &str) -> fmt::Result {
    f.write_str("\"")?;
    for c in text.chars() {
        match c {
            '"' | '\\' => write!(f, "\\{c}")?,
            '\n' => f.write_str("\\n")?,
            '\t' => f.write_str("\\t")?,
            '\r' => f.write_str("\\r")?,
            c if c.is_ascii_control() => write!(f, "\\u{:04X}", u32::from(c))?,
            c => write!(f, "{c}")?,
        }
    }
    f.write_str("\"")
}

/// A text of several lines, as TOML has it.
pub(crate) struct Paragraph<'t>(pub(crate) &'t str);

impl fmt::Display for Paragraph<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(text) = self;
        // Characters that a literal text cannot hold.
        if text.contains("'''")
            || text.ends_with('\'')
            || text.chars().any(|c| c.is_control() && c != '\n' && c != '\t')
        {
            return write_string(f, text);
        }
        write!(f, "'''\n{text}'''")
    }
}
