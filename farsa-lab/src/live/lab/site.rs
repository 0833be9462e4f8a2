//! Addresses of the server, and the checks that each request passes before it is answered.

use std::convert::Infallible;
use std::future::poll_fn;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;
use std::sync::mpsc::SyncSender;
use std::time::Duration;

use hyper::body::{Body as _, Bytes, Incoming};
use hyper::header::{
    CONTENT_DISPOSITION, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HeaderMap, HeaderValue, ORIGIN, REFERRER_POLICY,
    SET_COOKIE, X_FRAME_OPTIONS,
};
use hyper::{Method, Request, Response};
use tokio::sync::oneshot;
use tokio::time::timeout;

use crate::live::http::answer::Answer;
use crate::live::http::connections::Activity;
use crate::live::http::origin::{is_same_origin, parameter, response};
use crate::live::http::server::Service;
use crate::live::lab::calls::{Bench, Call, JSON, Reply, Task};
use crate::live::lab::champions::Champions;
use crate::live::lab::folder::RUNS;
use crate::live::lab::follow::{Follow, Listener};
use crate::live::lab::names::{Refusal, decoded, name};
use crate::live::lab::token::Token;
use crate::live::log_tail::LogTail;

/// Most bytes of a body: an experiment file, escaped, and the text before its changes.
const MAX_BODY: usize = 4 << 20;
/// Time in which a body arrives.
const BODY_TIME: Duration = Duration::from_secs(10);
/// Permissions of the laboratory's own page.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; \
                      connect-src 'self'; frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
/// Permissions of pages in the folder. They have no origin, so that their scripts reach neither the token nor the server.
const SANDBOX: &str = "sandbox allow-scripts allow-downloads allow-forms allow-modals allow-popups; default-src 'none'; \
                       script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; style-src 'unsafe-inline'; \
                       img-src data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'";

/// Everything that a connection needs.
#[derive(Clone)]
pub(super) struct Site {
    port: u16,
    token: Token,
    bench: Arc<Bench>,
    tasks: SyncSender<Task>,
    listeners: Arc<AtomicUsize>,
    most_listeners: usize,
}

impl Site {
    pub(super) fn new(port: u16, token: Token, bench: Arc<Bench>, tasks: SyncSender<Task>) -> Self {
        Self { port, token, bench, tasks, listeners: Arc::default(), most_listeners: 0 }
    }

    /// Checks origin and token of a request, and for a change also its page and type.
    ///
    /// # Errors
    /// [`Refusal`].
    fn allow(&self, request: &Request<Incoming>) -> Result<(), Refusal> {
        let (headers, uri) = (request.headers(), request.uri());
        if !is_same_origin(headers, uri, self.port) {
            return Err(Refusal::new(403, "only for pages of this address"));
        }
        if !self.token.is_in(headers, self.port) && !self.is_opened(request) {
            return Err(Refusal::new(403, "open the address that `lab` printed, with its token"));
        }
        match *request.method() {
            Method::POST if !headers.contains_key(ORIGIN) => {
                Err(Refusal::new(403, "a change comes from a page of this address"))
            }
            Method::POST if !is_json(headers) => Err(Refusal::new(415, "a change has a body of JSON")),
            Method::GET | Method::POST => Ok(()),
            _ => Err(Refusal::new(405, "only GET and POST")),
        }
    }

    /// Checks if a request opens the page by the printed address.
    fn is_opened(&self, request: &Request<Incoming>) -> bool {
        let given = parameter(request.uri().query().unwrap_or_default(), "token");
        request.uri().path() == "/" && given.is_some_and(|text| self.token.is(text))
    }

    /// Answers a request that was allowed by a worker.
    async fn worked(&self, call: Call) -> Reply {
        let (answer, reply) = oneshot::channel();
        if self.tasks.try_send(Task { call, answer }).is_err() {
            return Refusal::new(503, "too many requests wait").into();
        }
        reply.await.unwrap_or_else(|_| Refusal::new(500, "the request has failed").into())
    }

    /// Starts the event stream of a run.
    fn events(&self, query: &str, headers: &HeaderMap) -> Result<Follow, Refusal> {
        let run = parameter(query, "run").and_then(decoded);
        let run = run.ok_or_else(|| Refusal::invalid("the request has no run"))?;
        let folder = &self.bench.folder;
        folder.place(&[RUNS, name(&run)?])?;
        let log = folder.place(&[RUNS, &run, "fitness.csv"])?;
        let last = headers.get("last-event-id").map(|last| last.to_str().unwrap_or("?"));
        let from = last.or_else(|| parameter(query, "from")).and_then(|from| from.parse().ok());
        let from = from.ok_or_else(|| Refusal::invalid("from is a number of generations"))?;
        let listener = Listener::new(&self.listeners, self.most_listeners);
        let listener = listener.ok_or_else(|| Refusal::new(503, "too many pages are open"))?;
        let champions = Champions::new(self.tasks.clone());
        Ok(Follow::new(listener, self.bench.clone(), &run, LogTail::new(log, from), champions))
    }

    async fn reply(&self, request: Request<Incoming>) -> Result<Reply, Refusal> {
        self.allow(&request)?;
        let (parts, body) = request.into_parts();
        let path = parts.uri.path().to_owned();
        if parts.method == Method::POST {
            let body = timeout(BODY_TIME, collected(body));
            let body = body.await.map_err(|_| Refusal::new(408, "the body has not arrived in time"))??;
            return Ok(self.worked(Call::Post { path, body }).await);
        }
        if let Some(asset) = Bench::asset(&path) {
            return Ok(asset);
        }
        let query = parts.uri.query().unwrap_or_default().to_owned();
        Ok(self.worked(Call::Get { path, query }).await)
    }
}

impl Service for Site {
    fn limit(&mut self, connections: usize) {
        self.most_listeners = connections / 2;
    }

    async fn answer(self, request: Request<Incoming>, activity: Arc<Activity>) -> Result<Response<Answer>, Infallible> {
        activity.waits();
        let path = request.uri().path().to_owned();
        if path == "/events" && request.method() == Method::GET && self.allow(&request).is_ok() {
            let query = request.uri().query().unwrap_or_default();
            if let Ok(events) = self.events(query, request.headers()) {
                return Ok(response(200, "text/event-stream", Answer::events(events, activity)));
            }
        }
        let is_opened = self.is_opened(&request);
        let reply = match self.reply(request).await {
            Ok(reply) => reply,
            // A person sees the refusal of the page itself.
            Err(refusal) if path == "/" => {
                Reply { status: refusal.status, kind: "text/plain; charset=utf-8", content: refusal.why.into() }
            }
            Err(refusal) => refusal.into(),
        };
        let Reply { status, kind, content } = reply;
        let mut response = response(status, kind, Answer::text(content, activity));
        let headers = response.headers_mut();
        let is_of_folder = path.starts_with("/files/") || kind.starts_with("image/");
        let policy = if is_of_folder { SANDBOX } else { POLICY };
        headers.insert(CONTENT_SECURITY_POLICY, HeaderValue::from_static(policy));
        if is_of_folder {
            headers.insert(X_FRAME_OPTIONS, HeaderValue::from_static("SAMEORIGIN"));
        }
        headers.insert(REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
        if kind == "application/octet-stream" {
            headers.insert(CONTENT_DISPOSITION, HeaderValue::from_static("attachment"));
        }
        if is_opened
            && status == 200
            && let Ok(cookie) = HeaderValue::from_str(&self.token.cookie(self.port))
        {
            headers.insert(SET_COOKIE, cookie);
        }
        Ok(response)
    }
}

/// Checks if the body of a request is JSON, which no form of another site sends.
fn is_json(headers: &HeaderMap) -> bool {
    let kind = headers.get(CONTENT_TYPE).and_then(|kind| kind.to_str().ok()).unwrap_or_default();
    kind.split(';').next().unwrap_or_default().trim() == JSON
}

/// Reads a body up to its limit.
///
/// # Errors
/// [`Refusal`].
async fn collected(mut body: Incoming) -> Result<Bytes, Refusal> {
    let mut bytes = Vec::new();
    while let Some(frame) = poll_fn(|context| Pin::new(&mut body).poll_frame(context)).await {
        let frame = frame.map_err(|error| Refusal::invalid(format!("the body: {error}")))?;
        let Ok(data) = frame.into_data() else { continue };
        if bytes.len() + data.len() > MAX_BODY {
            return Err(Refusal::new(413, format!("the body has more than {MAX_BODY} bytes")));
        }
        bytes.extend_from_slice(&data);
    }
    Ok(bytes.into())
}
