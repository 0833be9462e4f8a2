//! Names in requests: one part of a path, a key or a word, each checked before it is used.

use std::fmt::Display;

use serde::Serialize;

use crate::run::laboratory::FILE;

/// Longest name [bytes].
const MAX_NAME: usize = 120;
/// Longest value of a setting [bytes].
const MAX_VALUE: usize = 10_000;

/// Reason why a request is refused, and its HTTP status.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(super) struct Refusal {
    #[serde(skip)]
    pub(super) status: u16,
    #[serde(rename = "error")]
    pub(super) why: String,
}

impl Refusal {
    pub(super) fn new(status: u16, why: impl Display) -> Self {
        Self { status, why: why.to_string() }
    }

    /// Refuses an invalid part of a request.
    pub(super) fn invalid(why: impl Display) -> Self {
        Self::new(400, why)
    }

    /// Refuses a change that contradicts the state of the folder.
    pub(super) fn conflict(why: impl Display) -> Self {
        Self::new(409, why)
    }
}

/// Checks the name of a run or a file: a single part of a path that is no option, not hidden and valid on every system.
///
/// # Errors
/// [`Refusal`] with status 400.
pub(super) fn name(text: &str) -> Result<&str, Refusal> {
    let is_allowed = |letter: char| !letter.is_control() && !"/\\:*?\"<>|".contains(letter);
    let begins = text.starts_with(|first: char| first.is_alphanumeric() || first == '_');
    let is_valid = begins
        && text.len() <= MAX_NAME
        && text.chars().all(is_allowed)
        && !text.contains("..")
        && !text.ends_with(['.', ' ']);
    let why = || {
        let shown: String = text.chars().take(40).collect();
        format!("{shown:?} is no name: use letters, digits, hyphens and periods, at most {MAX_NAME}")
    };
    is_valid.then_some(text).ok_or_else(|| Refusal::invalid(why()))
}

/// Checks the name of an experiment file.
///
/// # Errors
/// [`Refusal`] with status 400.
pub(super) fn file_name(text: &str) -> Result<&str, Refusal> {
    match name(text)?.strip_suffix(FILE) {
        Some(stem) if !stem.is_empty() => Ok(text),
        _ => Err(Refusal::invalid(format!("{text:?} is no experiment file: its name ends with .toml"))),
    }
}

/// Checks the key of a setting.
///
/// # Errors
/// [`Refusal`] with status 400.
pub(super) fn key(text: &str) -> Result<&str, Refusal> {
    let is_allowed = |letter: char| letter.is_ascii_alphanumeric() || "._-".contains(letter);
    let is_valid = text.starts_with(|first: char| first.is_ascii_alphanumeric()) && text.chars().all(is_allowed);
    let is_valid = is_valid && text.len() <= MAX_NAME;
    is_valid.then_some(text).ok_or_else(|| Refusal::invalid("a key of a setting has other characters"))
}

/// Checks the value of a setting. A value may name a file, which has to be in the folder.
///
/// # Errors
/// [`Refusal`] with status 400.
pub(super) fn value(text: &str) -> Result<&str, Refusal> {
    if text.len() > MAX_VALUE || text.chars().any(char::is_control) {
        return Err(Refusal::invalid("a value has control characters or is too long"));
    }
    let bare = text.trim().trim_matches(['"', '\'']);
    let is_drive = bare.get(1..2) == Some(":");
    let is_outside = bare.starts_with(['/', '~']) || bare.contains("..") || bare.contains('\\') || is_drive;
    if is_outside {
        return Err(Refusal::invalid(format!("{text:?}: files of a setting are in the folder of the laboratory")));
    }
    Ok(text)
}

/// Decodes the value of a parameter of an address.
pub(super) fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let digits = [rest.next()?, rest.next()?];
                u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?
            }
            b'+' => b' ',
            other => other,
        });
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_single_parts_of_paths() {
        for valid in ["follow", "follow-far-1", "a.b", "Läufe 2", "_x", "7"] {
            assert_eq!(name(valid), Ok(valid));
        }
        let long = "a".repeat(121);
        for wrong in [
            "", ".", "..", ".hidden", "-o", "a/b", "a\\b", "a..b", "/etc", "C:x", "a\0b", "a\nb", "a.", "a ", "a*",
            &long,
        ] {
            assert_eq!(name(wrong).unwrap_err().status, 400, "{wrong}");
        }
        assert!(file_name("a.toml").is_ok() && file_name("a").is_err() && file_name(".toml").is_err());
    }

    #[test]
    fn values_stay_in_the_folder() {
        for valid in ["1", "-0.5", "[1, 2]", "\"two-tap\"", "tables/a.txt", "true"] {
            assert_eq!(value(valid), Ok(valid));
        }
        for wrong in ["/etc/passwd", "\"/etc/passwd\"", "../a", "a/../../b", "~/a", "C:\\a", "C:a", "a\nb"] {
            assert!(value(wrong).is_err(), "{wrong}");
        }
        assert!(key("evolution.mutation_rate").is_ok());
        for wrong in ["", "-x", "a b", "a=b", "--out"] {
            assert!(key(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn parameters_are_decoded_once() {
        assert_eq!(decoded("a%2Fb+c").as_deref(), Some("a/b c"));
        assert_eq!(decoded("%252e").as_deref(), Some("%2e"));
        for wrong in ["%", "%2", "%zz", "%ff"] {
            assert_eq!(decoded(wrong), None, "{wrong}");
        }
    }
}
