//! A text against the schema of the format.
//!
//! - `places`: where in the text each value stands
//! - `embed`: files that a text names, put into the text
//! - `schema`: what a schema says of one value
//! - `walk`: a text, checked value by value
//! - `settings`: the numbers and words of a document as settings

pub(crate) mod embed;
pub(crate) mod places;
pub(crate) mod schema;
pub(crate) mod settings;
pub(crate) mod walk;
