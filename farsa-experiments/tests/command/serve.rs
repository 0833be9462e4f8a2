//! The page of a run in progress, as a browser requests it.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use serde_json::Value;

use crate::tool::{Announced, command, farsa, ok, say, scratch};

/// A server that ends with the test.
struct Server {
    program: Announced,
    port: u16,
}

impl Server {
    fn start(here: &Path, run: &str) -> Self {
        Self::spawn(&mut command(farsa(), here, &["serve", run, "--port", "0", "--json"]))
    }

    /// Starts a server with a limit of the shell.
    #[cfg(unix)]
    fn limited(here: &Path, limit: &str, run: &str) -> Self {
        let line = format!("ulimit {limit}; exec \"$0\" serve {run} --port 0 --json");
        let arguments = [std::ffi::OsStr::new("-c"), line.as_ref(), farsa().as_os_str()];
        Self::spawn(&mut command(Path::new("sh"), here, &arguments))
    }

    fn spawn(start: &mut Command) -> Self {
        let program = Announced::start(start);
        let port = program.address.strip_prefix("http://127.0.0.1:").and_then(|rest| rest.strip_suffix('/'));
        let port = port.and_then(|port| port.parse().ok()).expect("a port");
        Self { program, port }
    }

    /// Opens a connection whose reads and writes end in time.
    fn connect(&self) -> std::io::Result<TcpStream> {
        let stream = TcpStream::connect_timeout(&([127, 0, 0, 1], self.port).into(), Duration::from_secs(60))?;
        stream.set_read_timeout(Some(Duration::from_secs(60)))?;
        stream.set_write_timeout(Some(Duration::from_secs(60)))?;
        Ok(stream)
    }

    /// Checks that the page is answered.
    fn gives_its_page(&self) {
        let (code, page) = self.answer("GET /", &[self.host()]);
        assert!(
            code == 200 && page.trim_end().ends_with("</html>"),
            "{code}: {}",
            page.chars().take(300).collect::<String>()
        );
    }

    /// Checks that no more than 50 MB of memory were in use at any time.
    #[cfg(target_os = "linux")]
    fn is_small(&self) {
        let peak = crate::memory::peak(self.program.id()).expect("its memory");
        assert!(peak < 50_000, "{peak} kB");
    }

    /// Sends a request with these lines behind its first.
    fn ask(&self, first: &str, lines: &[String]) -> BufReader<TcpStream> {
        let mut stream = self.connect().expect("a connection");
        write!(stream, "{first} HTTP/1.1\r\n{}\r\n", lines.concat()).expect("a request");
        BufReader::new(stream)
    }

    fn host(&self) -> String {
        format!("Host: 127.0.0.1:{}\r\n", self.port)
    }

    /// The code and the whole answer.
    fn answer(&self, first: &str, lines: &[String]) -> (u16, String) {
        let lines: Vec<String> = lines.iter().cloned().chain(["Connection: close\r\n".to_owned()]).collect();
        let mut bytes = Vec::new();
        self.ask(first, &lines).read_to_end(&mut bytes).expect("an answer");
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let code = text.split(' ').nth(1).and_then(|code| code.parse().ok()).expect("a code");
        (code, text)
    }
}

/// The data of the next event of this name.
fn event(stream: &mut BufReader<TcpStream>, name: &str) -> Value {
    let (mut line, mut found) = (String::new(), false);
    loop {
        line.clear();
        assert!(stream.read_line(&mut line).expect("a line") > 0, "the stream ended");
        if let Some(of) = line.strip_prefix("event: ") {
            found = of.trim_end() == name;
        }
        if let Some(data) = line.strip_prefix("data: ").filter(|_| found) {
            return serde_json::from_str(data).expect("JSON");
        }
    }
}

#[test]
fn a_page_is_served_while_its_run_goes_on() {
    let here = scratch("serve");
    let line = "predator-prey --population 4 --set evolution.parents=2 --set trial.steps=40";
    ok(farsa(), &here, &format!("run {line} --generations 3 --out r --quiet"));
    let server = Server::start(&here, "r");
    let (code, page) = server.answer("GET /", &[server.host()]);
    assert_eq!(code, 200);
    for part in [
        "connect-src 'self'",
        "x-frame-options: DENY",
        "cache-control: no-store",
        "the run continues in its own process",
    ] {
        assert!(page.contains(part), "{part}");
    }

    let mut stream = server.ask("GET /events?from=2", &[server.host()]);
    assert_eq!(event(&mut stream, "champions")[0]["generation"], 2);
    assert_eq!(event(&mut stream, "fitness")[0][0], 2);
    ok(farsa(), &here, "run --resume r --generations 6 --quiet");
    let mut known = 2;
    while known < 5 {
        for row in event(&mut stream, "fitness").as_array().expect("rows") {
            known += 1;
            assert_eq!(row[0], known);
        }
    }
    // The best that come are those of both populations, the first the one that a page made now would have.
    let mut best = Value::Null;
    while best[0]["generation"] != 5 {
        best = event(&mut server.ask("GET /events?from=6", &[server.host()]), "champions");
    }
    let individuals: Vec<u64> = (0..2).map(|number| best[number]["individual"].as_u64().expect("a number")).collect();
    assert!(individuals[0] < 4 && (4..8).contains(&individuals[1]), "{individuals:?}");
    assert_eq!(best.as_array().map(Vec::len), Some(2));
    let (_, page) = server.answer("GET /", &[server.host()]);
    let (_, data) = page.rsplit_once("id=\"data\">").expect("the data");
    let data: Value = serde_json::from_str(data.split_once("</script>").expect("their end").0).expect("JSON");
    assert_eq!(data["live"]["script"]["individuals"][0], best[0]);
    assert_eq!((&data["live"]["served"], &data["live"]["standing"]), (&true.into(), &Value::Null));
    // A client that lost the connection gets the later events.
    let mut stream = server.ask("GET /events?from=0", &[server.host(), "Last-Event-ID: 4\r\n".into()]);
    assert_eq!(event(&mut stream, "fitness")[0][0], 4);
}

#[test]
fn only_pages_of_this_address_are_answered() {
    let here = scratch("serve-refuses");
    ok(farsa(), &here, "run double-pole --population 10 --set evolution.parents=2 --generations 1 --out r --quiet");
    let server = Server::start(&here, "r");
    let host = server.host();
    let own = format!("Origin: http://127.0.0.1:{}\r\n", server.port);
    let named = format!("Host: localhost:{}\r\n", server.port);
    // The headers of a browser about the requesting page.
    let site = |of: &str, what: &str| format!("Sec-Fetch-Site: {of}\r\nSec-Fetch-Dest: {what}\r\n");
    for (first, lines, expected) in [
        ("GET /", vec![host.clone(), own], 200),
        ("GET /?a=b", vec![named.clone()], 200),
        ("GET /", vec![host.clone(), "Origin: https://example.org\r\n".into()], 403),
        ("GET /events?from=0", vec![host.clone(), "Origin: null\r\n".into()], 403),
        ("GET /", vec![host.clone(), site("none", "document")], 200),
        ("GET /", vec![host.clone(), site("same-origin", "empty")], 200),
        ("GET /", vec![host.clone(), site("cross-site", "document")], 200),
        ("GET /?from=0", vec![host.clone(), site("cross-site", "document")], 200),
        ("GET /events?from=0", vec![host.clone(), site("cross-site", "document")], 403),
        ("GET /", vec![host.clone(), site("cross-site", "image")], 403),
        ("GET /events?from=0", vec![host.clone(), site("same-site", "script")], 403),
        ("GET /", vec!["Host: example.org\r\n".into()], 403),
        ("GET /", vec!["Host: 127.0.0.1\r\n".into()], 403),
        ("GET /", vec![], 403),
        ("GET /../../etc/passwd", vec![host.clone()], 404),
        ("GET /config.toml", vec![host.clone()], 404),
        ("POST /", vec![host.clone(), "Content-Length: 0\r\n".into()], 405),
        ("GET /events", vec![host.clone()], 400),
        ("GET /events?from=-1", vec![host.clone()], 400),
    ] {
        let (code, text) = server.answer(first, &lines);
        assert_eq!(code, expected, "{first} {lines:?}: {}", text.chars().take(300).collect::<String>());
    }
    let said = say(farsa(), &here, &format!("serve r --port {}", server.port));
    assert!(said.code == Some(2) && said.err.contains("--port"), "{said:?}");
    let said = say(farsa(), &here, "serve nowhere");
    assert!(said.code != Some(0) && said.err.contains("there is no such directory"), "{said:?}");
}

#[test]
fn the_run_that_replaces_another_has_its_own_events_and_page() {
    let here = scratch("serve-replaced");
    let run = "run double-pole --population 10 --set evolution.parents=2 --quiet";
    ok(farsa(), &here, &format!("{run} --generations 2 --out r"));
    let server = Server::start(&here, "r");
    let data = || {
        let (code, page) = server.answer("GET /", &[server.host()]);
        assert_eq!(code, 200);
        let (_, data) = page.rsplit_once("id=\"data\">").expect("the data");
        serde_json::from_str::<Value>(data.split_once("</script>").expect("their end").0).expect("JSON")
    };
    let first = data();
    let name = first["live"]["about"]["run"].as_str().expect("a name");
    let address = format!("GET /events?run={name}&from=0");
    let mut stream = server.ask(&address, &[server.host()]);
    assert_eq!(event(&mut stream, "fitness").as_array().map(Vec::len), Some(2));
    // A longer run is the same run.
    ok(farsa(), &here, "run --resume r --generations 3 --quiet");
    assert_eq!(event(&mut stream, "fitness")[0][0], 2);
    assert_eq!(data()["live"]["about"]["run"], name);

    ok(farsa(), &here, &format!("{run} --generations 9 --seed 2 --force --out r"));
    let mut rest = String::new();
    stream.read_to_string(&mut rest).expect("its end");
    assert!(rest.contains("event: replaced\ndata: {}\n\n"), "{rest}");
    assert!(!rest.contains("event: fitness"), "{rest}");
    // The page of the first run learns it also when it connects again.
    let mut stream = server.ask(&address, &[server.host(), "Last-Event-ID: 3\r\n".into()]);
    assert_eq!(event(&mut stream, "replaced"), serde_json::json!({}));
    let second = data();
    assert!(second["title"].as_str().is_some_and(|title| title.ends_with("-2")), "{}", second["title"]);
    let address = format!("GET /events?run={}&from=0", second["live"]["about"]["run"].as_str().expect("a name"));
    let rows = event(&mut server.ask(&address, &[server.host()]), "fitness");
    assert_eq!(rows.as_array().map(Vec::len), Some(9));

    // Without a run, the page has the reason and loads itself again.
    std::fs::rename(here.join("r"), here.join("away")).expect("the run");
    let (code, page) = server.answer("GET /", &[server.host()]);
    assert!(code == 503 && page.contains("there is no such directory") && page.contains("refresh"), "{page}");
    std::fs::rename(here.join("away"), here.join("r")).expect("the run");
    server.gives_its_page();
}

#[cfg(target_os = "linux")]
#[test]
fn hostile_clients_leave_room_for_a_page() {
    let here = scratch("serve-hostile");
    ok(farsa(), &here, "run double-pole --population 10 --set evolution.parents=2 --generations 1 --out r --quiet");
    let server = Server::limited(&here, "-n 64", "r");
    server.gives_its_page();

    // A body that no memory holds, with a foreign host and with the own one.
    for host in ["Host: x\r\n".to_owned(), server.host()] {
        let (code, _) = server.answer("GET /", &[host, "Content-Length: 99999999999999\r\n".into()]);
        assert!(code == 403 || code == 200, "{code}");
    }

    // A head without an end. The server closes the connection long before.
    let mut head = server.connect().expect("a connection");
    let part = [b'a'; 1 << 14];
    let mut sent = head.write_all(b"GET / HTTP/1.1\r\nX: ");
    for _ in 0..(256 << 20) / part.len() {
        sent = sent.and_then(|()| head.write_all(&part));
    }
    assert!(sent.is_err(), "256 MB were taken");
    server.gives_its_page();

    // Idle connections, more than the server can open. Where this process cannot open a hundred, it opens what it can.
    let mut idle = Vec::new();
    let mut failed = None;
    while idle.len() < 100 && failed.is_none() {
        match server.connect() {
            Ok(stream) => idle.push(stream),
            Err(error) => failed = Some(error),
        }
    }
    if let Some(error) = failed {
        println!("{} idle connections instead of 100: {error}", idle.len());
        idle.truncate(idle.len().saturating_sub(8));
    }
    server.gives_its_page();

    // Clients that send slowly, and clients that do not read.
    idle.truncate(10);
    for number in 0..20 {
        let mut slow = server.connect().expect("a connection");
        let request = format!("GET / HTTP/1.1\r\n{}\r\n", server.host());
        slow.write_all(if number < 10 { b"GET / HT" } else { request.as_bytes() }).expect("a request");
        idle.push(slow);
        server.gives_its_page();
    }
    server.is_small();
}

#[cfg(unix)]
#[test]
fn listeners_leave_room_for_pages() {
    let here = scratch("serve-listeners");
    ok(farsa(), &here, "run double-pole --population 10 --set evolution.parents=2 --generations 1 --out r --quiet");
    // With 48 files there are 24 connections, and half of them may listen.
    let server = Server::limited(&here, "-n 48", "r");
    let host = server.host();
    let mut listening = Vec::new();
    for _ in 0..12 {
        let mut stream = server.ask("GET /events?from=0", std::slice::from_ref(&host));
        assert_eq!(event(&mut stream, "fitness")[0][0], 0);
        listening.push(stream);
    }
    let (code, text) = server.answer("GET /events?from=0", std::slice::from_ref(&host));
    assert!(code == 503 && text.ends_with("too many pages are open"), "{text}");
    server.gives_its_page();
    // A closed page makes room for another.
    drop(listening);
    for _ in 0..600 {
        let mut line = String::new();
        server.ask("GET /events?from=0", std::slice::from_ref(&host)).read_line(&mut line).expect("a line");
        if line.contains(" 200 ") {
            return;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    panic!("no room after all listeners have left");
}

/// The memory of 400 MB has no room for a thread of each connection.
#[cfg(target_os = "linux")]
#[test]
fn no_thread_is_started_for_a_client() {
    let here = scratch("serve-threads");
    ok(farsa(), &here, "run double-pole --population 10 --set evolution.parents=2 --generations 1 --out r --quiet");
    let server = Server::limited(&here, "-v 400000", "r");
    let idle: Vec<_> = (0..30).map(|_| server.connect().expect("a connection")).collect();
    server.gives_its_page();
    let threads = std::fs::read_dir(format!("/proc/{}/task", server.program.id())).expect("its threads").count();
    assert!(threads <= 2, "{threads}");
    drop(idle);
}
