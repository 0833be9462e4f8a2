//! `farsa serve`: the page of a running run, for a browser on this machine.

use std::io::{self, Write};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use serde::Serialize;
use tiny_http::{Header, Method, Request, Response, Server, StatusCode};

use crate::error::Error;
use crate::live::page::{self, Use};
use crate::live::session::json;
use crate::live::updates::SeenState;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::store::directory::Directory;

/// Interval at which the files of a run are checked.
const INTERVAL: Duration = Duration::from_millis(500);
/// Intervals without an event after which a comment is sent, which detects closed connections.
const KEEP_ALIVE: u32 = 20;
/// Most concurrent requests. Each open page is one.
const MAX_CONCURRENT: usize = 64;

/// A run and the module for its page.
#[derive(Clone, Copy)]
pub(crate) struct Served<'s> {
    pub(crate) laboratory: &'s Laboratory<'s>,
    pub(crate) plan: &'s Plan<'s>,
    pub(crate) directory: &'s Directory,
    pub(crate) module: &'s [u8],
}

/// Answers browsers of this machine until the process ends. The address is passed to `begun`.
///
/// Requests of other sites are refused: an external page can link to this machine, and an external name can resolve to it.
///
/// # Errors
/// [`Error::Usage`] for an unavailable port, those of `begun`, and [`Error::Io`] when the connection is lost.
pub(crate) fn serve(served: Served<'_>, port: u16, begun: impl FnOnce(&str) -> Result<(), Error>) -> Result<(), Error> {
    let taken = |error| Error::Usage(format!("--port {port}: {error}"));
    let server = Server::http((Ipv4Addr::LOCALHOST, port)).map_err(taken)?;
    let address = server.server_addr().to_ip().ok_or_else(|| Error::Other("no address".into()))?;
    begun(&format!("http://{address}/"))?;
    let running = &AtomicUsize::new(0);
    thread::scope(|scope| {
        loop {
            let request = server.recv().map_err(Error::io("listen to", address.to_string().as_ref()))?;
            if running.fetch_add(1, Ordering::Relaxed) >= MAX_CONCURRENT {
                running.fetch_sub(1, Ordering::Relaxed);
                // The browser may already have closed the connection.
                let _ = respond(request, 503, "text/plain", "too many pages are open");
                continue;
            }
            // A slow reader does not delay others.
            let active = Active(running);
            // If the thread cannot be started, the closure and its count are dropped.
            let _ = thread::Builder::new().spawn_scoped(scope, move || {
                let _active = active;
                served.answer(request, address);
            });
        }
    })
}

/// A request that is counted until its thread ends, even by a panic.
struct Active<'c>(&'c AtomicUsize);

impl Drop for Active<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Served<'_> {
    /// Answers a request. Errors of the connection are ignored.
    fn answer(self, request: Request, address: SocketAddr) {
        let url = request.url().to_owned();
        let path = url.split('?').next().unwrap_or_default();
        let refused = |request: Request, code: u16, why: &str| respond(request, code, "text/plain", why);
        let _ = match (request.method(), path) {
            _ if !is_same_origin(&request, path, address) => refused(request, 403, "only for pages of this address"),
            (Method::Get, "/") => match self.page() {
                Ok(html) => respond(request, 200, "text/html", &html),
                Err((code, why)) => respond(request, code, "text/html", &waiting(&why)),
            },
            (Method::Get, "/events") => match after(&request, &url) {
                Some(generations) => self.stream(request, generations),
                None => refused(request, 400, "from is a number of generations"),
            },
            (Method::Get, _) => refused(request, 404, "no such page"),
            _ => refused(request, 405, "only GET"),
        };
    }

    /// Returns the current page of the run, or an HTTP status and the reason.
    fn page(&self) -> Result<String, (u16, String)> {
        if !self.directory.champion().is_file() {
            return Err((503, "No generation is finished yet.".into()));
        }
        let page = page::html(self.laboratory, (self.plan, self.directory), &[], self.module, Use::Served);
        page.map(|page| page.html).map_err(|error| (500, error.to_string()))
    }

    /// Sends new generations and champions as server-sent events, as long as the connection is open.
    fn stream(&self, request: Request, generations: usize) -> io::Result<()> {
        let mut to = request.into_writer();
        let head = "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\n\
                    X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n";
        to.write_all(head.as_bytes())?;
        to.flush()?;
        let (mut seen, mut silent) = (SeenState::first(generations), 0);
        loop {
            // A file that is being written is read in the next interval.
            let mut sent = false;
            if let Ok(Some(best)) = seen.champions(self.plan, self.directory) {
                event(&mut to, "champions", None, &best)?;
                sent = true;
            }
            match seen.rows(self.directory) {
                Ok(rows) if !rows.is_empty() => {
                    let next = rows.last().map(|row| row.0 + 1);
                    event(&mut to, "fitness", next, &rows)?;
                    sent = true;
                }
                _ => {}
            }
            silent = if sent { 0 } else { silent + 1 };
            if silent == KEEP_ALIVE {
                silent = 0;
                to.write_all(b":\n\n")?;
                to.flush()?;
            }
            thread::sleep(INTERVAL);
        }
    }
}

/// Writes an event of a stream. After a lost connection a browser sends the number of the last event.
fn event(to: &mut impl Write, name: &str, number: Option<usize>, data: &impl Serialize) -> io::Result<()> {
    let number = number.map_or_else(String::new, |number| format!("id: {number}\n"));
    let data = json(data).map_err(io::Error::other)?;
    write!(to, "event: {name}\n{number}data: {data}\n\n")?;
    to.flush()
}

/// Checks if a request names this address and comes from its own page or from no page.
///
/// Images of external pages are requested without an origin, but with `Sec-Fetch-Site`. External pages may link to the page,
/// but not to the events, which would stay open as long as the window.
fn is_same_origin(request: &Request, path: &str, address: SocketAddr) -> bool {
    let port = address.port();
    // Browsers omit the default port.
    let default = |name: &str| (port == 80).then(|| name.to_owned());
    let names = ["127.0.0.1", "localhost"];
    let mut hosts = names.iter().flat_map(|name| [Some(format!("{name}:{port}")), default(name)]).flatten();
    let header = |name: &'static str| {
        request.headers().iter().find(|header| header.field.equiv(name)).map(|header| header.value.as_str())
    };
    let host = header("Host").unwrap_or_default();
    let from_here = |origin: &str| origin.strip_prefix("http://") == Some(host);
    let is_same_site = |site| site == "same-origin" || site == "none";
    let is_linked = path == "/" && header("Sec-Fetch-Dest") == Some("document");
    let is_allowed = is_linked || header("Sec-Fetch-Site").is_none_or(is_same_site);
    hosts.any(|name| name == host) && header("Origin").is_none_or(from_here) && is_allowed
}

/// Finds the number of generations that a listener has received, from its last event or from the address.
fn after(request: &Request, url: &str) -> Option<usize> {
    let last = request.headers().iter().find(|header| header.field.equiv("Last-Event-ID"));
    match last {
        Some(last) => last.value.as_str().parse().ok(),
        None => url.split_once("?from=")?.1.parse().ok(),
    }
}

/// Answers with a text.
fn respond(request: Request, code: u16, kind: &str, text: &str) -> io::Result<()> {
    let mut response =
        Response::from_string(text).with_status_code(StatusCode(code)).with_chunked_threshold(usize::MAX);
    for (name, value) in [
        ("Content-Type", format!("{kind}; charset=utf-8").as_str()),
        ("Cache-Control", "no-store"),
        ("X-Content-Type-Options", "nosniff"),
        ("X-Frame-Options", "DENY"),
        ("Cross-Origin-Resource-Policy", "same-origin"),
    ] {
        if let Ok(header) = Header::from_bytes(name, value) {
            response.add_header(header);
        }
    }
    request.respond(response)
}

/// Returns a page with the reason, which reloads itself.
fn waiting(why: &str) -> String {
    let page = maud::html! {
        (maud::DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="refresh" content="1";
                title { "farsa serve" }
            }
            body { p { (why) } }
        }
    };
    page.into_string()
}
