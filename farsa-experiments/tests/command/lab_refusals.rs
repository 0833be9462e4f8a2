//! Requests that the laboratory in the browser refuses, and its mode without changes.

use std::fs;
use std::io::{Read as _, Write as _};
use std::path::Path;

use serde_json::json;

use crate::lab::Lab;
use crate::tool::{content, farsa, ok, scratch};

/// All names and bytes below a folder.
fn all(folder: &Path) -> Vec<(std::path::PathBuf, Vec<u8>)> {
    content(folder).into_iter().filter(|(path, _)| !path.ends_with(".lab/lock")).collect()
}

#[cfg(unix)]
#[test]
fn strangers_are_refused_and_nothing_outside_is_touched() {
    let root = scratch("lab-refuses");
    let here = root.join("folder");
    fs::create_dir_all(here.join("runs")).expect("a folder");
    fs::write(root.join("secret.toml"), "summary = \"secret\"").expect("a file");
    ok(
        farsa(),
        &root,
        "run double-pole --population 4 --set evolution.parents=2 --generations 1 --out outside --quiet",
    );
    std::os::unix::fs::symlink(root.join("secret.toml"), here.join("link.toml")).expect("a link");
    std::os::unix::fs::symlink(root.join("outside"), here.join("runs/linked")).expect("a link");
    std::os::unix::fs::symlink(root.join("outside"), here.join("pages")).expect("a link");
    let lab = Lab::start(&here, &[]);
    let before = all(&root);
    let (host, secret, own) = (lab.host(), lab.secret(), lab.origin());
    let kind = "Content-Type: application/json\r\n".to_owned();
    let foreign = |name: &str| format!("Origin: {name}\r\n");
    let body = r#"{"name":"a","template":"light"}"#;
    let full = vec![host.clone(), secret.clone(), own.clone(), kind.clone()];
    let site = |of: &str| format!("Sec-Fetch-Site: {of}\r\nSec-Fetch-Dest: empty\r\n");
    for (first, lines, body, expected) in [
        ("GET /", vec![host.clone()], "", 403),
        ("GET /?token=0123456789abcdef0123456789abcdef", vec![host.clone()], "", 403),
        ("GET /api/list", vec![host.clone()], "", 403),
        ("GET /lab/main.js", vec![host.clone()], "", 403),
        ("GET /api/list", vec![host.clone(), "X-Farsa-Token: \r\n".into()], "", 403),
        ("GET /api/list", vec![host.clone(), "Cookie: farsa-lab=x\r\n".into()], "", 403),
        ("GET /api/list", vec!["Host: example.org\r\n".into(), secret.clone()], "", 403),
        ("GET /api/list", vec!["Host: 127.0.0.1:1\r\n".into(), secret.clone()], "", 403),
        ("GET /api/list", vec![host.clone(), secret.clone(), foreign("http://example.org")], "", 403),
        ("GET /api/list", vec![host.clone(), secret.clone(), foreign("null")], "", 403),
        ("GET /api/list", vec![host.clone(), secret.clone(), site("cross-site")], "", 403),
        ("POST /api/new", vec![host.clone(), own.clone(), kind.clone()], body, 403),
        ("POST /api/new", vec![host.clone(), secret.clone(), kind.clone()], body, 403),
        ("POST /api/new", vec![host.clone(), secret.clone(), foreign("null"), kind.clone()], body, 403),
        ("POST /api/new", vec![host.clone(), secret.clone(), foreign("http://127.0.0.1:1"), kind], body, 403),
        ("POST /api/new", vec![host.clone(), secret.clone(), own, "Content-Type: text/plain\r\n".into()], body, 415),
        ("PUT /api/new", full.clone(), body, 405),
        ("DELETE /api/list", full.clone(), "", 405),
        ("OPTIONS /api/new", full.clone(), "", 405),
        ("GET /api/new", vec![host.clone(), secret.clone()], "", 404),
        ("POST /api/nothing", full.clone(), "{}", 404),
        ("POST /api/new", full.clone(), "{", 400),
        ("POST /api/new", full.clone(), r#"{"name":"a","template":"light","out":"x"}"#, 400),
    ] {
        let (code, text) = lab.raw(&Lab::head(first, &lines, body));
        assert_eq!(code, expected, "{first} {lines:?}: {text}");
    }
    for path in [
        "/api/file?name=../secret.toml",
        "/api/file?name=..%2Fsecret.toml",
        "/api/file?name=%2Fetc%2Fpasswd",
        "/api/file?name=link.toml",
        "/api/file?name=.lab%2Flock",
        "/api/run?name=..",
        "/api/run?name=linked",
        "/api/run?name=%2e%2e%2foutside",
        "/api/run?name=a%00b",
        "/api/run?name=%ff",
        "/api/info?experiment=--help",
        "/api/info?experiment=link.toml",
        "/api/info?experiment=link",
        "/api/graph?experiment=link.toml",
        "/api/info?experiment=..%2Fsecret.toml",
        "/api/info?experiment=double-pole&condition=--json",
        "/files/pages/config.toml",
        "/files/pages/..%2Fsecret.toml",
        "/files/runs/linked",
        "/files/exports/../../secret.toml",
        "/files/.lab/lock",
        "/events?run=linked&from=0",
        "/events?run=..%2Foutside&from=0",
    ] {
        let (code, text) = lab.get(path);
        assert!((400..500).contains(&code) && !text.contains("secret\""), "{path}: {code} {text}");
    }
    for (path, body) in [
        ("/api/new", json!({ "name": "../x", "template": "light" })),
        ("/api/new", json!({ "name": "/etc/x", "template": "light" })),
        ("/api/new", json!({ "name": "link.toml", "template": "light" })),
        ("/api/new", json!({ "name": "x", "template": "--help" })),
        ("/api/save", json!({ "name": "../secret.toml", "text": "", "before": "summary = \"secret\"" })),
        ("/api/save", json!({ "name": "link.toml", "text": "", "before": "summary = \"secret\"" })),
        ("/api/run", json!({ "experiment": "../secret.toml", "seeds": [1] })),
        ("/api/run", json!({ "experiment": "double-pole", "seeds": [1], "name": "../../x" })),
        ("/api/run", json!({ "experiment": "double-pole", "seeds": [] })),
        ("/api/run", json!({ "experiment": "double-pole", "seeds": [1], "settings": [["a.b", "/etc/passwd"]] })),
        ("/api/run", json!({ "experiment": "double-pole", "seeds": [1], "settings": [["--out", "x"]] })),
        ("/api/resume", json!({ "run": "linked" })),
        ("/api/resume", json!({ "run": "../outside" })),
        ("/api/test", json!({ "run": "linked" })),
        ("/api/stop", json!({ "run": "linked" })),
        ("/api/page", json!({ "kind": "report", "runs": ["linked"] })),
        ("/api/export", json!({ "run": "linked", "format": "genotype" })),
        ("/api/keep", json!({ "kind": "script", "run": "linked", "text": "x" })),
        ("/api/keep", json!({ "kind": "run", "run": "../outside", "text": "{}" })),
        ("/api/trash", json!({ "run": "linked" })),
        ("/api/trash", json!({ "file": "link.toml" })),
        ("/api/trash", json!({ "file": "../secret.toml" })),
    ] {
        let (code, answer) = lab.post(path, &body);
        assert!((400..500).contains(&code), "{path} {body}: {code} {answer}");
    }
    // A body above the limit, and one that never arrives.
    let large = format!("Content-Length: {}\r\n", 5 << 20);
    let mut bytes = Lab::head("POST /api/new", &[full.clone(), vec![large]].concat(), "");
    bytes.resize(bytes.len() + (5 << 20), b' ');
    assert!([0, 413].contains(&lab.raw(&bytes).0));
    assert_eq!(all(&root), before);
    assert_eq!(lab.data("/api/list")["runs"], json!([]));
}

/// A folder may come with jobs that no request has made.
#[test]
fn forged_jobs_are_not_started() {
    let root = scratch("lab-forged");
    let here = root.join("folder");
    fs::create_dir_all(here.join(".lab/jobs")).expect("a folder");
    ok(farsa(), &here, "new follow --from light --quiet");
    let outside = root.join("outside").display().to_string();
    let quick = ["--set", "evolution.population=4", "--generations", "1"];
    let words: [Vec<&str>; 8] = [
        ["run", "--from", "../outside/x.json", "--out", "runs/a"].to_vec(),
        ["run", "follow.toml"].into_iter().chain(quick).chain(["--out", &outside]).collect(),
        ["run", "follow.toml", "--out", &outside].into_iter().chain(quick).chain(["--out", "runs/a"]).collect(),
        ["run", "../follow.toml"].into_iter().chain(quick).chain(["--out", "runs/a"]).collect(),
        ["run", "--resume", "../outside"].to_vec(),
        ["new", "evil"].to_vec(),
        ["test", "runs/a", "--protocol", "--out", "--json"].to_vec(),
        ["export", "controller", "runs/a", "--out", &outside].to_vec(),
    ];
    for (number, words) in words.iter().enumerate() {
        let job = json!({ "number": number + 1, "kind": "run", "run": "a", "words": words, "created": 1, "pid": null,
            "has_started": false, "has_ended": false });
        fs::write(here.join(format!(".lab/jobs/{}.json", number + 1)), job.to_string()).expect("a job");
    }
    let before = all(&root);
    let lab = Lab::start(&here, &[]);
    assert_eq!(lab.get("/api/list").0, 200);
    std::thread::sleep(std::time::Duration::from_secs(2));
    drop(lab);
    assert_eq!(all(&root), before);
}

#[test]
fn the_printed_address_opens_the_page_and_gives_its_cookie() {
    let here = scratch("lab-cookie");
    let lab = Lab::start(&here, &[]);
    let first = format!("GET /?token={}", lab.token);
    let navigation = "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Dest: document\r\n".to_owned();
    let (code, text) = lab.raw(&Lab::head(&first, &[lab.host(), navigation], ""));
    let (head, _) = text.split_once("\r\n\r\n").expect("a head");
    assert_eq!(code, 200, "{head}");
    for part in ["script-src 'self'", "default-src 'none'", "x-frame-options: DENY", "referrer-policy: no-referrer"] {
        assert!(head.contains(part), "{part}: {head}");
    }
    let cookie = head.lines().find_map(|line| line.strip_prefix("set-cookie: ")).expect("a cookie");
    assert!(cookie.contains("HttpOnly") && cookie.contains("SameSite=Strict"), "{cookie}");
    let cookie = format!("Cookie: other=1; {}\r\n", cookie.split(';').next().expect("a pair"));
    let (code, text) = lab.raw(&Lab::head("GET /lab/main.js", &[lab.host(), cookie.clone()], ""));
    assert!(code == 200 && text.contains("text/javascript"), "{text}");
    assert_eq!(lab.raw(&Lab::head("GET /api/list", &[lab.host(), cookie], "")).0, 200);
    // Another server has another token.
    let other = Lab::start(&scratch("lab-cookie-2"), &[]);
    assert_ne!(lab.token, other.token);
    assert_eq!(lab.raw(&Lab::head("GET /", &[lab.host(), other.secret()], "")).0, 403);
}

#[test]
fn a_laboratory_to_look_at_refuses_every_change() {
    let here = scratch("lab-read-only");
    ok(farsa(), &here, "run double-pole --population 4 --set evolution.parents=2 --generations 1 --out runs/r --quiet");
    ok(farsa(), &here, "new follow");
    let lab = Lab::start(&here, &["--read-only"]);
    let before = content(&here);
    let text = fs::read_to_string(here.join("follow.toml")).expect("a text");
    for (path, body) in [
        ("/api/new", json!({ "name": "x", "template": "light" })),
        ("/api/save", json!({ "name": "follow.toml", "text": "", "before": text })),
        ("/api/run", json!({ "experiment": "double-pole", "seeds": [1] })),
        ("/api/resume", json!({ "run": "r", "generations": 3 })),
        ("/api/test", json!({ "run": "r" })),
        ("/api/stop", json!({ "run": "r" })),
        ("/api/page", json!({ "kind": "report", "runs": ["r"] })),
        ("/api/export", json!({ "run": "r", "format": "genotype" })),
        ("/api/keep", json!({ "kind": "script", "run": "r", "text": "x" })),
        ("/api/trash", json!({ "run": "r" })),
        ("/api/trash", json!({ "file": "follow.toml" })),
        ("/api/nothing", json!({})),
    ] {
        let (code, answer) = lab.post(path, &body);
        assert_eq!(code, 403, "{path}: {answer}");
    }
    assert_eq!(lab.done("/api/check", &json!({ "name": "follow.toml", "text": text }))["experiment"], "follow");
    let list = lab.data("/api/list");
    assert_eq!((&list["runs"][0]["done"], &list["read_only"]), (&json!(1), &json!(true)));
    assert_eq!(lab.data("/api/run?name=r")["facts"]["state"], "finished");
    assert!(lab.get("/api/graph?experiment=follow.toml").1.starts_with("<svg"));
    assert_eq!(content(&here), before);
}

/// 100 000 random heads: parts of valid ones in any order, cut, repeated and mixed with other bytes.
#[test]
fn malformed_heads_are_survived() {
    // Connections to one address run out of ports before there are 100 000.
    (0..5).for_each(survives_malformed_heads);
}

fn survives_malformed_heads(part: u64) {
    const HEADS: u64 = 20_000;
    let here = scratch(&format!("lab-heads-{part}"));
    let lab = Lab::start(&here, &[]);
    let before = all(&here);
    let parts: Vec<Vec<u8>> = [
        "GET ",
        "POST ",
        "/api/new",
        "/api/list",
        "/?token=",
        "/files/pages/x",
        " HTTP/1.1\r\n",
        " HTTP/9\r\n",
        "\r\n",
        "Host: ",
        "Content-Length: ",
        "99999999999999999999",
        "-1",
        "0\r\n",
        "Transfer-Encoding: chunked\r\n",
        "zz\r\n",
        "Origin: null\r\n",
        "Cookie: ",
        "=;;=",
        "%00%2e%2e",
        ": ",
        "\0",
        "é",
        "Expect: 100-continue\r\n",
    ]
    .iter()
    .map(|part| part.as_bytes().to_vec())
    .chain([lab.host(), lab.origin(), "Content-Type: application/json\r\n".into()].map(String::into_bytes))
    .collect();
    let threads: Vec<_> = (0..4).collect();
    std::thread::scope(|scope| {
        for thread in &threads {
            let (parts, lab) = (&parts, &lab);
            scope.spawn(move || {
                let mut state = 0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(4 * part + thread + 1);
                let mut random = |below: usize| {
                    state ^= state << 13;
                    state ^= state >> 7;
                    state ^= state << 17;
                    (state >> 33) as usize % below
                };
                for _ in 0..HEADS / 4 {
                    let mut head = Vec::new();
                    for _ in 0..=random(12) {
                        head.extend_from_slice(&parts[random(parts.len())]);
                        if random(9) == 0 {
                            head.push(random(256) as u8);
                        }
                    }
                    head.truncate(1 + random(head.len()));
                    let mut stream = lab.connect();
                    let _ = stream.write_all(&head);
                    let _ = stream.shutdown(std::net::Shutdown::Write);
                    let mut answer = [0; 64];
                    let size = stream.read(&mut answer).unwrap_or(0);
                    let text = String::from_utf8_lossy(&answer[..size]);
                    assert!(!text.starts_with("HTTP/1.1 2") && !text.starts_with("HTTP/1.1 5"), "{text}: {head:?}");
                }
            });
        }
    });
    assert_eq!(lab.data("/api/list")["runs"], json!([]));
    assert_eq!(all(&here), before);
}
