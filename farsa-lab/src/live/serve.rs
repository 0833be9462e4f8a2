//! `farsa serve`: the page of a run that goes on, for a browser on this machine.

use std::io::{self, Write};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use serde::Serialize;
use tiny_http::{Header, Method, Request, Response, Server, StatusCode};

use crate::error::Error;
use crate::live::news::Known;
use crate::live::page::{self, Use};
use crate::live::session::json;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::store::directory::Directory;

/// How often a run is looked at.
const LOOK: Duration = Duration::from_millis(500);
/// After so many looks without news a word is said, so that a browser that has gone is noticed.
const SILENT: u32 = 20;
/// Most requests that are answered at once: a page that is open is one.
const MOST_AT_ONCE: usize = 64;

/// What is served.
#[derive(Clone, Copy)]
pub(crate) struct Served<'s> {
    pub(crate) laboratory: &'s Laboratory<'s>,
    pub(crate) plan: &'s Plan<'s>,
    pub(crate) directory: &'s Directory,
    pub(crate) module: &'s [u8],
}

/// Answers browsers of this machine until the process ends; `begun` hears the address.
///
/// Only what is asked of this address by its own page is answered: a page from elsewhere can name this machine, and a name from
/// elsewhere can stand for it.
///
/// # Errors
/// [`Error::Usage`] for a port that cannot be had, those of `begun`, and [`Error::Other`] when nobody can be heard any more.
pub(crate) fn serve(served: Served<'_>, port: u16, begun: impl FnOnce(&str) -> Result<(), Error>) -> Result<(), Error> {
    let taken = |error| Error::Usage(format!("--port {port}: {error}"));
    let server = Server::http((Ipv4Addr::LOCALHOST, port)).map_err(taken)?;
    let address = server.server_addr().to_ip().ok_or_else(|| Error::Other("no address".into()))?;
    begun(&format!("http://{address}/"))?;
    let running = &AtomicUsize::new(0);
    thread::scope(|scope| {
        loop {
            let request = server.recv().map_err(Error::io("hear", address.to_string().as_ref()))?;
            if running.fetch_add(1, Ordering::Relaxed) >= MOST_AT_ONCE {
                running.fetch_sub(1, Ordering::Relaxed);
                // Whether the answer arrives is the browser's business.
                let _ = respond(request, 503, "text/plain", "too many pages are open");
                continue;
            }
            // Who does not read its answer keeps nobody else waiting.
            let begun = Begun(running);
            // A thread that cannot be started is one that ends.
            let _ = thread::Builder::new().spawn_scoped(scope, move || {
                let _begun = begun;
                served.answer(request, address);
            });
        }
    })
}

/// A request that is being answered, counted until its thread ends, however it does.
struct Begun<'c>(&'c AtomicUsize);

impl Drop for Begun<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Served<'_> {
    /// Answers a request. Whether the answer arrives is the browser's business.
    fn answer(self, request: Request, address: SocketAddr) {
        let url = request.url().to_owned();
        let path = url.split('?').next().unwrap_or_default();
        let refused = |request: Request, code: u16, why: &str| respond(request, code, "text/plain", why);
        let _ = match (request.method(), path) {
            _ if !is_own(&request, path, address) => refused(request, 403, "only for pages of this address"),
            (Method::Get, "/") => match self.page() {
                Ok(html) => respond(request, 200, "text/html", &html),
                Err((code, why)) => respond(request, code, "text/html", &waiting(&why)),
            },
            (Method::Get, "/events") => match after(&request, &url) {
                Some(generations) => self.tell(request, generations),
                None => refused(request, 400, "from is a number of generations"),
            },
            (Method::Get, _) => refused(request, 404, "there is no such page"),
            _ => refused(request, 405, "only GET"),
        };
    }

    /// The page of the run as it is now, or why there is none and with which code that is said.
    fn page(&self) -> Result<String, (u16, String)> {
        if !self.directory.champion().is_file() {
            return Err((503, "No generation is finished yet.".into()));
        }
        let found = page::html(self.laboratory, (self.plan, self.directory), &[], self.module, Use::Served);
        found.map(|found| found.html).map_err(|error| (500, error.to_string()))
    }

    /// Tells a browser what the run comes to, as long as it listens.
    fn tell(&self, request: Request, generations: usize) -> io::Result<()> {
        let mut to = request.into_writer();
        let head = "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\n\
                    X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n";
        to.write_all(head.as_bytes())?;
        to.flush()?;
        let (mut known, mut silent) = (Known::first(generations), 0);
        loop {
            // What is being written at this moment is there at the next look.
            let mut news = false;
            if let Ok(Some(best)) = known.champions(self.plan, self.directory) {
                event(&mut to, "champions", None, &best)?;
                news = true;
            }
            match known.rows(self.directory) {
                Ok(rows) if !rows.is_empty() => {
                    let next = rows.last().map(|row| row.0 + 1);
                    event(&mut to, "fitness", next, &rows)?;
                    news = true;
                }
                _ => {}
            }
            silent = if news { 0 } else { silent + 1 };
            if silent == SILENT {
                silent = 0;
                to.write_all(b":\n\n")?;
                to.flush()?;
            }
            thread::sleep(LOOK);
        }
    }
}

/// Writes an event of a stream; with its number a browser asks for what comes after it when the connection was lost.
fn event(to: &mut impl Write, name: &str, number: Option<usize>, data: &impl Serialize) -> io::Result<()> {
    let number = number.map_or_else(String::new, |number| format!("id: {number}\n"));
    let data = json(data).map_err(io::Error::other)?;
    write!(to, "event: {name}\n{number}data: {data}\n\n")?;
    to.flush()
}

/// Whether a request is for this address by its own name, and from its own page or from none. A page from elsewhere that asks for a
/// picture has no origin; browsers tell its site. It may link to the page, and not to the events, which last as long as its window.
fn is_own(request: &Request, path: &str, address: SocketAddr) -> bool {
    let port = address.port();
    // A browser leaves out the port that is usual.
    let usual = |name: &str| (port == 80).then(|| name.to_owned());
    let names = ["127.0.0.1", "localhost"];
    let mut own = names.iter().flat_map(|name| [Some(format!("{name}:{port}")), usual(name)]).flatten();
    let header = |name: &'static str| {
        request.headers().iter().find(|header| header.field.equiv(name)).map(|header| header.value.as_str())
    };
    let host = header("Host").unwrap_or_default();
    let from_here = |origin: &str| origin.strip_prefix("http://") == Some(host);
    let is_ours = |site| site == "same-origin" || site == "none";
    let is_linked = path == "/" && header("Sec-Fetch-Dest") == Some("document");
    let is_asked = is_linked || header("Sec-Fetch-Site").is_none_or(is_ours);
    own.any(|name| name == host) && header("Origin").is_none_or(from_here) && is_asked
}

/// How many generations a listener knows: since it lost the connection, or as its page says.
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

/// A page that says why there is none yet, and asks again.
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
