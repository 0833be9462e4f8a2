//! XML, in and out.

/// A look at a text before it is parsed: what is too large or too deep gets no further.
pub(crate) mod check;
/// A tree as one text, with changes.
pub(crate) mod merge;
/// A model's elements as a tree, and how to ask them for names and numbers.
pub(crate) mod tree;
/// Nested lines, numbers and names.
pub(crate) mod write;
