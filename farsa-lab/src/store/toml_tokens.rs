//! How many tokens a TOML text has, so that one that would take much memory is refused before its tree is built.
//!
//! The tree of the crate `toml` takes up to 600 bytes for each token: each name of `[a.a.a]` is a table of its own.

use crate::error::Error;
use crate::escaped::OneLine;

/// The most tokens that are read: ten thousand keys with their values have less than half as many.
const MAX_TOKENS: usize = 200_000;

/// Refuses a TOML text of more than 200 000 tokens: names, values, signs and the gaps between them. A string or a comment is
/// one, a number with a point is three.
///
/// # Errors
/// [`Error::Usage`] with the name of the file, the limit and the number.
pub fn limit_toml_tokens(file: &str, text: &str) -> Result<(), Error> {
    let count = toml_tokens(text);
    if count <= MAX_TOKENS {
        return Ok(());
    }
    let file = OneLine(file);
    Err(Error::Usage(format!(
        "{file}: has {count} names, values, signs and gaps; at most {MAX_TOKENS} are read of TOML"
    )))
}

/// The tokens of a text, as the crate `toml` counts them, whether or not it is TOML.
pub(crate) fn toml_tokens(text: &str) -> usize {
    let mut rest = text.strip_prefix('\u{feff}').unwrap_or(text).as_bytes();
    let mut count = 0;
    while !rest.is_empty() {
        rest = &rest[first(rest)..];
        count += 1;
    }
    count
}

/// The bytes of the first token of a text that is not empty.
fn first(text: &[u8]) -> usize {
    match text[0] {
        b'.' | b'=' | b',' | b'[' | b']' | b'{' | b'}' | b'\n' => 1,
        b' ' | b'\t' => until(text, const { &bytes(b" \t", false) }),
        b'#' => until(text, const { &bytes(b"\r\n", true) }),
        b'\r' => 1 + usize::from(text.get(1) == Some(&b'\n')),
        quote @ (b'\'' | b'"') if text.starts_with(&[quote; 3]) => long_string(text, quote),
        b'"' => string(text, const { &bytes(b"\\\"\n", true) }),
        b'\'' => string(text, const { &bytes(b"'\n", true) }),
        // A quote within ends nothing.
        _ => until(text, const { &bytes(b".=,[]{} \t#\r\n", true) }),
    }
}

/// Which bytes are among these, or are not.
const fn bytes(these: &[u8], among: bool) -> [bool; 256] {
    let mut found = [!among; 256];
    let mut number = 0;
    while number < these.len() {
        found[these[number] as usize] = among;
        number += 1;
    }
    found
}

/// The bytes before the first of some, or all.
fn until(text: &[u8], ends: &[bool; 256]) -> usize {
    text.iter().position(|&byte| ends[usize::from(byte)]).unwrap_or(text.len())
}

/// A string of one line, with its quotes; one that is not closed ends with the line.
fn string(text: &[u8], marks: &[bool; 256]) -> usize {
    let mut at = 1;
    loop {
        at += until(&text[at..], marks);
        match text.get(at) {
            None | Some(b'\n') => return at,
            Some(b'\\') => at += escape(&text[at..]),
            Some(_) => return at + 1,
        }
    }
}

/// A string of several lines, with its quotes, of which it may have two more before the last three.
fn long_string(text: &[u8], quote: u8) -> usize {
    let marks = if quote == b'"' { const { &bytes(b"\\\"", true) } } else { const { &bytes(b"'", true) } };
    let mut at = 3;
    loop {
        at += until(&text[at..], marks);
        match text.get(at) {
            None => return at,
            Some(b'\\') => at += escape(&text[at..]),
            Some(_) if text[at..].starts_with(&[quote; 3]) => {
                return at + 3 + text[at + 3..].iter().take(2).take_while(|&&byte| byte == quote).count();
            }
            Some(_) => at += 1,
        }
    }
}

/// A backslash with the quote or backslash behind it.
fn escape(text: &[u8]) -> usize {
    1 + usize::from(matches!(text.get(1), Some(b'"' | b'\\')))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_are_counted_as_the_parser_makes_them() {
        for (text, count) in [
            ("", 0),
            ("\u{feff}a", 1),
            ("a = 0.5\n", 8),
            ("[a.b]\r\n# [c], \"d\n\t {}", 11),
            ("'a\\'b'", 2),
            ("'a\n'", 3),
            (r#""a\"b,""c""#, 2),
            (r#""a\\"b,"#, 3),
            ("\"a\\\n,", 3),
            ("'''a'',\n'''''=", 2),
            ("\"\"\"a\\\"\"\",\"\"\"\"\"=", 2),
            ("\"\"\"a,,,", 1),
            ("a\"b,c\"", 3),
            ("é=ü", 3),
        ] {
            assert_eq!(toml_tokens(text), count, "{text}");
        }
    }

    #[test]
    fn texts_of_many_tokens_are_refused_by_number() {
        // A list, tables within tables, and signs that are no TOML.
        for (part, tokens) in [("1,", 2), ("[a.a.a]\n", 8), ("=", 1)] {
            let most = part.repeat(MAX_TOKENS / tokens);
            assert!(limit_toml_tokens("a.toml", &most).is_ok());
            let why = limit_toml_tokens("a\n.toml", &format!("{most}=")).unwrap_err().to_string();
            assert_eq!(why, "a\\n.toml: has 200001 names, values, signs and gaps; at most 200000 are read of TOML");
        }
        // What a run keeps of an experiment and of its files is one.
        assert!(limit_toml_tokens("a.toml", &format!("definition = '''{}'''", "[a]\n".repeat(MAX_TOKENS))).is_ok());
    }
}
