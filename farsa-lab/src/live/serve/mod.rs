//! `farsa serve`: the page of a running run, for a browser on this machine.
//!
//! One thread owns all connections ([`http`](crate::live::http)). The thread of the caller builds pages and reads champions ([`publisher`]). Both
//! share the [`state`] of the directory. No thread is started after the first request.

use std::net::{Ipv4Addr, TcpListener};
use std::sync::{Arc, mpsc};
use std::thread;

use crate::error::Error;
use crate::live::http::server::Server;
use crate::live::serve::publisher::Publisher;
use crate::live::serve::site::Site;
use crate::live::serve::state::Shared;

pub(crate) use part::PagePart;
pub(crate) use publisher::Served;

/// Event stream of a listener.
mod events;
/// Parts of a page as text.
mod part;
/// Pages and champions.
mod publisher;
/// Addresses of the server.
mod site;
/// State that both threads share.
mod state;

/// Answers browsers of this machine until the process ends. The address is passed to `begun`.
///
/// Requests of other sites are refused: an external page can link to this machine, and an external name can resolve to it.
///
/// # Errors
/// [`Error::Usage`] for an unavailable port, those of `begun`, and [`Error::Io`] when the server cannot start.
pub(crate) fn serve(
    served: Served<'_, '_>,
    port: u16,
    begun: impl FnOnce(&str) -> Result<(), Error>,
) -> Result<(), Error> {
    let taken = |error| Error::Usage(format!("--port {port}: {error}"));
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(taken)?;
    let address = listener.local_addr().map_err(taken)?;
    let name = address.to_string();
    let failed = || Error::io("listen to", name.as_ref());
    let (questions, asked) = mpsc::channel();
    let shared = Arc::new(Shared::new(served.directory.clone()));
    let site = Site::new(address.port(), shared.clone(), questions);
    let server = Server::new(listener, site).map_err(failed())?;
    let thread = thread::Builder::new().name("http".into()).spawn(move || server.run()).map_err(failed())?;
    begun(&format!("http://{address}/"))?;
    Publisher::new(served, shared).answer(&asked);
    // The thread ends only by a panic, which was printed.
    let _ = thread.join();
    Err(Error::Other(format!("the server of {name} has ended")))
}
