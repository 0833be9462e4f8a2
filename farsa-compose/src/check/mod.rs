//! Text of a file, checked against the schema of the format.

/// Registered parts with the defaults of their keys.
pub(crate) mod completed;
/// Embeds the files that a text names.
pub(crate) mod embed;
/// Parts of the user's program.
pub(crate) mod registry;
/// Access to the JSON schema.
pub(crate) mod schema;
/// Values of a document as settings.
pub(crate) mod settings;
/// Text: lines of its values, names of its parts, limits.
pub(crate) mod source;
/// Reads and checks a text value by value.
pub(crate) mod walk;
