//! Addresses of the server: `/`, the page, and `/events`, its event stream.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::mpsc::Sender;

use hyper::body::{Bytes, Incoming};
use hyper::header::HeaderMap;
use hyper::{Method, Request, Response};
use tokio::sync::oneshot;

use crate::live::http::answer::{Answer, absence};
use crate::live::http::connections::Activity;
use crate::live::http::origin::{is_same_origin, parameter, response};
use crate::live::http::server::Service;
use crate::live::serve::events::Events;
use crate::live::serve::state::{Listener, Question, Shared, Unavailable};

/// Everything that an answer needs.
#[derive(Clone)]
pub(super) struct Site {
    port: u16,
    shared: Arc<Shared>,
    questions: Sender<Question>,
    /// Most concurrent event streams.
    most_listeners: usize,
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
            Err(Unavailable { status, why }) => (status, absence(&why, 1).into()),
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

impl Service for Site {
    fn limit(&mut self, connections: usize) {
        self.most_listeners = connections / 2;
    }

    /// Answers a request. Its body is not read.
    async fn answer(self, request: Request<Incoming>, activity: Arc<Activity>) -> Result<Response<Answer>, Infallible> {
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
}

/// Finds the number of generations that a listener has received, from its last event or from the address.
fn after(headers: &HeaderMap, query: &str) -> Option<usize> {
    match headers.get("last-event-id") {
        Some(last) => last.to_str().ok()?.parse().ok(),
        None => parameter(query, "from")?.parse().ok(),
    }
}
