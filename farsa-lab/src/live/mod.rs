//! An agent in memory, without files and threads, for pages that run it in a browser.

/// Bytes as text in JSON.
mod bytes;
/// Best individual of a run.
#[cfg(feature = "command")]
mod champion;
/// A hash of an episode after each step.
mod digest;
/// A search continued in memory, shared by sessions.
mod evolution;
/// Servers for browsers on this machine.
#[cfg(feature = "command")]
mod http;
/// `farsa lab`: a laboratory in the browser.
#[cfg(feature = "command")]
pub(crate) mod lab;
/// Log of fitness, read in parts while it grows.
#[cfg(feature = "command")]
mod log_tail;
/// Programs as modules of pages.
mod module;
/// `farsa live`: an interactive page that runs an agent.
#[cfg(feature = "command")]
pub(crate) mod page;
/// Part of a run that a page carries.
pub(crate) mod page_run;
/// Requests to a session and their answers, as JSON.
mod request;
/// Fitness of a generation.
#[cfg(feature = "command")]
mod row;
/// Marks by which a run is recognized.
#[cfg(feature = "command")]
mod run_mark;
/// State of a search, from which it continues.
pub(crate) mod run_state;
/// Run that a page has saved.
#[cfg(feature = "command")]
pub(crate) mod saved_run;
/// `farsa serve`: the page of a running run.
#[cfg(feature = "command")]
pub(crate) mod serve;
/// Agent of a page and its episodes.
mod session;

pub use module::LiveModule;
pub use session::LiveSession;
