//! Pages that run an agent: their contents, and equal results of page and command.

use std::fs;
use std::io::Read as _;
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use farsa_lab::advanced::LiveSession;
use flate2::read::GzDecoder;
use serde_json::{Value, json};

use crate::saved_page::saved_run;
use crate::tool::{farsa, ok, own, say, scratch};

/// The data of a page.
pub(crate) fn data(path: &Path) -> Value {
    let html = fs::read_to_string(path).expect("the page");
    let (_, rest) = html.rsplit_once("id=\"data\">").expect("the data");
    let (text, _) = rest.split_once("</script>").expect("their end");
    serde_json::from_str(text).expect("JSON")
}

/// Decodes the base64 of a page.
fn decoded(text: &Value) -> Vec<u8> {
    STANDARD.decode(text.as_str().expect("text")).expect("base64")
}

/// Opens the agent of a page without a browser.
pub(crate) fn opened(live: &Value) -> LiveSession {
    LiveSession::open(&farsa_experiments::laboratory(), &live["script"].to_string()).expect("an agent")
}

/// Returns the script of a page, with the saved state of its evolution.
fn standing(live: &Value) -> Value {
    let mut script = live["script"].clone();
    let mut state = String::new();
    GzDecoder::new(&decoded(&live["standing"])[..]).read_to_string(&mut state).expect("gzip");
    script["standing"] = parsed(&state);
    script
}

/// Opens a session that can continue the evolution.
pub(crate) fn evolving(live: &Value) -> LiveSession {
    LiveSession::open(&farsa_experiments::laboratory(), &standing(live).to_string()).expect("an agent")
}

pub(crate) fn asked(session: &mut LiveSession, request: &Value) -> Value {
    serde_json::from_str(&session.answer(&request.to_string())).expect("JSON")
}

pub(crate) fn parsed(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

/// Imports the agent of a fixture as the run `catcher`.
fn catcher(here: &Path) {
    let genes = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/minimal-cognition.gen");
    fs::copy(genes, here.join("own.gen")).expect("a copy");
    ok(farsa(), here, "import own.gen --experiment minimal-cognition --out catcher --quiet");
}

#[test]
fn an_agent_runs_as_it_is_replayed_and_tested() {
    let here = scratch("live");
    catcher(&here);
    let summary = parsed(&ok(farsa(), &here, "live catcher --html live.html --json"));
    assert_eq!((&summary["generations"], &summary["file"]), (&json!([0]), &"live.html".into()));
    let page = data(&here.join("live.html"));
    assert_eq!((&page["episodes"], &page["title"]), (&json!([]), &"minimal-cognition-1".into()));
    let live = &page["live"];
    assert_eq!(decoded(&live["module"]), include_bytes!("../../src/live.wasm.gz"));
    assert!(summary["bytes"].as_u64().is_some_and(|bytes| bytes < 3_000_000), "{summary}");
    let mut session = opened(live);

    // A trial equals that of a replay, also with a lesion.
    for (lesion, number) in [("", 0), ("sensor:rays", 1)] {
        let request = json!({ "do": "film", "individual": 0, "trial": { "number": 3 }, "lesion": lesion });
        let reply = asked(&mut session, &request);
        let line = "replay catcher --trial 3 --lesion sensor:rays --html replay.html --json";
        let replayed = parsed(&ok(farsa(), &here, line));
        let film = &data(&here.join("replay.html"))["episodes"][number];
        assert_eq!((&reply["film"]["data"], &reply["film"]["facts"]), (&film["data"], &film["facts"]));
        let outcome = if lesion.is_empty() { &replayed["trials"][0] } else { &replayed["lesion"]["trials"][0] };
        for key in ["steps", "fitness", "success"] {
            assert_eq!(reply[key], outcome[key], "{key}");
        }
        let about = &live["about"]["individuals"][0]["trials"][3];
        let digests = reply["digests"].as_array().expect("digests");
        let stride = about["stride"].as_u64().expect("a number") as usize;
        let sampled: Vec<&Value> =
            digests.iter().enumerate().filter(|(t, _)| (t + 1) % stride == 0).map(|(_, x)| x).collect();
        let run: Vec<&Value> = about["digests"].as_array().expect("digests").iter().take(sampled.len()).collect();
        assert!(sampled.len() > 50 && digests.len() == reply["steps"].as_u64().expect("steps") as usize);
        assert_eq!(sampled == run, lesion.is_empty());
    }

    // New trials equal those of a test, in parts or at once.
    let tested = parsed(&ok(farsa(), &here, "test catcher --trials 40 --seed 2 --lesion sensor:rays --json"));
    for (case, lesion) in ["", "sensor:rays"].into_iter().enumerate() {
        let mut part = |first, count| {
            let request =
                json!({ "do": "fresh", "individual": 0, "lesion": lesion, "seed": 2, "first": first, "count": count });
            asked(&mut session, &request)["successes"].as_u64().expect("a number")
        };
        let counts = [part(0, 40), part(0, 15) + part(15, 25)];
        assert_eq!(counts.map(Value::from), [tested["cases"][case]["successes"].clone(), counts[0].into()], "{lesion}");
    }

    let names = asked(&mut session, &json!({ "do": "names" }));
    assert_eq!((&names[0]["kind"], &names[0]["names"][0]), (&"sensor".into(), &"rays".into()));
    for (request, why) in [
        (json!({ "do": "film", "individual": 1, "trial": { "number": 0 } }), "individual 1 of 1 (the first is 0)"),
        (json!({ "do": "film", "individual": 0, "trial": { "number": 24 } }), "trial 24 of 24 (the first is 0)"),
        (json!({ "do": "film", "individual": 0, "trial": { "number": 0 }, "lesion": "ray" }), "is no change such as"),
        (json!({ "do": "fresh", "individual": 0, "seed": 1, "first": 0, "count": 10_001 }), "10001 trials at once"),
        (json!({ "do": "fly" }), "unknown variant `fly`"),
        (json!("no"), "request: "),
    ] {
        let error = asked(&mut session, &request)["error"].as_str().expect("an error").to_owned();
        assert!(error.contains(why), "{request}: {error}");
    }
}

#[test]
fn generations_of_several_populations_run_side_by_side() {
    let here = scratch("live-populations");
    ok(
        farsa(),
        &here,
        "run predator-prey --population 4 --set evolution.parents=2 --generations 3 --set trial.steps=40 --out r --quiet",
    );
    ok(farsa(), &here, "live r --generations 2,0 --html live.html --quiet");
    let live = &data(&here.join("live.html"))["live"];
    let generations = live["about"]["individuals"].as_array().expect("individuals").iter();
    assert_eq!(
        generations.map(|individual| individual["generation"].clone()).collect::<Vec<_>>(),
        [0, 2].map(Value::from)
    );
    let mut session = opened(live);
    for (place, generation) in [0, 2].into_iter().enumerate() {
        let request = json!({ "do": "film", "individual": place, "trial": { "number": 1 } });
        let reply = asked(&mut session, &request);
        let line = format!("replay r --generation {generation} --trial 1 --html {generation}.html --json");
        let replayed = parsed(&ok(farsa(), &here, &line));
        assert_eq!(reply["fitness"], replayed["fitness"]);
        assert_eq!(reply["film"]["data"], data(&here.join(format!("{generation}.html")))["episodes"][0]["data"]);
    }
}

#[test]
fn runs_without_a_page_are_refused_and_write_nothing() {
    let here = scratch("live-refused");
    catcher(&here);
    ok(own(), &here, "run cart --generations 1 --out cart --quiet");
    ok(
        farsa(),
        &here,
        "run passive-walker --world rapier --set trial.count=1 --set trial.steps=10 --out foreign --quiet",
    );
    fs::write(here.join("notes.html"), "mine").expect("a file");
    fs::write(here.join("module"), "no module").expect("a file");
    for (program, line, why) in [
        (own(), "live cart --html new.html", "this program has no module for pages: give one with --module"),
        (farsa(), "live foreign --html new.html", "world `rapier`: pages that run an agent are without it"),
        (farsa(), "serve foreign --port 0", "world `rapier`: pages that run an agent are without it"),
        (
            farsa(),
            "live catcher --html new.html --module module",
            "module: is no WebAssembly module, neither a plain one nor one",
        ),
        (farsa(), "live catcher --html new.html --module nowhere", "nowhere"),
        (farsa(), "live catcher --html new.html --generations 3", "generation 3 of 1 finished ones"),
        (farsa(), "live catcher --html notes.html --generations 3", "there is one already"),
        (farsa(), "live nowhere --html new.html", "there is no such directory"),
        (farsa(), "live catcher", "--html"),
    ] {
        let output = say(program, &here, line);
        assert!(output.code != Some(0) && output.err.contains(why), "{line}: {output:?}");
    }
    assert!(!here.join("new.html").exists());
    assert_eq!(fs::read(here.join("notes.html")).expect("the file"), b"mine");
    // A compressed module is stored unchanged, and a plain one compressed.
    fs::write(here.join("module"), [0x1f, 0x8b, 0]).expect("a file");
    ok(farsa(), &here, "live catcher --html new.html --module module --quiet");
    let live = &data(&here.join("new.html"))["live"];
    assert_eq!(live["module"], "H4sA");
    fs::write(here.join("module"), b"\0asm").expect("a file");
    ok(farsa(), &here, "live catcher --html new.html --module module --quiet");
    assert!(decoded(&data(&here.join("new.html"))["live"]["module"]).starts_with(&[0x1f, 0x8b]));
}

#[test]
fn invalid_scripts_are_refused() {
    let laboratory = farsa_experiments::laboratory();
    let individual = r#"{"generation":0,"individual":0,"parameters":[],"opponents":[],"normalisation":null}"#;
    for (script, why) in [
        ("", "script: "),
        (r#"{"config":"experiment = \"aggregation\"","individuals":[]}"#, "it has no individual"),
        (
            &format!(r#"{{"config":"experiment = \"agregation\"","individuals":[{individual}]}}"#),
            "the nearest is `aggregation`",
        ),
        (&format!(r#"{{"config":"seed = 1","individuals":[{individual}]}}"#), "names no experiment"),
    ] {
        let error = LiveSession::open(&laboratory, script).err().expect("an error").to_string();
        assert!(error.contains(why), "{script}: {error}");
    }
    let script = format!(r#"{{"config":"experiment = \"double-pole\"","individuals":[{individual}]}}"#);
    let error = LiveSession::open(&laboratory, &script).err().expect("an error").to_string();
    assert!(error.contains("an individual of 0 parameters where 16 are"), "{error}");
}

/// Continues a page's run for some generations, shared by `parts` sessions, and identifies the state after them.
fn evolved(live: &Value, generations: usize, parts: usize) -> (Vec<Value>, Value) {
    let mut sessions: Vec<LiveSession> = (0..parts).map(|_| evolving(live)).collect();
    let generation = |_| {
        let shares = sessions.iter_mut().enumerate().map(|(part, session)| {
            asked(session, &json!({ "do": "share", "part": part, "parts": parts }))["outcomes"].clone()
        });
        let request = json!({ "do": "tell", "outcomes": shares.collect::<Vec<_>>() });
        let updates: Vec<Value> = sessions.iter_mut().map(|session| asked(session, &request)).collect();
        assert!(updates.iter().all(|update| *update == updates[0] && update["error"].is_null()), "{updates:?}");
        updates[0].clone()
    };
    let updates = (0..generations).map(generation).collect();
    (updates, asked(&mut sessions[0], &json!({ "do": "state" })))
}

#[test]
fn evolution_continues_in_a_page_as_in_a_run() {
    let here = scratch("live-evolution");
    for (name, parts, line) in [
        ("one", 1, "double-pole --population 10 --set evolution.parents=2"),
        ("opponents", 3, "predator-prey --population 4 --set evolution.parents=2 --set trial.steps=40"),
        (
            "generalist",
            2,
            "predator-prey --strategy generalist --population 4 --set strategy.newcomers=2 --set trial.steps=40",
        ),
        ("reals", 2, "double-pole --strategy snes"),
        (
            "novel",
            2,
            "foraging --strategy novelty-search --population 4 --set evolution.parents=2 --set trial.steps=30",
        ),
        ("many", 7, "foraging --strategy map-elites --population 5 --set trial.steps=30"),
        (
            "normalised",
            2,
            "reach-grasp-lift --strategy open-ai-es --set strategy.normalise_observations=true \
          --population 4 --set trial.steps=20",
        ),
    ] {
        ok(farsa(), &here, &format!("run {line} --generations 2 --out {name} --quiet"));
        ok(farsa(), &here, &format!("live {name} --html {name}.html --quiet"));
        let live = &data(&here.join(format!("{name}.html")))["live"];
        assert_eq!(live["about"]["standstill"], Value::Null, "{name}");
        let (updates, mark) = evolved(live, 3, parts);
        ok(farsa(), &here, &format!("run --resume {name} --generations 5 --quiet"));
        // The generations of the page as a run of the command.
        let saved = here.join(format!("{name}.run.json"));
        fs::write(&saved, saved_run(live, &mark).to_string()).expect("a file");
        ok(farsa(), &here, &format!("run --from {name}.run.json --out {name}-again --quiet"));
        for file in ["fitness.csv", "record.bin", "champion.bin", "checkpoint.bin"] {
            let of = |run: &str| fs::read(here.join(run).join(file)).expect("a file");
            assert!(of(name) == of(&format!("{name}-again")), "{name}: {file}");
        }
        let log = fs::read_to_string(here.join(name).join("fitness.csv")).expect("the log");
        let rows: Vec<Vec<f64>> = log
            .lines()
            .skip(1)
            .map(|row| row.split(',').map(|cell| cell.parse().expect("a number")).collect())
            .collect();
        assert_eq!(live["about"]["history"][1], json!([1, rows[1][1], rows[1][2]]), "{name}");
        for (row, update) in rows[2..].iter().zip(&updates) {
            let line = &update["line"];
            let rest =
                line["each"].as_array().expect("populations").iter().flat_map(|row| row.as_array().expect("a row"));
            let common = [&update["generation"]].into_iter().chain(line["row"].as_array().expect("a row"));
            let reported: Vec<&Value> = common.chain([&line["evaluations"], &line["failed"]]).chain(rest).collect();
            let run: Vec<Option<f64>> = row.iter().map(|x| Some(*x).filter(|x| x.is_finite())).collect();
            assert_eq!(reported.iter().map(|x| x.as_f64()).collect::<Vec<_>>(), run, "{name}");
        }

        // The champion is the best ever or that of the last generation. It runs in the page as it is replayed.
        let champion = &updates[2]["champions"][0];
        let best = |best: usize, next: usize| if rows[next][1] > rows[best][1] { next } else { best };
        let generation = if ["novel", "many"].contains(&name) { (2..5).reduce(best).unwrap_or(2) } else { 4 };
        assert_eq!(champion["generation"], generation, "{name}");
        let mut session = opened(live);
        let added = asked(&mut session, &json!({ "do": "add", "individual": champion }));
        assert_eq!(added, json!({ "individual": 1 }));
        let film = asked(&mut session, &json!({ "do": "film", "individual": 1, "trial": { "number": 0 } }));
        let which = format!("--generation {generation} --trial 0");
        ok(farsa(), &here, &format!("replay {name} {which} --html {name}-replay.html --quiet"));
        assert_eq!(
            film["film"]["data"],
            data(&here.join(format!("{name}-replay.html")))["episodes"][0]["data"],
            "{name}"
        );
    }
}

#[test]
fn evolution_that_cannot_continue_gives_the_reason() {
    let here = scratch("live-standstill");
    catcher(&here);
    ok(farsa(), &here, "live catcher --html live.html --quiet");
    let live = &data(&here.join("live.html"))["live"];
    assert_eq!(live["about"]["standstill"], "these genotypes were not made by evolution");
    ok(farsa(), &here, "run braitenberg --out plain --quiet");
    ok(farsa(), &here, "live plain --html plain.html --quiet");
    let about = &data(&here.join("plain.html"))["live"]["about"];
    let nothing = (&json!([]), &json!("nothing evolves in this experiment"));
    assert_eq!((&about["history"], &about["standstill"]), nothing);
    let mut session = opened(live);
    let mut refused = |request: Value| asked(&mut session, &request)["error"].as_str().expect("an error").to_owned();
    assert!(refused(json!({ "do": "share", "part": 0, "parts": 1 })).contains("evolution cannot continue here"));

    ok(farsa(), &here, "run double-pole --population 10 --set evolution.parents=2 --generations 1 --out r --quiet");
    ok(farsa(), &here, "live r --html r.html --quiet");
    let live = &data(&here.join("r.html"))["live"];
    let mut session = evolving(live);
    let half = asked(&mut session, &json!({ "do": "share", "part": 1, "parts": 2 }))["outcomes"].clone();
    for (request, why) in [
        (json!({ "do": "share", "part": 2, "parts": 2 }), "part 2 of 2"),
        (json!({ "do": "share", "part": 0, "parts": 0 }), "part 0 of 0"),
        (json!({ "do": "tell", "outcomes": [] }), "not those of a whole generation"),
        (json!({ "do": "tell", "outcomes": [half.clone()] }), "not those of a whole generation"),
        (json!({ "do": "tell", "outcomes": [half.clone(), half] }), "not those of a whole generation"),
        (json!({ "do": "tell", "outcomes": ["AAEC"] }), "outcomes: "),
        (json!({ "do": "tell", "outcomes": ["-"] }), "request: "),
    ] {
        let error = asked(&mut session, &request)["error"].as_str().expect("an error").to_owned();
        assert!(error.contains(why), "{request}: {error}");
    }
    // The refused requests have changed nothing.
    let (first, _) = evolved(live, 1, 1);
    let whole = asked(&mut session, &json!({ "do": "share", "part": 0, "parts": 1 }))["outcomes"].clone();
    assert_eq!(asked(&mut session, &json!({ "do": "tell", "outcomes": [whole] })), first[0]);
    // A state of another strategy, and an invalid generation.
    for (key, to, why) in [("state", "AAAA", "the state of the run"), ("generation", "", "script: ")] {
        let mut script = standing(live);
        script["standing"][key] = to.into();
        let error = LiveSession::open(&farsa_experiments::laboratory(), &script.to_string()).err();
        let error = error.expect("an error").to_string();
        assert!(error.contains(why), "{error}");
    }
}

#[test]
fn a_body_of_a_page_is_moved() {
    let here = scratch("live-moves");
    let few = "--population 4 --set evolution.parents=2 --generations 1 --quiet";
    ok(farsa(), &here, &format!("run reach-grasp-lift {few} --out arm"));
    ok(farsa(), &here, &format!("run foraging {few} --set trial.steps=30 --out team"));
    let ids = json!([0, 0, 0, 1]);
    for (run, name, position, falls) in
        [("arm", "sphere", json!([0.3, -0.2, 0.4]), true), ("team", "area", json!([0.5, 0.25, 0.0]), false)]
    {
        ok(farsa(), &here, &format!("live {run} --html {run}.html --quiet"));
        let live = &data(&here.join(format!("{run}.html")))["live"];
        assert_eq!(live["about"]["displaces"], true);
        let mut session = opened(live);
        let mut film = |moves: Value| {
            asked(&mut session, &json!({ "do": "film", "individual": 0, "trial": { "number": 0 }, "moves": moves }))
        };
        let whole = film(json!([]));
        let bodies = whole["film"]["bodies"].as_array().expect("bodies");
        let body = bodies.iter().position(|body| body == name).expect("the body");
        let change = |body: usize| json!({ "step": 10, "body": body, "position": position, "rotation": ids });
        let moved = film(json!([change(body)]));
        let first = |other: &Value| {
            let both = |film: &Value, at: usize| film["digests"][at].clone();
            (0..20).position(|at| both(&whole, at) != both(other, at))
        };
        // All effects begin at that step.
        assert_eq!(first(&moved), Some(10), "{name}");
        assert_eq!(film(json!([change(body)]))["digests"], moved["digests"]);
        assert!(!falls || moved["steps"] != whole["steps"] || moved["fitness"] != whole["fitness"]);
        // A change after the end has no effect, and a body on joints stays in its place.
        assert_eq!(
            film(json!([{ "step": 100_000, "body": body, "position": position, "rotation": ids }]))["digests"],
            whole["digests"]
        );
        if falls {
            assert_eq!(film(json!([change(0)]))["digests"], whole["digests"]);
        }
        for (wrong, why) in [
            (change(1000), "body 1000 of"),
            (json!({ "step": 1, "body": 0, "position": [0, 0, 1], "rotation": [0, 0, 0, 0] }), "turned by"),
            (json!({ "step": 1, "body": 0, "position": [0, 0, 1e39], "rotation": ids }), "a body at"),
        ] {
            let error = film(json!([wrong]))["error"].as_str().expect("an error").to_owned();
            assert!(error.contains(why), "{error}");
        }
    }
    catcher(&here);
    ok(farsa(), &here, "live catcher --html catcher.html --quiet");
    let mut session = opened(&data(&here.join("catcher.html"))["live"]);
    let moves = json!([{ "step": 1, "body": 0, "position": [0, 0, 1], "rotation": ids }]);
    let refused =
        asked(&mut session, &json!({ "do": "film", "individual": 0, "trial": { "number": 0 }, "moves": moves }));
    assert!(refused["error"].as_str().expect("an error").contains("has no bodies that can be moved"));
}

#[test]
fn a_body_of_a_page_is_pushed() {
    let here = scratch("live-pushes");
    let few = "--population 4 --set evolution.parents=2 --generations 1 --quiet";
    ok(farsa(), &here, &format!("run reach-grasp-lift {few} --out arm"));
    ok(farsa(), &here, "live arm --html arm.html --quiet");
    let live = &data(&here.join("arm.html"))["live"];
    assert_eq!(live["about"]["pushes"], true);
    let mut session = opened(live);
    let mut film = |pushes: Value| {
        asked(&mut session, &json!({ "do": "film", "individual": 0, "trial": { "number": 0 }, "pushes": pushes }))
    };
    let whole = film(json!([]));
    let bodies = whole["film"]["bodies"].as_array().expect("bodies").clone();
    let push = |name: &str, steps: [u32; 2], force: f64| {
        let body = bodies.iter().position(|body| body == name).expect("the body");
        json!({ "steps": steps, "body": body, "point": [0, 0, 0], "force": [0, 0, force] })
    };
    let first = |other: &Value| {
        let both = |film: &Value, at: usize| film["digests"][at].clone();
        (0..40).position(|at| both(&whole, at) != both(other, at))
    };
    // All effects begin with the first step, and bodies on joints are pushed as well as the sphere.
    let pushed = film(json!([push("sphere", [10, 20], 5.0)]));
    assert_eq!(first(&pushed), Some(10));
    assert!(pushed["film"]["name"].as_str().expect("a name").ends_with("; 1 pushed"));
    assert_eq!(film(json!([push("sphere", [10, 20], 5.0)]))["digests"], pushed["digests"]);
    assert_eq!(first(&film(json!([push("palm", [12, 13], 5.0)]))), Some(12));
    for nothing in
        [push("sphere", [10, 10], 5.0), push("sphere", [10, 20], 0.0), push("sphere", [100_000, 200_000], 5.0)]
    {
        assert_eq!(film(json!([nothing]))["digests"], whole["digests"]);
    }
    for (wrong, why) in [
        (json!({ "steps": [1, 2], "body": 1000, "point": [0, 0, 0], "force": [0, 0, 1] }), "body 1000 of"),
        (json!({ "steps": [1, 2], "body": 0, "point": [0, 0, 0], "force": [0, 0, 2e5] }), "at most 100000 N"),
        (json!({ "steps": [1, 2], "body": 0, "point": [0, 0, 1e39], "force": [0, 0, 1] }), "a force of"),
        (json!({ "steps": [1], "body": 0, "point": [0, 0, 0], "force": [0, 0, 1] }), "request: "),
    ] {
        let error = film(json!([wrong]))["error"].as_str().expect("an error").to_owned();
        assert!(error.contains(why), "{error}");
    }
    // Wheels of arenas follow their commands exactly, so that forces have no effect.
    ok(farsa(), &here, &format!("run foraging {few} --set trial.steps=30 --out team"));
    ok(farsa(), &here, "live team --html team.html --quiet");
    let live = &data(&here.join("team.html"))["live"];
    assert_eq!(live["about"]["pushes"], false);
    let pushes = json!([{ "steps": [1, 2], "body": 0, "point": [0, 0, 0], "force": [0, 0, 1] }]);
    let mut session = opened(live);
    let refused =
        asked(&mut session, &json!({ "do": "film", "individual": 0, "trial": { "number": 0 }, "pushes": pushes }));
    assert!(refused["error"].as_str().expect("an error").contains("has no bodies that can be pushed"));
}

#[test]
fn any_robot_of_a_team_is_recorded() {
    let here = scratch("live-robots");
    let few = "--population 4 --set evolution.parents=2 --generations 1 --quiet --set trial.steps=30";
    for (name, robots) in [("foraging", 10), ("predator-prey", 2)] {
        ok(farsa(), &here, &format!("run {name} {few} --out {name}"));
        ok(farsa(), &here, &format!("live {name} --html {name}.html --quiet"));
        let live = &data(&here.join(format!("{name}.html")))["live"];
        assert_eq!(live["about"]["robots"].as_array().expect("names").len(), robots, "{name}");
        let mut session = opened(live);
        let mut film = |watched: Value| {
            let request = json!({ "do": "film", "individual": 0, "trial": { "number": 0 }, "watched": watched });
            asked(&mut session, &request)
        };
        let (plain, first, last) = (film(Value::Null), film(json!(0)), film(json!(robots - 1)));
        assert_eq!(first["digests"], plain["digests"], "{name}: by default the first");
        assert_ne!(last["digests"], plain["digests"], "{name}: another robot sees something else");
        // The choice of the recorded robot has no effect on the episode.
        for other in [&first, &last] {
            for key in ["steps", "fitness", "success"] {
                assert_eq!(other[key], plain[key], "{name}: {key}");
            }
        }
        let error = film(json!(robots))["error"].as_str().expect("an error").to_owned();
        assert_eq!(error, format!("robot {robots} of {robots} (the first is 0)"));
    }
}
