//! Pages for a browser.
//!
//! - `blocks`: its numbers as bytes
//! - `html`: recordings as one file, with the format of docs/replay-format.md
//! - `viewer/`: the page's markup, style and scripts

mod blocks;
pub(crate) mod html;

pub use html::{Page, readable};
