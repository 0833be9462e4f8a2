//! Pages for a browser.
//!
//! - `html`: recordings as one file, with the format of docs/replay-format.md
//! - `viewer/`: the page's markup, style and scripts

pub(crate) mod html;

pub use html::{Page, readable};
