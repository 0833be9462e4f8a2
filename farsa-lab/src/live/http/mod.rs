//! Servers for browsers on this machine: listener, connections with limits, and answers.
//!
//! One thread owns all connections of a server, and its [`Service`](server::Service) answers them.

/// Body of an answer.
pub(super) mod answer;
/// Open connections and their limits.
pub(super) mod connections;
/// Origin of a request, and headers of an answer.
pub(super) mod origin;
/// Events at intervals.
pub(super) mod paced;
/// Listener and runtime.
pub(super) mod server;
