//! Addresses of the server: `/`, the page, and `/events`, its event stream.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::mpsc::Sender;

use hyper::body::{Bytes, Incoming};
use hyper::header::{
    CACHE_CONTROL, CONTENT_TYPE, HOST, HeaderMap, HeaderName, HeaderValue, ORIGIN, X_CONTENT_TYPE_OPTIONS,
    X_FRAME_OPTIONS,
};
use hyper::{Method, Request, Response, StatusCode, Uri};
use tokio::sync::oneshot;

use crate::live::serve::answer::Answer;
use crate::live::serve::connections::Activity;
use crate::live::serve::events::Events;
use crate::live::serve::state::{Listener, Question, Shared, Unavailable};

/// Everything that an answer needs.
#[derive(Clone)]
pub(super) struct Site {
    port: u16,
    shared: Arc<Shared>,
    questions: Sender<Question>,
    /// Most concurrent event streams.
    pub(super) most_listeners: usize,
}

/// Text of an answer, with its status and type.
struct Text {
    status: u16,
    kind: &'static str,
    content: Bytes,
}

impl Text {
    fn refused(status: u16, why: &'static str) -> Self {
        Self { status, kind: "text/plain; charset=utf-8", content: Bytes::from_static(why.as_bytes()) }
    }
}

impl Site {
    pub(super) fn new(port: u16, shared: Arc<Shared>, questions: Sender<Question>) -> Self {
        Self { port, shared, questions, most_listeners: 0 }
    }

    /// Answers a request. Its body is not read.
    pub(super) async fn answer(
        self,
        request: Request<Incoming>,
        activity: Arc<Activity>,
    ) -> Result<Response<Answer>, Infallible> {
        activity.waits();
        let (parts, _) = request.into_parts();
        let path = parts.uri.path();
        let answer = match (&parts.method, path) {
            _ if !is_same_origin(&parts.headers, &parts.uri, self.port) => {
                Err(Text::refused(403, "only for pages of this address"))
            }
            (&Method::GET, "/") => Err(self.page().await),
            (&Method::GET, "/events") => self.events(&parts.headers, parts.uri.query().unwrap_or_default()).await,
            (&Method::GET, _) => Err(Text::refused(404, "no such page")),
            _ => Err(Text::refused(405, "only GET")),
        };
        Ok(match answer {
            Ok(events) => response(200, "text/event-stream", Answer::events(events, activity)),
            Err(Text { status, kind, content }) => response(status, kind, Answer::text(content, activity)),
        })
    }

    /// Returns the current page of the run, or a page with the reason for its absence.
    async fn page(&self) -> Text {
        let (answer, page) = oneshot::channel();
        let ended = || Unavailable { status: 500, why: "The server is ending.".into() };
        let page = match self.questions.send(Question::Page(answer)) {
            Ok(()) => page.await.unwrap_or_else(|_| Err(ended())),
            Err(_) => Err(ended()),
        };
        let (status, content) = match page {
            Ok(html) => (200, html),
            Err(Unavailable { status, why }) => (status, waiting(&why).into()),
        };
        Text { status, kind: "text/html; charset=utf-8", content }
    }

    /// Starts an event stream. The page names its run, so that it receives no rows of another.
    async fn events(&self, headers: &HeaderMap, query: &str) -> Result<Events, Text> {
        let Some(generations) = after(headers, query) else {
            return Err(Text::refused(400, "from is a number of generations"));
        };
        let Some(listener) = Listener::new(self.shared.clone(), self.most_listeners) else {
            return Err(Text::refused(503, "too many pages are open"));
        };
        // The first event holds the champions.
        let (answer, updated) = oneshot::channel();
        if self.questions.send(Question::Champions(answer)).is_ok() {
            let _ = updated.await;
        }
        let current = || self.shared.current().run.map(|run| run.name.clone());
        let Some(run) = parameter(query, "run").map(str::to_owned).or_else(current) else {
            return Err(Text::refused(503, "the directory holds no run"));
        };
        Ok(Events::new(listener, run, generations))
    }
}

/// Checks if a request names this address and comes from its own page or from no page.
///
/// Images of external pages are requested without an origin, but with `Sec-Fetch-Site`. External pages may link to the page,
/// but not to the events, which would stay open as long as the window.
fn is_same_origin(headers: &HeaderMap, uri: &Uri, port: u16) -> bool {
    // Browsers omit the default port.
    let is_here = |host: &str| {
        ["127.0.0.1", "localhost"].into_iter().any(|name| match host.strip_prefix(name) {
            Some("") => port == 80,
            Some(rest) => rest.strip_prefix(':') == Some(&port.to_string()),
            None => false,
        })
    };
    let mut hosts = headers.get_all(HOST).iter().map(|host| host.to_str().unwrap_or_default());
    let (Some(host), None) = (hosts.next(), hosts.next()) else { return false };
    let header = |name: &str| headers.get(name).map(|value| value.to_str().unwrap_or("?"));
    let from_here = |origin: &str| origin.strip_prefix("http://") == Some(host);
    let is_same_site = |site| site == "same-origin" || site == "none";
    let is_linked = uri.path() == "/" && header("sec-fetch-dest") == Some("document");
    let is_allowed = is_linked || header("sec-fetch-site").is_none_or(is_same_site);
    // A request to a proxy has the address in its first line.
    let is_direct = uri.authority().is_none_or(|authority| is_here(authority.as_str()));
    is_here(host) && is_direct && header(ORIGIN.as_str()).is_none_or(from_here) && is_allowed
}

/// Finds the number of generations that a listener has received, from its last event or from the address.
fn after(headers: &HeaderMap, query: &str) -> Option<usize> {
    match headers.get("last-event-id") {
        Some(last) => last.to_str().ok()?.parse().ok(),
        None => parameter(query, "from")?.parse().ok(),
    }
}

/// Returns the value of a parameter of an address.
fn parameter<'q>(query: &'q str, name: &str) -> Option<&'q str> {
    query.split('&').find_map(|pair| pair.strip_prefix(name)?.strip_prefix('='))
}

/// Builds an answer, which no other site may show or keep.
fn response(status: u16, kind: &'static str, body: Answer) -> Response<Answer> {
    let mut response = Response::new(body);
    *response.status_mut() = StatusCode::from_u16(status).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
    let policy = HeaderName::from_static("cross-origin-resource-policy");
    for (name, value) in [
        (CONTENT_TYPE, kind),
        (CACHE_CONTROL, "no-store"),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (X_FRAME_OPTIONS, "DENY"),
        (policy, "same-origin"),
    ] {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    response
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_this_machine_are_here() {
        let same = |port: u16, uri: &str, host: &str| {
            let headers = HeaderMap::from_iter([(HOST, HeaderValue::from_str(host).unwrap())]);
            is_same_origin(&headers, &uri.parse().unwrap(), port)
        };
        assert!(same(8377, "/", "127.0.0.1:8377") && same(8377, "http://localhost:8377/", "localhost:8377"));
        assert!(same(80, "/", "127.0.0.1") && same(80, "/", "localhost"));
        for (uri, host) in [
            ("/", "127.0.0.1"),
            ("/", "127.0.0.1:83770"),
            ("/", "127.0.0.1.example.org:8377"),
            ("/", "localhost:8378"),
            ("/", ""),
            ("http://example.org/", "127.0.0.1:8377"),
        ] {
            assert!(!same(8377, uri, host), "{uri} {host}");
        }
        assert_eq!((parameter("run=a&from=3", "from"), parameter("fromage=3", "from")), (Some("3"), None));
    }
}
