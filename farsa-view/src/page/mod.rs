//! Pages for a browser. The markup, style and scripts are in `viewer/`.

/// Numbers of an episode as bytes.
mod blocks;
/// Data of an episode, in the format of docs/replay-format.md.
mod episode_data;
/// Recorded episodes as one HTML file.
pub(crate) mod html;
/// The page of `farsa lab`.
mod lab;
/// An interactive page that runs an agent.
mod live;

pub use html::{Page, readable};
pub use lab::LabPage;
pub use live::LivePage;
