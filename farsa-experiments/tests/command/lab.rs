//! The laboratory in the browser, as its page uses it and as other pages and programs try to.

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::live::{asked, data, evolving};
use crate::saved_page::saved_run;
use crate::tool::{Announced, command, content, farsa, ok, results, say, scratch};

/// A server that ends with the test. Its runs do not.
pub(crate) struct Lab {
    _program: Announced,
    port: u16,
    pub(crate) token: String,
}

impl Lab {
    pub(crate) fn start(here: &Path, options: &[&str]) -> Self {
        let words = [&["lab", "--port", "0", "--json"], options].concat();
        let mut start = command(farsa(), here, &words);
        let program = Announced::start(&mut start);
        let rest = program.address.strip_prefix("http://127.0.0.1:").expect("this machine");
        let (port, token) = rest.split_once("/?token=").expect("a token");
        assert_eq!(token.len(), 32);
        let (port, token) = (port.parse().expect("a port"), token.into());
        Self { _program: program, port, token }
    }

    pub(crate) fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).expect("a connection");
        stream.set_read_timeout(Some(Duration::from_secs(60))).expect("a limit");
        stream
    }

    /// Sends bytes and returns the code and the text of the answer, 0 without one.
    pub(crate) fn raw(&self, bytes: &[u8]) -> (u16, String) {
        let mut stream = self.connect();
        // The server may close the connection before it has read everything.
        let _ = stream.write_all(bytes);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        let text = String::from_utf8_lossy(&answer).into_owned();
        (text.split(' ').nth(1).and_then(|code| code.parse().ok()).unwrap_or(0), text)
    }

    pub(crate) fn head(first: &str, lines: &[String], body: &str) -> Vec<u8> {
        let length = if body.is_empty() { String::new() } else { format!("Content-Length: {}\r\n", body.len()) };
        format!("{first} HTTP/1.1\r\n{}{length}\r\n{body}", lines.concat()).into_bytes()
    }

    pub(crate) fn host(&self) -> String {
        format!("Host: 127.0.0.1:{}\r\n", self.port)
    }

    pub(crate) fn origin(&self) -> String {
        format!("Origin: http://127.0.0.1:{}\r\n", self.port)
    }

    pub(crate) fn secret(&self) -> String {
        format!("X-Farsa-Token: {}\r\n", self.token)
    }

    pub(crate) fn get(&self, path: &str) -> (u16, String) {
        let (code, text) = self.raw(&Self::head(&format!("GET {path}"), &[self.host(), self.secret()], ""));
        (code, text.split_once("\r\n\r\n").map(|(_, body)| body.to_owned()).unwrap_or_default())
    }

    pub(crate) fn data(&self, path: &str) -> Value {
        let (code, text) = self.get(path);
        assert_eq!(code, 200, "{path}: {text}");
        serde_json::from_str(&text).expect("JSON")
    }

    pub(crate) fn post(&self, path: &str, body: &Value) -> (u16, Value) {
        let lines = [self.host(), self.secret(), self.origin(), "Content-Type: application/json\r\n".into()];
        let (code, text) = self.raw(&Self::head(&format!("POST {path}"), &lines, &body.to_string()));
        let body = text.split_once("\r\n\r\n").map(|(_, body)| body).unwrap_or_default();
        (code, serde_json::from_str(body).unwrap_or(Value::Null))
    }

    pub(crate) fn done(&self, path: &str, body: &Value) -> Value {
        let (code, answer) = self.post(path, body);
        assert_eq!(code, 200, "{path}: {answer}");
        answer
    }

    /// The facts of a run once they have this state.
    fn until(&self, run: &str, state: &str) -> Value {
        let end = Instant::now() + Duration::from_secs(300);
        loop {
            let facts = self.data(&format!("/api/run?name={run}"))["facts"].clone();
            if facts["state"] == state {
                return facts;
            }
            assert!(Instant::now() < end && (facts["state"] != "failed" || state == "failed"), "not {state}: {facts}");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Waits for a number of generations, as the page of a run does.
    fn follow(&self, run: &str, generations: u64) {
        let lines = [self.host(), self.secret()];
        let mut stream = self.connect();
        stream.write_all(&Self::head(&format!("GET /events?run={run}&from=0"), &lines, "")).expect("a request");
        let (mut next, mut is_fitness) = (0, false);
        for line in BufReader::new(stream).lines() {
            let line = line.expect("a line");
            if let Some(name) = line.strip_prefix("event: ") {
                is_fitness = name == "fitness";
            }
            let Some(rows) = line.strip_prefix("data: ").filter(|_| is_fitness) else { continue };
            for row in serde_json::from_str::<Value>(rows).expect("JSON").as_array().expect("rows") {
                assert_eq!(row[0], next);
                next += 1;
            }
            if next >= generations {
                return;
            }
        }
        panic!("the stream ended after {next} generations");
    }
}

/// A short experiment of the first template.
fn shortened(text: &str) -> String {
    let text = text.replace("steps = 400, trials = 8", "steps = 30, trials = 2");
    assert!(text.contains("steps = 30"), "{text}");
    text
}

#[cfg(unix)]
#[test]
fn an_experiment_is_made_run_stopped_resumed_and_tested() {
    let here = scratch("lab");
    let lab = Lab::start(&here, &[]);
    let list = lab.data("/api/list");
    assert_eq!((&list["runs"], &list["files"], &list["read_only"]), (&json!([]), &json!([]), &json!(false)));
    assert!(list["experiments"].as_array().is_some_and(|all| all.iter().any(|one| one["name"] == "double-pole")));

    let template = &list["templates"][0]["name"];
    assert_eq!(lab.done("/api/new", &json!({ "name": "follow", "template": template }))["name"], "follow.toml");
    let (code, again) = lab.post("/api/new", &json!({ "name": "follow", "template": template }));
    assert!(code == 422 && again["error"].as_str().is_some_and(|why| why.contains("follow.toml")), "{again}");
    let text = lab.data("/api/file?name=follow.toml")["text"].as_str().expect("a text").to_owned();
    let short = shortened(&text);
    let broken = short.replace("kind = \"e-puck\"", "kind = \"e-pukc\"");
    let (code, answer) = lab.post("/api/check", &json!({ "name": "follow.toml", "text": broken }));
    let why = answer["error"].as_str().expect("an error");
    assert!(code == 422 && why.contains("follow.toml line ") && why.contains("`e-puck`"), "{answer}");
    assert_eq!(lab.done("/api/check", &json!({ "name": "follow.toml", "text": short }))["experiment"], "follow");
    let save =
        |before: &str| lab.post("/api/save", &json!({ "name": "follow.toml", "text": short, "before": before })).0;
    assert_eq!((save("another text"), save(&text), save(&text)), (409, 200, 409));
    assert_eq!(fs::read_to_string(here.join("follow.toml")).expect("the file"), short);

    let info = lab.data("/api/info?experiment=follow.toml");
    let settings = info["settings"].as_array().expect("settings");
    let population = settings.iter().find(|one| one["key"] == "evolution.population").expect("a setting");
    assert_eq!((&population["kind"], &population["range"]), (&json!("whole"), &json!([1.0, 1_000_000.0])));
    assert!(lab.get("/api/graph?experiment=follow.toml").1.starts_with("<svg"));

    let changed =
        json!([["evolution.population", "4"], ["evolution.parents", "2"], ["evolution.mutation", "\"flip\""]]);
    let request = json!({ "experiment": "follow.toml", "seeds": [1], "generations": 3000, "settings": changed });
    let answer = lab.done("/api/run", &request);
    assert_eq!(answer["runs"], json!(["follow-1"]));
    let line = answer["commands"][0].as_str().expect("a line").to_owned();
    lab.follow("follow-1", 3);
    lab.done("/api/stop", &json!({ "run": "follow-1" }));
    let facts = lab.until("follow-1", "stopped");
    assert!(facts["done"].as_u64().is_some_and(|done| (3..3000).contains(&done)), "{facts}");
    let resumed = lab.done("/api/resume", &json!({ "run": "follow-1" }));
    assert_eq!(resumed["commands"][0], "farsa run --resume runs/follow-1");
    assert_eq!(lab.until("follow-1", "finished")["done"], 3000);
    lab.done("/api/resume", &json!({ "run": "follow-1", "generations": 3010 }));
    assert_eq!(lab.until("follow-1", "finished")["done"], 3010);
    lab.done("/api/test", &json!({ "run": "follow-1", "trials": 20 }));
    lab.until("follow-1", "finished");
    let run = lab.data("/api/run?name=follow-1");
    assert_eq!((&run["test"]["trials"], &run["facts"]["success"]["of"]), (&json!(20), &json!(20)));
    let list = lab.data("/api/list");
    assert_eq!((&list["runs"][0]["name"], &list["files"][0]["name"]), (&json!("follow-1"), &json!("follow.toml")));

    // The settings of a run may contradict each other, which its process finds.
    let wrong = json!({ "experiment": "follow.toml", "seeds": [5], "settings": [["evolution.parents", "7"]] });
    lab.done("/api/run", &wrong);
    let facts = lab.until("follow-5", "failed");
    assert!(facts["error"].as_str().is_some_and(|why| why.contains("evolution.population")), "{facts}");
    assert!(!here.join("runs/follow-5").exists());

    // The same command by hand gives the same bytes, without an interruption.
    let other = scratch("lab-by-hand");
    fs::copy(here.join("follow.toml"), other.join("follow.toml")).expect("a copy");
    let line = line.strip_prefix("farsa ").expect("the program").replace("3000", "3010").replace(['\'', '"'], "");
    ok(farsa(), &other, &line);
    assert_eq!(results(&here.join("runs/follow-1")), results(&other.join("runs/follow-1")));
    pages_exports_and_trash(&lab, &here);
}

/// Keeps what an interactive page has made, under new names.
#[cfg(unix)]
fn keep(lab: &Lab, here: &Path) {
    for (kind, expected) in [
        ("configuration", "exports/follow-1.toml"),
        ("script", "exports/follow-1.sh"),
        ("genotype", "exports/follow-1-3.gen"),
    ] {
        let answer = lab.done("/api/keep", &json!({ "kind": kind, "run": "follow-1", "text": kind }));
        assert_eq!(answer["file"], expected);
        assert_eq!(fs::read_to_string(here.join(expected)).expect("a text"), kind);
    }
    // The run of its page, which has evolved nothing more.
    let live = &data(&here.join("pages/live-follow-1.html"))["live"];
    let saved = saved_run(live, &asked(&mut evolving(live), &json!({ "do": "state" })));
    let request = json!({ "kind": "run", "run": "follow-1", "text": saved.to_string() });
    let answer = lab.done("/api/keep", &request);
    assert_eq!((&answer["file"], &answer["run"]), (&json!("exports/follow-1.run.json"), &json!("follow-1.2")));
    assert_eq!(answer["command"], "farsa run --from exports/follow-1.run.json --out runs/follow-1.2");
    assert_eq!(lab.until("follow-1.2", "finished")["done"], 3010);
    assert_eq!(results(&here.join("runs/follow-1.2")), results(&here.join("runs/follow-1")));
    // Another state is an error of the run.
    let other = saved.to_string().replace("\"state_crc32\":", "\"state_crc32\":1");
    let answer = lab.done("/api/keep", &json!({ "kind": "run", "run": "follow-1", "text": other }));
    assert_eq!(answer["run"], "follow-1.3");
    let error = lab.until("follow-1.3", "failed")["error"].to_string();
    assert!(error.contains("the state after 3010 generations differs"), "{error}");
    for (wrong, code) in [
        (json!({ "kind": "script", "run": "follow-9", "text": "" }), 404),
        (json!({ "kind": "script", "run": "../follow-1", "text": "" }), 400),
        (json!({ "kind": "page", "run": "follow-1", "text": "" }), 400),
        (json!({ "kind": "script", "run": "follow-1", "text": "", "file": "a" }), 400),
    ] {
        let (found, answer) = lab.post("/api/keep", &wrong);
        assert_eq!(found, code, "{wrong}: {answer}");
    }
}

/// Writes pages and exports of a finished run, and moves it away.
#[cfg(unix)]
fn pages_exports_and_trash(lab: &Lab, here: &Path) {
    for kind in ["report", "replay", "live"] {
        let answer = lab.done("/api/page", &json!({ "kind": kind, "runs": ["follow-1"] }));
        let file = answer["file"].as_str().expect("a file");
        let (code, page) = lab.raw(&Lab::head(&format!("GET /files/{file}"), &[lab.host(), lab.secret()], ""));
        let head = page.split("\r\n\r\n").next().unwrap_or_default();
        assert!(code == 200 && head.contains("sandbox allow-scripts") && page.contains("</html>"), "{kind}: {head}");
        assert!(!head.contains("allow-same-origin"));
    }
    for (number, expected) in [(1, "exports/follow-1.gen"), (2, "exports/follow-1-2.gen")] {
        let answer = lab.done("/api/export", &json!({ "run": "follow-1", "format": "genotype" }));
        assert_eq!(answer["file"], expected, "{number}");
        assert!(here.join(expected).is_file());
    }
    keep(lab, here);
    let run = lab.data("/api/run?name=follow-1");
    assert_eq!(run["pages"].as_array().map(Vec::len), Some(3), "{run}");
    assert_eq!(run["exports"].as_array().map(Vec::len), Some(7), "{run}");
    let before = content(&here.join("runs/follow-1"));
    assert_eq!(lab.done("/api/trash", &json!({ "run": "follow-1" }))["moved"], ".trash/follow-1");
    for run in ["follow-1.2", "follow-1.3"] {
        lab.done("/api/trash", &json!({ "run": run }));
    }
    assert_eq!(lab.data("/api/list")["runs"], json!([]));
    assert_eq!(content(&here.join(".trash/follow-1")).len(), before.len());
    lab.done("/api/trash", &json!({ "file": "follow.toml" }));
    assert!(here.join(".trash/follow.toml").is_file() && !here.join("follow.toml").exists());
}

/// With one process at a time the second run waits, and both outlast the server.
#[cfg(unix)]
#[test]
fn runs_wait_and_outlast_the_server() {
    let here = scratch("lab-queue");
    let lab = Lab::start(&here, &["--jobs", "1"]);
    let request = json!({ "experiment": "double-pole", "condition": "velocities", "seeds": [1, 2], "generations": 1000000,
        "settings": [["evolution.population", "4"], ["evolution.parents", "2"]] });
    let answer = lab.done("/api/run", &request);
    assert_eq!(answer["runs"], json!(["double-pole-velocities-1", "double-pole-velocities-2"]));
    lab.follow("double-pole-velocities-1", 2);
    assert_eq!(lab.until("double-pole-velocities-2", "waiting")["done"], 0);
    // The same seed has another name, and a second process of the run is refused.
    let (code, _) = lab.post("/api/resume", &json!({ "run": "double-pole-velocities-1" }));
    assert_eq!(code, 409);
    let (code, _) = lab.post("/api/trash", &json!({ "run": "double-pole-velocities-1" }));
    assert_eq!(code, 409);
    let said = say(farsa(), &here, "lab --port 0");
    assert!(said.code == Some(2) && said.err.contains("another `lab` has this folder"), "{said:?}");
    drop(lab);

    let lab = Lab::start(&here, &["--jobs", "1"]);
    assert_eq!(lab.until("double-pole-velocities-1", "running")["is_stoppable"], true);
    lab.until("double-pole-velocities-2", "waiting");
    lab.done("/api/stop", &json!({ "run": "double-pole-velocities-1" }));
    lab.until("double-pole-velocities-1", "stopped");
    lab.until("double-pole-velocities-2", "running");
    lab.follow("double-pole-velocities-2", 1);
    lab.done("/api/stop", &json!({ "run": "double-pole-velocities-2" }));
    let run = lab.data("/api/run?name=double-pole-velocities-2");
    assert!(run["command"].as_str().is_some_and(|line| line.contains("--seed 2")), "{run}");
    lab.until("double-pole-velocities-2", "stopped");
    let both = json!(["double-pole-velocities-1", "double-pole-velocities-2"]);
    let report = lab.done("/api/page", &json!({ "kind": "report", "runs": both }));
    assert_eq!(report["file"], "pages/report-double-pole-velocities-1+double-pole-velocities-2.html");
    assert!(
        lab.get(&format!("/files/{}", report["file"].as_str().expect("a file"))).1.contains("double-pole-velocities-2")
    );
}
