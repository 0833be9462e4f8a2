//! An agent in memory, without files and threads: what a page in a browser runs by itself.
//!
//! - `page`: `farsa live`: a page that runs an agent by itself
//! - `script`: what a page carries of a run
//! - `session`: the agent that a script describes, and its trials
//! - `request`: what is asked of a session and what it answers, as JSON
//! - `digest`: a number for what a trial was like up to each step

mod digest;
#[cfg(feature = "command")]
pub(crate) mod page;
mod request;
pub(crate) mod script;
mod session;

pub use session::LiveSession;
