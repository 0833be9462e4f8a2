//! The text of the experiment file.

use std::fmt::Write as _;

use toml::Value;

/// The text of an experiment file, table by table.
#[derive(Debug, Default)]
pub(super) struct Written(String);

impl Written {
    /// Writes a comment. Empty lines stay empty.
    pub(super) fn comment(&mut self, line: &str) {
        self.line(format!("# {}", shown(line)).trim_end());
    }

    /// Writes an empty line.
    pub(super) fn space(&mut self) {
        self.line("");
    }

    /// Begins a table, such as `[world]`.
    pub(super) fn table(&mut self, head: &str) {
        self.space();
        self.head(head);
    }

    /// Begins a table below a comment.
    pub(super) fn head(&mut self, head: &str) {
        self.line(head);
    }

    /// Writes a key with a value that is already TOML.
    pub(super) fn set(&mut self, key: &str, value: impl std::fmt::Display) {
        self.line(&format!("{key} = {value}"));
    }

    /// Writes a key with a text.
    pub(super) fn word(&mut self, key: &str, text: &str) {
        self.set(key, quoted(text));
    }

    /// Returns the text.
    pub(super) fn into_text(self) -> String {
        self.0
    }

    fn line(&mut self, line: &str) {
        // Writing into a string cannot fail.
        let _ = writeln!(self.0, "{line}");
    }
}

/// Formats a number as TOML, always with a point.
pub(super) fn number(value: f64) -> String {
    Value::Float(value).to_string()
}

/// Formats a list of numbers.
pub(super) fn numbers(values: &[f64]) -> String {
    let items: Vec<String> = values.iter().map(|value| number(*value)).collect();
    format!("[{}]", items.join(", "))
}

/// Quotes a text.
pub(super) fn quoted(text: &str) -> String {
    Value::String(shown(text)).to_string()
}

/// Truncates an untrusted text and removes control characters, so that it stays in its line.
pub(super) fn shown(text: &str) -> String {
    const MOST: usize = 400;
    let tame = |c: char| {
        let acts =
            c.is_control() || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{2028}' | '\u{2029}');
        if acts { '?' } else { c }
    };
    let mut out: String = text.chars().take(MOST).map(tame).collect();
    if text.chars().nth(MOST).is_some() {
        out.push_str("...");
    }
    out
}

/// Converts a name, such as `Wheel speeds` into `wheel-speeds`. Returns `None` without any letter or digit.
pub(super) fn name(text: &str) -> Option<String> {
    let mut out = String::new();
    for sign in text.chars().take(40) {
        match sign {
            'a'..='z' | '0'..='9' => out.push(sign),
            'A'..='Z' => out.push(sign.to_ascii_lowercase()),
            _ if !out.is_empty() && !out.ends_with('-') => out.push('-'),
            _ => {}
        }
    }
    let out = out.trim_end_matches('-');
    (!out.is_empty()).then(|| out.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strangers_texts_stay_in_their_line() {
        let mut written = Written::default();
        written.comment("a\nb\u{202e}c\u{7}");
        written.word("summary", "x\" \\ \u{1b}[2J");
        let text = written.into_text();
        let read: toml::Table = text.parse().unwrap();
        assert_eq!(read["summary"].as_str(), Some("x\" \\ ?[2J"));
        assert!(text.starts_with("# a?b?c?\n"), "{text}");
        assert_eq!(shown(&"x".repeat(500)).len(), 403);
    }

    #[test]
    fn names_are_those_of_the_format() {
        for (text, expected) in
            [("Proximity", Some("proximity")), ("W  0!", Some("w-0")), ("_-Ä", None), ("", None), ("--9", Some("9"))]
        {
            assert_eq!(name(text).as_deref(), expected, "{text}");
            let letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
            assert!(expected.is_none_or(|name| name.chars().all(letter) && !name.starts_with('-')));
        }
        assert_eq!((number(1.0), numbers(&[0.5, -2.0])), ("1.0".into(), "[0.5, -2.0]".into()));
    }
}
