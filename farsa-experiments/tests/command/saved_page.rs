//! Runs, genes, random individuals and other settings of interactive pages, read by the command.

use std::fs;

use farsa_lab::advanced::LiveSession;
use serde_json::{Value, json};

use crate::live::{asked, data, evolving, opened, parsed};
use crate::tool::{farsa, ok, say, scratch};

/// Content of the file in which a page saves an evolution.
pub(crate) fn saved_run(live: &Value, mark: &Value) -> Value {
    let mut saved = json!({ "format": "farsa-saved-run", "version": 1, "config": live["script"]["config"] });
    for key in ["generation", "state_crc32"] {
        saved[key] = mark[key].clone();
    }
    saved
}

#[test]
fn a_saved_run_continues_only_from_its_own_state() {
    let here = scratch("live-saved");
    ok(farsa(), &here, "run double-pole --population 10 --set evolution.parents=2 --generations 2 --out one --quiet");
    ok(farsa(), &here, "live one --html one.html --quiet");
    let live = &data(&here.join("one.html"))["live"];
    let mark = asked(&mut evolving(live), &json!({ "do": "state" }));
    assert_eq!(mark["generation"], 2);
    let write = |saved: &Value| fs::write(here.join("s.json"), saved.to_string()).expect("a file");
    write(&saved_run(live, &mark));
    ok(farsa(), &here, "run --from s.json --out more --generations 4 --quiet");
    ok(farsa(), &here, "run --resume one --generations 4 --quiet");
    let of = |run: &str| fs::read(here.join(run).join("record.bin")).expect("a file");
    assert!(of("one") == of("more"));
    let log = |run: &str| fs::read_to_string(here.join(run).join("fitness.csv")).expect("a file").lines().count();
    for (line, code, why) in [
        ("run --from s.json --out less --generations 1", 2, "s.json: has finished 2 generations already"),
        ("run double-pole --from s.json", 2, "cannot be used with"),
        ("run --from one.html --out page", 2, "one.html: no run that a page has saved: expected value"),
        ("run --from s.json --out more", 2, "more"),
    ] {
        let said = say(farsa(), &here, line);
        assert!(said.code == Some(code) && said.err.contains(why), "{line}: {said:?}");
    }
    let mut other = saved_run(live, &mark);
    other["state_crc32"] = 1.into();
    write(&other);
    let said = say(farsa(), &here, "run --from s.json --out other");
    assert!(said.code == Some(2) && said.err.contains("the state after 2 generations differs"), "{said:?}");
    assert_eq!(log("other"), 3);
}

#[test]
fn a_page_draws_random_individuals_and_writes_genes() {
    let here = scratch("live-newcomer");
    ok(farsa(), &here, "run double-pole --population 10 --set evolution.parents=2 --generations 3 --out one --quiet");
    ok(farsa(), &here, "live one --generations 1 --individual 7 --html one.html --quiet");
    let live = &data(&here.join("one.html"))["live"];
    let about = &live["about"]["individuals"][0];
    assert_eq!((&about["generation"], &about["individual"]), (&json!(1), &json!(7)));
    let mut session = opened(live);
    let film = |session: &mut LiveSession, individual: u32| {
        let request = json!({ "do": "film", "individual": individual, "trial": { "number": 0 } });
        asked(session, &request)
    };
    let replay = |which: &str| {
        ok(farsa(), &here, &format!("replay {which} --trial 0 --html replay.html --quiet"));
        data(&here.join("replay.html"))["episodes"][0]["data"].clone()
    };
    assert_eq!(film(&mut session, 0)["film"]["data"], replay("one --generation 1 --individual 7"));

    // A newcomer is the first individual of the run with that seed.
    let config = live["script"]["config"].as_str().expect("a text");
    let script = json!({ "config": config.replacen("seed = 1", "seed = 9", 1), "individuals": [], "newcomer": true });
    let open = |script: &Value| LiveSession::open(&farsa_experiments::laboratory(), &script.to_string());
    let mut newcomer = open(&script).expect("an agent");
    let line = "run double-pole --seed 9 --population 10 --set evolution.parents=2 --generations 1 --out nine --quiet";
    ok(farsa(), &here, line);
    assert_eq!(film(&mut newcomer, 0)["film"]["data"], replay("nine --generation 0 --individual 0"));
    let individual = asked(&mut newcomer, &json!({ "do": "individual", "individual": 0 }));
    let added = asked(&mut session, &json!({ "do": "add", "individual": individual }));
    assert_eq!(added, json!({ "individual": 1 }));

    // Its genes are a file of the command.
    let genes = asked(&mut session, &json!({ "do": "genotype", "individual": 1 }));
    fs::write(here.join("n.gen"), genes["text"].as_str().expect("a text")).expect("a file");
    let evaluated = parsed(&ok(farsa(), &here, "evaluate double-pole --genes-file n.gen --trials 30 --seed 4 --json"));
    let request = json!({ "do": "fresh", "individual": 1, "seed": 4, "first": 0, "count": 30 });
    let fresh = asked(&mut session, &request);
    let values = fresh["fitness"].as_array().expect("numbers");
    let mean = values.iter().filter_map(Value::as_f64).sum::<f64>() / values.len() as f64;
    assert!((evaluated["mean_fitness"].as_f64().expect("a number") - mean).abs() < 1e-9, "{evaluated}");

    // Another configuration of the same genes, or one that they do not fit.
    let changed = |from: &str, to: &str| {
        assert!(config.contains(from), "{from}");
        json!({ "config": config.replacen(from, to, 1), "individuals": live["script"]["individuals"] })
    };
    let mut slow = open(&changed("gravity = 9.8", "gravity = 1.0")).expect("an agent");
    assert_ne!(film(&mut slow, 0)["film"]["data"], film(&mut session, 0)["film"]["data"]);
    let error = open(&changed("hidden = 1", "hidden = 2")).err().expect("an error").to_string();
    assert!(error.contains("parameters where"), "{error}");
    let real = "run double-pole --strategy snes --generations 1 --out real --quiet";
    ok(farsa(), &here, real);
    ok(farsa(), &here, "live real --html real.html --quiet");
    let mut session = opened(&data(&here.join("real.html"))["live"]);
    let refused = asked(&mut session, &json!({ "do": "genotype", "individual": 0 }));
    assert_eq!(refused["error"], "its genes are no integers");
}
