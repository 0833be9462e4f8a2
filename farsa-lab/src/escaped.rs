//! Untrusted text on a terminal: control characters and direction marks are written as escapes.
//!
//! Errors and summaries repeat keys, values, lines and file names of untrusted files. [`escaped`] is for text of
//! several lines. [`OneLine`] and [`Quoted`] are for parts of a line.

use std::borrow::Cow;
use std::fmt;

/// Most characters of a name or a value that a message repeats.
pub(crate) const MAX_SHOWN: usize = 200;

/// End of a shortened text.
pub(crate) const CUT: &str = "...";

/// The text with every control character but the line's end and the tab as `\u{..}`, and so the characters that turn the
/// direction of writing or divide lines.
pub(crate) fn escaped(text: &str) -> Cow<'_, str> {
    with_escapes(text, acts)
}

/// Checks whether a terminal interprets the character instead of printing it.
pub(crate) fn acts(c: char) -> bool {
    let turns = matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    (c.is_control() && c != '\n' && c != '\t') || turns || matches!(c, '\u{2028}' | '\u{2029}')
}

fn with_escapes(text: &str, which: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&which) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match c {
            c if !which(c) => out.push(c),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            c => out.extend(c.escape_unicode()),
        }
    }
    Cow::Owned(out)
}

/// Gets the beginning of a text, with dots if that is not all of it.
pub(crate) fn shortened(text: &str) -> Cow<'_, str> {
    match text.char_indices().nth(MAX_SHOWN) {
        Some((end, _)) => Cow::Owned(format!("{}{CUT}", text.get(..end).unwrap_or_default())),
        None => Cow::Borrowed(text),
    }
}

/// A part of a message that must not begin another line: its line ends and tabs are escaped too.
pub(crate) struct OneLine<T>(pub(crate) T);

impl<T: fmt::Display> fmt::Display for OneLine<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&with_escapes(&self.0.to_string(), |c| acts(c) || c == '\n' || c == '\t'))
    }
}

/// A name in a message: in backquotes, on one line, and not longer than can be read.
pub(crate) struct Quoted<'t>(pub(crate) &'t str);

impl fmt::Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`", OneLine(shortened(self.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_a_terminal_obeys_is_escaped() {
        for (text, shown) in [
            ("a\u{1b}[2Jb", "a\\u{1b}[2Jb"),
            ("\u{1b}]0;x\u{7}", "\\u{1b}]0;x\\u{7}"),
            ("\u{9b}2J\u{7f}\0\r", "\\u{9b}2J\\u{7f}\\u{0}\\u{d}"),
            ("\u{202e}a\u{2066}b\u{2069}\u{2028}\u{2029}", "\\u{202e}a\\u{2066}b\\u{2069}\\u{2028}\\u{2029}"),
            ("a\tb\n", "a\tb\n"),
            ("größer \u{5d0} \u{1f916} \\u{1b}", "größer \u{5d0} \u{1f916} \\u{1b}"),
        ] {
            assert_eq!(escaped(text), shown);
        }
        assert!(matches!(escaped("plain\n"), Cow::Borrowed("plain\n")));
        assert_eq!(OneLine("a\nerror: b\t\u{1b}").to_string(), "a\\nerror: b\\t\\u{1b}");
        assert_eq!(Quoted("a\nb").to_string(), "`a\\nb`");
        let (long, longer) = ("é".repeat(MAX_SHOWN), "é".repeat(MAX_SHOWN + 1));
        assert_eq!(
            (Quoted(&long).to_string(), Quoted(&longer).to_string()),
            (format!("`{long}`"), format!("`{long}...`"))
        );
    }

    proptest! {
        #[test]
        fn nothing_is_left_that_acts_and_again_changes_nothing(text in "[\\PC\\pC]{0,40}") {
            let once = escaped(&text).into_owned();
            prop_assert!(!once.contains(acts));
            prop_assert_eq!(&*escaped(&once), &once);
            prop_assert_eq!(OneLine(&text).to_string().lines().count(), usize::from(!text.is_empty()));
        }
    }
}
