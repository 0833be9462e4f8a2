//! Moves and pushes of a page, repeated by the command with the same bits.

use std::fs;

use serde_json::{Value, json};

use crate::live::{asked, data, opened, parsed};
use crate::tool::{farsa, ok, say, scratch};

#[test]
fn moves_and_pushes_of_a_page_are_replayed() {
    let here = scratch("replay-changes");
    let few = "--population 4 --set evolution.parents=2 --generations 1 --quiet";
    ok(farsa(), &here, &format!("run reach-grasp-lift {few} --out arm"));
    ok(farsa(), &here, "live arm --html arm.html --quiet");
    let mut session = opened(&data(&here.join("arm.html"))["live"]);
    let mut film = |changes: &Value, lesion: &str| {
        let mut request = json!({ "do": "film", "individual": 0, "trial": { "number": 1 }, "lesion": lesion });
        for kind in ["moves", "pushes"] {
            request[kind] = changes[kind].clone();
        }
        asked(&mut session, &request)
    };
    let none = json!({ "moves": [], "pushes": [] });
    let whole = film(&none, "");
    let bodies = whole["film"]["bodies"].as_array().expect("bodies").clone();
    let body = |name: &str| bodies.iter().position(|body| body == name).expect("the body");
    // Numbers of a browser are doubles.
    let changes = json!({
        "moves": [{ "step": 10, "body": body("sphere"), "position": [0.3000000119209289, -0.21, 0.4], "rotation": [0, 0, 0.6, 0.8] }],
        "pushes": [{ "steps": [12, 20], "body": body("palm"), "point": [0.01, 0, 0], "force": [0.1, 0.7, -4.9] }],
    });
    fs::write(here.join("changes.json"), changes.to_string()).expect("a file");
    let mut seen = Vec::new();
    for (lesion, option, words) in
        [("", "", "1 moved, 1 pushed"), ("sensor:touch", " --lesion sensor:touch", "sensor:touch, 1 moved, 1 pushed")]
    {
        let reply = film(&changes, lesion);
        let line = format!("replay arm --trial 1{option} --changes changes.json --html replay.html --json");
        let replayed = parsed(&ok(farsa(), &here, &line));
        let episodes = data(&here.join("replay.html"))["episodes"].clone();
        assert_eq!(episodes[0]["data"], whole["film"]["data"]);
        assert_eq!((&episodes[1]["data"], &episodes[1]["facts"]), (&reply["film"]["data"], &reply["film"]["facts"]));
        assert!(episodes[1]["name"].as_str().is_some_and(|name| name.contains(&format!("with {words}; "))));
        assert_eq!(replayed["lesion"]["list"], words);
        for key in ["steps", "fitness", "success"] {
            assert_eq!(replayed["lesion"]["trials"][0][key], reply[key], "{key}");
        }
        seen.push(reply["film"]["data"].clone());
        // The steps of the changed trial are written.
        let csv = ok(farsa(), &here, &line.replace("--html replay.html --json", "--quiet"));
        assert_eq!(csv.lines().count(), 1 + reply["steps"].as_u64().expect("steps") as usize);
    }
    assert!(seen[0] != seen[1] && seen[0] != whole["film"]["data"]);

    let write = |changes: Value| fs::write(here.join("wrong.json"), changes.to_string()).expect("a file");
    let push = |body: usize, force: f64| json!({ "pushes": [{ "steps": [1, 2], "body": body, "point": [0, 0, 0], "force": [0, 0, force] }] });
    for (changes, why) in [
        (push(1000, 1.0), "body 1000 of"),
        (push(0, 2e5), "at most 100000 N"),
        (json!({ "moved": [] }), "wrong.json: no moves and pushes of a trial: unknown field `moved`"),
        (json!([1]), "wrong.json: no moves and pushes of a trial: "),
    ] {
        write(changes);
        let said = say(farsa(), &here, "replay arm --trial 1 --changes wrong.json --html none.html");
        assert!(said.code == Some(2) && said.err.contains(why), "{said:?}");
    }
    for (line, why) in [
        ("replay arm --changes nowhere.json", "nowhere.json"),
        ("replay arm --changes changes.json --compare arm --html none.html", "cannot be used with"),
    ] {
        let said = say(farsa(), &here, line);
        assert!(said.code == Some(2) && said.err.contains(why), "{said:?}");
    }
    assert!(!here.join("none.html").exists());
}
