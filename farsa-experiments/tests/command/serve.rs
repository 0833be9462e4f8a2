//! The page of a run in progress, as a browser requests it.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, ChildStdout, Stdio};
use std::time::Duration;

use serde_json::Value;

use crate::tool::{command, farsa, ok, say, scratch};

/// A server that ends with the test.
struct Server {
    process: Child,
    port: u16,
    _said: BufReader<ChildStdout>,
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Server {
    fn start(here: &Path, run: &str) -> Self {
        let mut start = command(farsa(), here, &["serve", run, "--port", "0", "--json"]);
        let mut process = start.stdout(Stdio::piped()).spawn().expect("a server");
        let mut said = BufReader::new(process.stdout.take().expect("its output"));
        let mut text = String::new();
        while !text.ends_with("}\n") {
            assert!(said.read_line(&mut text).expect("a line") > 0, "it ended: {text}");
        }
        let told: Value = serde_json::from_str(&text).expect("JSON");
        let address = told["address"].as_str().expect("an address");
        let port = address.strip_prefix("http://127.0.0.1:").and_then(|rest| rest.strip_suffix('/'));
        Self { process, port: port.and_then(|port| port.parse().ok()).expect("a port"), _said: said }
    }

    /// Sends a request with these lines behind its first.
    fn ask(&self, first: &str, lines: &[String]) -> BufReader<TcpStream> {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("a connection");
        stream.set_read_timeout(Some(Duration::from_secs(60))).expect("a time");
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
        "X-Frame-Options: DENY",
        "Cache-Control: no-store",
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
    // As many listen at once as there are pages that one opens, and then no more.
    let mut listening = Vec::new();
    for _ in 0..64 {
        let mut stream = server.ask("GET /events?from=0", std::slice::from_ref(&host));
        assert_eq!(event(&mut stream, "fitness")[0][0], 0);
        listening.push(stream);
    }
    let (code, text) = server.answer("GET /", std::slice::from_ref(&host));
    assert!(code == 503 && text.ends_with("too many pages are open"), "{text}");
    drop(listening);
    let said = say(farsa(), &here, &format!("serve r --port {}", server.port));
    assert!(said.code == Some(2) && said.err.contains("--port"), "{said:?}");
    let said = say(farsa(), &here, "serve nowhere");
    assert!(said.code != Some(0) && said.err.contains("there is no such directory"), "{said:?}");
}
