//! Text of a file, checked against the schema of the format.

/// Embeds the files that a text names.
pub(crate) mod embed;
/// Access to the JSON schema.
pub(crate) mod schema;
/// Values of a document as settings.
pub(crate) mod settings;
/// Text: lines of its values, names of its parts, limits.
pub(crate) mod source;
/// Reads and checks a text value by value.
pub(crate) mod walk;
