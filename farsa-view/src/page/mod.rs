//! Pages for a browser.
//!
//! - `blocks`: its numbers as bytes
//! - `film`: an episode's data, with the format of docs/replay-format.md
//! - `html`: recordings as one file
//! - `viewer/`: the page's markup, style and scripts

mod blocks;
mod film;
pub(crate) mod html;

pub use html::{Page, readable};
