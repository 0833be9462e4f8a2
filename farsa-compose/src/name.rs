//! Names in a file.

/// Pattern of names, the only one of the schema.
pub(crate) const NAME: &str = "^[a-z0-9][a-z0-9_-]{0,39}$";

/// Returns true for a text that may be a part of the key of a setting.
pub(crate) fn is_part_of_key(text: &str) -> bool {
    let bare = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
    text.split('.').all(|part| !part.is_empty() && part.chars().all(bare))
}

/// Returns true for a valid name.
pub(crate) fn is_name(text: &str) -> bool {
    let inner = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
    (1..=40).contains(&text.len()) && text.chars().all(inner) && !text.starts_with(['-', '_'])
}
