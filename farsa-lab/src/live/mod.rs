//! An agent in memory, without files and threads: what a page in a browser runs by itself.
//!
//! - `page`: `farsa live`: a page that runs an agent by itself
//! - `serve`: `farsa serve`: the page of a run that goes on
//! - `news`: what a run that goes on has come to
//! - `row`: the fitness of a generation for the viewer
//! - `champion`: the best individual of a run
//! - `script`: what a page carries of a run
//! - `session`: the agent that a script describes, and its trials
//! - `request`: what is asked of a session and what it answers, as JSON
//! - `evolution`: a search that goes on, shared by sessions
//! - `hands`: what is done to the bodies of a trial
//! - `standing`: where a run stands
//! - `bytes`: bytes in JSON
//! - `digest`: a number for what a trial was like up to each step

mod bytes;
#[cfg(feature = "command")]
mod champion;
mod digest;
mod evolution;
mod hands;
#[cfg(feature = "command")]
mod news;
#[cfg(feature = "command")]
pub(crate) mod page;
mod request;
#[cfg(feature = "command")]
mod row;
pub(crate) mod script;
#[cfg(feature = "command")]
pub(crate) mod serve;
mod session;
mod standing;

pub use session::LiveSession;
