//! Listener and runtime of the server.

use std::convert::Infallible;
use std::future::Future;
use std::io;
use std::net::TcpListener;
use std::sync::Arc;
use std::time::{Duration, Instant};

use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Request, Response};
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::net::TcpStream;
use tokio::runtime::{Builder, Runtime};
use tokio::task::JoinHandle;
use tokio::time::{sleep, timeout};

use crate::live::http::answer::Answer;
use crate::live::http::connections::{Activity, Connections};

/// Most connections, where the limit on open files allows them.
const MOST: usize = 256;
/// Open files that the program itself needs, with those of new connections.
const OWN_FILES: usize = 24;
/// Most bytes and lines of the head of a request.
const HEAD_BYTES: usize = 16 << 10;
const HEAD_LINES: usize = 64;
/// Time of the head of a request.
const HEAD_TIME: Duration = Duration::from_secs(10);
/// Interval at which connections without progress are closed.
const SWEEP: Duration = Duration::from_secs(1);
/// Pause after the system has refused a connection, as when no file can be opened.
const PAUSE: Duration = Duration::from_millis(50);

/// Addresses that a server answers.
pub(in crate::live) trait Service: Clone + Send + 'static {
    /// Sets the most open connections.
    fn limit(&mut self, connections: usize);

    /// Answers a request.
    fn answer(
        self,
        request: Request<Incoming>,
        activity: Arc<Activity>,
    ) -> impl Future<Output = Result<Response<Answer>, Infallible>> + Send;
}

/// A listener with the runtime of its connections, on one thread.
pub(in crate::live) struct Server<S> {
    runtime: Runtime,
    listener: tokio::net::TcpListener,
    site: S,
}

impl<S: Service> Server<S> {
    /// Prepares the server. Connections are opened by [`run`](Self::run).
    pub(in crate::live) fn new(listener: TcpListener, site: S) -> io::Result<Self> {
        listener.set_nonblocking(true)?;
        let runtime = Builder::new_current_thread().enable_io().enable_time().build()?;
        let listener = runtime.block_on(async { tokio::net::TcpListener::from_std(listener) })?;
        Ok(Self { runtime, listener, site })
    }

    /// Answers requests until the process ends.
    pub(in crate::live) fn run(self) {
        let Self { runtime, listener, site } = self;
        runtime.block_on(accept(listener, site));
    }
}

/// Opens connections. If there are too many, the oldest idle one is closed.
async fn accept<S: Service>(listener: tokio::net::TcpListener, mut site: S) {
    let most = most_connections(open_files());
    site.limit(most);
    let mut connections = Connections::new(most);
    loop {
        let accepted = timeout(SWEEP, listener.accept()).await;
        let has_room = connections.sweep(Instant::now());
        match accepted {
            Ok(Ok((stream, _))) => {
                if !has_room {
                    connections.close_oldest();
                }
                connections.open(|activity| spawn(stream, site.clone(), activity));
                // Closed connections free their files here.
                tokio::task::yield_now().await;
            }
            Ok(Err(error)) if is_of_client(&error) => {}
            // Files or memory of the system have run out.
            Ok(Err(_)) => {
                connections.close_oldest();
                sleep(PAUSE).await;
            }
            // No client has connected.
            Err(_) => {}
        }
    }
}

/// Starts the task of a connection, which answers one request.
fn spawn<S: Service>(stream: TcpStream, site: S, activity: Arc<Activity>) -> JoinHandle<()> {
    tokio::spawn(async move {
        // Without it, an event may wait for the confirmation of the previous one.
        let _ = stream.set_nodelay(true);
        let service = service_fn(move |request| site.clone().answer(request, activity.clone()));
        let mut server = http1::Builder::new();
        server.keep_alive(false).max_buf_size(HEAD_BYTES).max_headers(HEAD_LINES);
        server.timer(TokioTimer::new()).header_read_timeout(HEAD_TIME);
        // The browser may close the connection at any time.
        let _ = server.serve_connection(TokioIo::new(stream), service).await;
    })
}

/// Returns true for an error of one client, after which the next can be accepted.
fn is_of_client(error: &io::Error) -> bool {
    use io::ErrorKind::{ConnectionAborted, ConnectionRefused, ConnectionReset, Interrupted};
    matches!(error.kind(), ConnectionAborted | ConnectionRefused | ConnectionReset | Interrupted)
}

/// Computes the number of connections from the limit on open files.
fn most_connections(files: Option<u64>) -> usize {
    let files = files.and_then(|files| usize::try_from(files).ok()).unwrap_or(usize::MAX);
    files.saturating_sub(OWN_FILES).clamp(2, MOST)
}

/// Returns the limit on open files of this process, if there is one.
fn open_files() -> Option<u64> {
    #[cfg(unix)]
    return rustix::process::getrlimit(rustix::process::Resource::Nofile).current;
    #[cfg(not(unix))]
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_limit_connections() {
        let most = [Some(64), Some(1024), Some(10), None].map(most_connections);
        assert_eq!(most, [40, 256, 2, 256]);
        #[cfg(target_os = "linux")]
        {
            let limits = std::fs::read_to_string("/proc/self/limits").unwrap();
            let line = limits.lines().find_map(|line| line.strip_prefix("Max open files")).unwrap();
            assert_eq!(line.split_whitespace().next().and_then(|soft| soft.parse().ok()), open_files());
        }
    }
}
