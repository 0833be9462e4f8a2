//! Looking at trials: pages and pictures of a run.

use std::fs;

use crate::tool::{farsa, ok, own, say, scratch};

/// The data of a page.
fn data(html: &str) -> serde_json::Value {
    let (_, rest) = html.rsplit_once("id=\"data\">").expect("the data");
    let (text, _) = rest.split_once("</script>").expect("their end");
    serde_json::from_str(text).expect("JSON")
}

#[test]
fn a_page_holds_the_lives_that_were_asked_for() {
    let here = scratch("look-page");
    for seed in [1, 2] {
        ok(own(), &here, &format!("run cart --generations 2 --seed {seed} --out r{seed} --quiet"));
    }
    let said = say(own(), &here, "replay r1 --html all.html --compare r2");
    assert_eq!((said.code, said.out.as_str()), (Some(0), ""), "{said:?}");
    let page = data(&fs::read_to_string(here.join("all.html")).expect("the page"));
    let names: Vec<&str> =
        page["episodes"].as_array().expect("episodes").iter().filter_map(|l| l["name"].as_str()).collect();
    assert_eq!(names.len(), 6);
    // The best trial of each run first, and the best of both next to each other.
    let parts = |name: &str| -> (String, f64, String) {
        let (trial, rest) = name.split_once(": ").expect("a trial");
        let (came, run) = rest.split_once("; ").expect("a run");
        let (success, fitness) = came.split_once(", ").expect("an outcome");
        assert!(["success", "no success"].contains(&success), "{name}");
        (trial.to_owned(), fitness.parse().expect("a number"), run.to_owned())
    };
    for (run, names) in ["rough 1, generation 1", "rough 2, generation 1"].into_iter().zip(names.chunks(3)) {
        let found: Vec<_> = names.iter().map(|name| parts(name)).collect();
        assert!(found.iter().all(|(_, _, of)| of.starts_with(run)), "{names:?}");
        assert!(found.windows(2).all(|two| two[0].1 >= two[1].1), "{names:?}");
        let mut trials: Vec<&str> = found.iter().map(|(trial, ..)| trial.as_str()).collect();
        trials.sort_unstable();
        assert_eq!(trials, ["trial 0", "trial 1", "trial 2"]);
    }
    assert_eq!(page["beside"], 3);
    ok(own(), &here, "replay r1 --trial best --html best.html");
    let best = data(&fs::read_to_string(here.join("best.html")).expect("the page"));
    assert_eq!((&best["episodes"][0], best["episodes"].as_array().map(Vec::len)), (&page["episodes"][0], Some(1)));
    assert_eq!(best["beside"], serde_json::Value::Null);
    let episode = &page["episodes"][0];
    assert_eq!((&episode["ticks"], &episode["bodies"]), (&500.into(), &serde_json::json!([])));
    assert_eq!(episode["channels"][2]["unit"], "N");

    ok(own(), &here, "replay r1 --generation 0 --individual 3 --trial 1 --html one.html");
    let page = data(&fs::read_to_string(here.join("one.html")).expect("the page"));
    assert_eq!(page["episodes"].as_array().map(Vec::len), Some(1));

    // A page takes the place of a page, and of nothing else.
    ok(own(), &here, "replay r1 --trial best --html one.html");
    assert_eq!(data(&fs::read_to_string(here.join("one.html")).expect("the page")), best);
    ok(own(), &here, "report r1 --html one.html");
    let notes = fs::read_to_string(here.join("best.html")).expect("the page").replace("<h1", "<p>mine</p><h1");
    fs::write(here.join("notes.html"), &notes).expect("a file");
    for (arguments, complaint) in [
        // Refused before anything runs.
        ("replay r1 --trial 3 --html notes.html", "there is one already, without an intact mark"),
        ("replay r1 --trial 3 --html none/new.html", "there is no folder none"),
        ("replay r1 --html new.html --compare r3", "there is no such directory"),
        ("replay r1 --trial 3 --html new.html", "trial 3 of 3"),
        ("replay r1 --trial 3 --out new.csv", "trial 3 of 3"),
        ("replay r1 --trial bets --html new.html", "neither a number from 0 nor `best`"),
        ("draw r1 --out new.svg", "have no bodies to draw"),
    ] {
        let said = say(own(), &here, arguments);
        assert!(said.code != Some(0) && said.err.contains(complaint), "{arguments}: {said:?}");
    }
    assert_eq!(fs::read_to_string(here.join("notes.html")).expect("the file"), notes);
    assert!(["new.html", "new.csv", "new.svg"].into_iter().all(|name| !here.join(name).exists()));
}

#[test]
fn changes_are_shown_beside_the_whole_controller() {
    let here = scratch("look-lesion");
    let genes = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/minimal-cognition.gen");
    fs::copy(genes, here.join("own.gen")).expect("a copy");
    ok(farsa(), &here, "import own.gen --experiment minimal-cognition --out r --quiet");
    let line = "replay r --trial 2 --lesion sensor:rays";
    let told = ok(farsa(), &here, &format!("{line} --html both.html --json"));
    let told: serde_json::Value = serde_json::from_str(&told).expect("JSON");
    let page = data(&fs::read_to_string(here.join("both.html")).expect("the page"));
    let names: Vec<&str> =
        page["episodes"].as_array().expect("episodes").iter().filter_map(|l| l["name"].as_str()).collect();
    let [intact, changed] = names[..] else { panic!("{names:?}") };
    assert!(!intact.contains("with sensor:rays") && changed.contains("; with sensor:rays; "), "{names:?}");
    assert_eq!((&page["beside"], &told["lesion"]["list"]), (&1.into(), &"sensor:rays".into()));
    assert_eq!(told["lesion"]["trials"][0]["trial"], 2);
    let fitness = [&told["fitness"], &told["lesion"]["fitness"]].map(|fitness| fitness.as_f64().expect("a number"));
    assert!(fitness[0] > fitness[1], "{fitness:?}");
    let said = told["summary"].as_str().expect("words");
    assert!(said.lines().nth(1).is_some_and(|line| line.starts_with("with sensor:rays: ")), "{said}");

    // The steps are those with the change, and without it those that they always were.
    let [plain, with] = ["replay r --trial 2 --quiet", &format!("{line} --quiet")].map(|line| ok(farsa(), &here, line));
    assert!(plain != with && plain.lines().next() == with.lines().next());
    let answers = |csv: &str| csv.lines().last().map(str::to_owned);
    assert_ne!(answers(&plain), answers(&with));
    for (arguments, complaint) in [
        ("replay r --lesion neuron:9", "unknown neuron `9`"),
        ("replay r --lesion neuron:1 --compare r --html x.html", "cannot be used with"),
        ("replay r --lesion neuron:1 --protocol noise", "cannot be used with"),
    ] {
        let said = say(farsa(), &here, arguments);
        assert!(said.code == Some(2) && said.err.contains(complaint), "{arguments}: {said:?}");
    }
}

#[test]
fn a_moment_is_drawn_from_a_named_camera() {
    let here = scratch("look-draw");
    let small = "--set evolution.population=6 --set evolution.parents=2 --set trial.steps=40";
    ok(farsa(), &here, &format!("run reach-grasp-lift --generations 1 {small} --out r --quiet"));
    ok(farsa(), &here, "draw r --trial 2 --time 0.2 --camera front --size 120x80 --out a.png");
    let bytes = fs::read(here.join("a.png")).expect("the picture");
    assert_eq!(bytes[..8], *b"\x89PNG\r\n\x1a\n");
    assert_eq!((&bytes[16..20], &bytes[20..24]), (&[0, 0, 0, 120][..], &[0, 0, 0, 80][..]));
    assert!(ok(farsa(), &here, "draw r --trial best --out best.svg").contains(", best trial "));
    // The default is the best trial, which a page shows first.
    ok(farsa(), &here, "draw r --out a.svg");
    let svg = fs::read_to_string(here.join("a.svg")).expect("the picture");
    assert!(svg.starts_with("<svg") || svg.starts_with("<?xml"), "{}", &svg[..80]);
    assert_eq!(svg, fs::read_to_string(here.join("best.svg")).expect("the picture"));
    let page = ok(farsa(), &here, "replay r --html page.html --json");
    let page: serde_json::Value = serde_json::from_str(&page).expect("a summary");
    let fitness = |trial: &serde_json::Value| trial["fitness"].as_f64().expect("a fitness");
    let trials = page["trials"].as_array().expect("trials");
    let best = trials.iter().rev().max_by(|a, b| fitness(a).total_cmp(&fitness(b))).expect("a trial");
    let caption = format!("best trial {}, 0.40 s, ", best["trial"]);
    assert!(svg.contains(&caption) && ["reach", "grasp", "lift"].iter().any(|phase| svg.contains(phase)), "{caption}");
    fs::write(here.join("notes.png"), "mine").expect("a file");
    for (arguments, complaint) in [
        ("draw r --camera frnt --out b.png", "the nearest is `front`"),
        ("draw r --time 0.5 --out b.png", "from 0.01 to 0.4 s"),
        ("draw r --out b.gif", "ends in .svg or .png"),
        ("draw r --frames 4 --out b.svg", "with --frames its name ends in .png"),
        ("draw r --frames 0 --out b.png", "'--frames <N>'"),
        ("draw r --frames 4 --time 0.1 --out b.png", "cannot be used with"),
        ("draw r --size 8x8 --out b.png", "16 to 8192"),
        ("draw r --out notes.png", "there is one already"),
    ] {
        let said = say(farsa(), &here, arguments);
        assert!(said.code != Some(0) && said.err.contains(complaint), "{arguments}: {said:?}");
    }
    assert_eq!(bytes, fs::read(here.join("a.png")).expect("the picture"));
    // Forty steps of 0.01 s as four pictures.
    let told = ok(farsa(), &here, "draw r --frames 4 --size 60x40 --out film.png --json");
    assert!(told.contains("\"frames\": 4") && told.contains("0.01 s to 0.40 s, 4 pictures"), "{told}");
    let film = fs::read(here.join("film.png")).expect("the pictures");
    let chunks = |name: &[u8]| film.windows(4).filter(|four| *four == name).count();
    assert_eq!([b"acTL", b"fcTL", b"IDAT", b"fdAT"].map(|name| chunks(name)), [1, 4, 1, 3]);
}
