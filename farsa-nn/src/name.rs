//! Comparison of names without regard to case and hyphens.

/// Compares two names, ignoring case and hyphens.
pub(crate) fn same_letters(name: &str, other: &str) -> bool {
    let plain = |b: &u8| *b != b'-';
    let lower = |b: u8| b.to_ascii_lowercase();
    name.bytes().filter(plain).map(lower).eq(other.bytes().filter(plain).map(lower))
}
