//! The champion of a running run in the laboratory, and the pages of the gallery.

use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};

use serde_json::{Value, json};

use crate::lab::Lab;
use crate::live::{data, parsed};
use crate::tool::{content, farsa, ok, scratch};

/// Returns the champions of the first events of a run.
fn champions(lab: &Lab, run: &str, count: usize) -> Vec<Value> {
    let mut stream = lab.connect();
    let lines = [lab.host(), lab.secret()];
    stream.write_all(&Lab::head(&format!("GET /events?run={run}&from=0"), &lines, "")).expect("a request");
    let (mut found, mut is_champions) = (Vec::new(), false);
    for line in BufReader::new(stream).lines() {
        let line = line.expect("a line");
        if let Some(name) = line.strip_prefix("event: ") {
            is_champions = name == "champions";
        } else if let Some(text) = line.strip_prefix("data: ").filter(|_| is_champions) {
            found.push(parsed(text));
            if found.len() == count {
                return found;
            }
        }
    }
    panic!("the stream ended after {} events", found.len());
}

/// Returns the head and the body of a file of the server.
fn file(lab: &Lab, path: &str) -> (u16, String, String) {
    let (code, text) = lab.raw(&Lab::head(&format!("GET {path}"), &[lab.host(), lab.secret()], ""));
    let (head, body) = text.split_once("\r\n\r\n").expect("a head");
    (code, head.to_owned(), body.to_owned())
}

#[cfg(unix)]
#[test]
fn a_page_receives_each_new_champion_of_a_run() {
    let here = scratch("lab-champion");
    fs::write(here.join("module"), [0x1f, 0x8b, 0]).expect("a file");
    let lab = Lab::start(&here, &["--module", "module"]);
    let settings = json!([["evolution.population", "4"], ["evolution.parents", "2"], ["trial.steps", "40"]]);
    let request = json!({ "experiment": "predator-prey", "seeds": [1], "generations": 1000000, "settings": settings });
    lab.done("/api/run", &request);
    // The process of the run may not have started.
    while lab.data("/api/run?name=predator-prey-1")["facts"]["done"] == 0 {
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    let events = champions(&lab, "predator-prey-1", 3);
    let generation = |event: &Value| event[0]["generation"].as_u64().expect("a generation");
    assert!(events.windows(2).all(|pair| generation(&pair[0]) < generation(&pair[1])), "{events:?}");
    // One of each population.
    assert!(events.iter().all(|event| event.as_array().is_some_and(|all| all.len() == 2)));
    lab.done("/api/stop", &json!({ "run": "predator-prey-1" }));
    while lab.data("/api/run?name=predator-prey-1")["facts"]["state"] != "stopped" {
        std::thread::sleep(std::time::Duration::from_millis(50));
    }

    // At rest the event, the page and the command have the same champion.
    let last = champions(&lab, "predator-prey-1", 1).remove(0);
    let before = content(&here);
    let (code, head, page) = file(&lab, "/files/champion/predator-prey-1");
    assert!(code == 200 && head.contains("sandbox allow-scripts") && !head.contains("allow-same-origin"), "{head}");
    assert!(head.contains("text/html") && head.contains("x-frame-options: SAMEORIGIN"), "{head}");
    fs::write(here.join("page.html"), page).expect("a page");
    let live = &data(&here.join("page.html"))["live"];
    fs::remove_file(here.join("page.html")).expect("the page");
    assert_eq!(content(&here), before, "nothing is written");
    assert_eq!((&live["served"], &live["standing"]), (&json!(true), &Value::Null));
    assert_eq!(live["module"], "H4sA");
    let shown = &live["script"]["individuals"][0];
    assert_eq!((&shown["generation"], &shown["parameters"]), (&last[0]["generation"], &last[0]["parameters"]));
    ok(farsa(), &here, "live runs/predator-prey-1 --html live.html --quiet");
    assert_eq!(data(&here.join("live.html"))["live"]["script"]["individuals"], live["script"]["individuals"]);
    let answer = lab.done("/api/page", &json!({ "kind": "live", "runs": ["predator-prey-1"] }));
    assert!(answer["command"].as_str().is_some_and(|line| line.contains("--module")), "{answer}");
    assert_eq!(data(&here.join("pages/live-predator-prey-1.html"))["live"]["module"], "H4sA");
}

#[cfg(unix)]
#[test]
fn a_champion_without_a_page_has_its_reason() {
    let here = scratch("lab-no-champion");
    let few = "--world rapier --set trial.count=1 --set trial.steps=10 --quiet";
    ok(farsa(), &here, &format!("run passive-walker {few} --out runs/foreign"));
    ok(farsa(), &here, "run braitenberg --out outside --quiet");
    std::os::unix::fs::symlink(here.join("outside"), here.join("runs/linked")).expect("a link");
    let lab = Lab::start(&here, &["--read-only"]);
    let (code, head, page) = file(&lab, "/files/champion/foreign");
    assert!(code == 422 && head.contains("text/html") && head.contains("sandbox allow-scripts"), "{head}");
    assert!(page.contains("world `rapier`: pages that run an agent are without it"), "{page}");
    for (path, expected) in [
        ("/files/champion/none", 404),
        ("/files/champion/linked", 403),
        ("/files/champion/..%2Foutside", 400),
        ("/files/champion/", 400),
        ("/files/champion/--print", 400),
    ] {
        let (code, text) = lab.get(path);
        assert_eq!(code, expected, "{path}: {text}");
    }
}

#[cfg(unix)]
#[test]
fn the_gallery_is_listed_and_served_as_other_pages() {
    let here = scratch("lab-gallery");
    fs::create_dir(here.join("gallery")).expect("a folder");
    for (name, text) in [("walker.html", "<p>walks"), ("index.html", "<p>all"), ("walker.png", "x"), ("notes.txt", "x")]
    {
        fs::write(here.join("gallery").join(name), text).expect("a file");
    }
    fs::write(here.join("secret.html"), "secret").expect("a file");
    std::os::unix::fs::symlink(here.join("secret.html"), here.join("gallery/linked.html")).expect("a link");
    let lab = Lab::start(&here, &["--read-only"]);
    let list = lab.data("/api/list");
    let gallery = list["gallery"].as_array().expect("pages");
    assert_eq!(gallery.iter().map(|page| page["name"].clone()).collect::<Vec<_>>(), [json!("walker.html")]);
    assert!(gallery[0]["modified"].as_u64().is_some_and(|time| time > 1_700_000_000), "{list}");
    let (code, head, page) = file(&lab, "/files/gallery/walker.html");
    assert!(code == 200 && page == "<p>walks" && head.contains("text/html"), "{head}");
    assert!(head.contains("sandbox allow-scripts") && !head.contains("allow-same-origin"), "{head}");
    let (_, head, _) = file(&lab, "/files/gallery/walker.png");
    assert!(head.contains("application/octet-stream") && head.contains("sandbox"), "{head}");
    for (path, expected) in [
        ("/files/gallery/linked.html", 403),
        ("/files/gallery/none.html", 404),
        ("/files/gallery/..%2Fsecret.html", 400),
        ("/files/gallery/../secret.html", 400),
    ] {
        let (code, text) = lab.get(path);
        assert!(code == expected && !text.contains("secret\""), "{path}: {code} {text}");
    }
    // A linked gallery is not followed.
    let other = scratch("lab-gallery-linked");
    std::os::unix::fs::symlink(here.join("gallery"), other.join("gallery")).expect("a link");
    let lab = Lab::start(&other, &["--read-only"]);
    assert_eq!(lab.data("/api/list")["gallery"], json!([]));
    assert_eq!(lab.get("/files/gallery/walker.html").0, 403);
}
