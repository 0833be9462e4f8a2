//! Pages for a browser.
//!
//! - `base91`: bytes as text
//! - `blocks`: its numbers as bytes
//! - `film`: an episode's data, with the format of docs/replay-format.md
//! - `html`: recordings as one file
//! - `live`: a page whose trials are run by the page itself
//! - `viewer/`: the page's markup, style and scripts

mod base91;
mod blocks;
mod film;
pub(crate) mod html;
mod live;

pub use html::{Page, readable};
pub use live::LivePage;
