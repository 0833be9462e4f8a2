//! Checks of published figures by one file: runs, tests, verdicts and exit codes.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::tool::{content, farsa, json, ok, own, results, say, scratch};

const FILE: &str = r#"
[[checks]]
name = "stops"
experiment = "cart"
condition = "smooth"
replications = 3
evolution.generations = 4
trial.steps = 60
test.trials = 8
measure = "trials"
published = "none"
source = "here"
expected = [0, 1]

[[checks]]
name = "improves"
experiment = "cart"
seed = 7
replications = 6
trial.steps = 60
measure = "median"
column = "fitness.best"
published = 0.5
source = "Garcia1998"
expected = [1e6, inf]

[checks.evolution]
generations = 30

[checks.quick]
evolution.generations = 2
expected = [-inf, 1e6]
"#;

#[test]
fn checks_are_runs_with_verdicts() {
    let here = scratch("checks-verdicts");
    fs::write(here.join("two.toml"), FILE).expect("the file");
    let listed = json(&ok(own(), &here, "sweep two.toml --quick --list --json"));
    assert_eq!(fs::read_dir(&here).expect("a directory").count(), 1, "a list begins nothing");
    assert_eq!((&listed["checks"][0]["finished"], &listed["checks"][0]["verdict"]), (&0.into(), &"undecided".into()));

    // Interrupted after one check: the other has no run yet.
    let text = ok(own(), &here, "sweep two.toml --quick --point 1 -q --json");
    assert_eq!(json(&text)["checks"].as_array().map(Vec::len), Some(1));
    assert!(!here.join("runs/two-quick/improves").exists());
    let quick = say(own(), &here, "sweep two.toml --quick --threads 2 --md two.md");
    assert_eq!(quick.code, Some(0), "{quick:?}");
    assert_eq!(quick.err.matches("all 4 generations are finished already").count(), 3, "{quick:?}");
    let row = |name: &str| quick.out.lines().find(|line| line.starts_with(name)).expect(name).to_owned();
    for (name, words) in [
        ("stops", ["successful trials", "none (here)", "0.000 to 1.000 ", "3 of 3", "agrees"]),
        ("improves", ["median fitness.best", "0.5 (Garcia1998)", "<= 1000000 (quick)", "6 of 6", "agrees"]),
    ] {
        for word in words {
            assert!(row(name).contains(word), "no {word} in {}", row(name));
        }
    }
    assert_eq!(fs::read_to_string(here.join("two.md")).expect("the table").lines().count(), 5);

    // Each run is what its command alone makes, and each share follows from its tests.
    ok(own(), &here, "run cart --seed 8 --generations 2 --set trial.steps=60 --out single -q");
    assert_eq!(results(&here.join("runs/two-quick/improves/cart-rough-8")), results(&here.join("single")));
    let mut trials = [0; 2];
    for seed in 1..=3 {
        let table = fs::read_to_string(here.join(format!("runs/two-quick/stops/cart-smooth-{seed}/test.csv")));
        let table = table.expect("a test");
        let successes = table.lines().skip(1).map(|line| line.split(',').nth(3) == Some("true"));
        successes.for_each(|success| trials[usize::from(success)] += 1);
    }
    assert_eq!(trials[0] + trials[1], 24);
    let share = f64::from(trials[1]) / 24.0;
    let before = content(&here.join("runs"));
    let again = json(&ok(own(), &here, "sweep two.toml --quick --json -q"));
    assert_eq!(again["checks"][0]["ours"].as_f64(), Some(share));
    assert_eq!(ok(own(), &here, "sweep two.toml --quick"), quick.out);
    assert_eq!(ok(own(), &here, "sweep two.toml --quick --list"), quick.out);
    assert_eq!(content(&here.join("runs")), before, "nothing is repeated");

    // The full values have another folder, and another range.
    let full = say(own(), &here, "sweep two.toml -q --json");
    assert_eq!(full.code, Some(1), "{full:?}");
    assert!(full.err.contains("of 2 checks 1 differs: improves"), "{full:?}");
    assert_eq!(json(&full.out)["checks"][1]["verdict"], "differs");
    assert_eq!(content(&here.join("runs/two-quick")), before);
}

#[test]
fn an_error_of_a_check_leaves_the_others() {
    let here = scratch("checks-error");
    let file = FILE.replace("measure = \"trials\"", "measure = \"mean\"\ncolumn = \"test.att [m]\"");
    fs::write(here.join("two.toml"), file).expect("the file");
    let said = say(own(), &here, "sweep two.toml --quick");
    assert_eq!(said.code, Some(1), "{said:?}");
    assert!(said.out.contains("stops: two.toml line 11: unknown column `test.att [m]`; the nearest is "), "{said:?}");
    assert!(said.out.contains("test.at [m]") && said.err.contains("of 2 checks 1 failed: stops"), "{said:?}");
    let row = said.out.lines().find(|line| line.starts_with("improves")).expect("the other check");
    assert!(row.ends_with("agrees"), "{said:?}");
    // A damaged run, too.
    fs::write(here.join("two.toml"), FILE).expect("the file");
    fs::write(here.join("runs/two-quick/improves/cart-rough-8/checkpoint.bin"), "x").expect("a file");
    let said = say(own(), &here, "sweep two.toml --quick");
    assert_eq!(said.code, Some(1), "{said:?}");
    assert!(said.err.contains("1 failed: improves") && said.out.contains("checkpoint.bin"), "{said:?}");
    let row = said.out.lines().find(|line| line.starts_with("stops")).expect("the other check");
    assert!(row.ends_with("agrees"), "{said:?}");
}

#[test]
fn checks_are_refused_before_they_begin() {
    let here = scratch("checks-refused");
    let refused = |text: &str, arguments: &str, word: &str| {
        fs::write(here.join("my.toml"), text).expect("the file");
        let said = say(own(), &here, &format!("sweep my.toml {arguments}"));
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""), "{text}: {said:?}");
        assert!(said.err.contains(word), "{text}: no {word:?} in {said:?}");
        assert!(!here.join("runs").exists(), "{text}");
    };
    for (old, new, word) in [
        ("\"smooth\"", "\"smoth\"", "my.toml line 5: unknown condition `smoth`; the nearest is `smooth`"),
        (
            "name = \"stops\"\nexperiment = \"cart\"",
            "name = \"stops\"\nexperiment = \"cat\"",
            "my.toml line 4: unknown experiment `cat`",
        ),
        ("trial.steps", "trial.stps", "my.toml line 8: unknown key `trial.stps`; the nearest is `trial.steps`"),
        ("\"trials\"", "\"trails\"", "my.toml line 10: unknown measure `trails`; the nearest is `trials`"),
        (
            "fitness.best",
            "fitness.bets",
            "my.toml line 22: unknown column `fitness.bets`; the nearest is `fitness.best`",
        ),
    ] {
        assert!(FILE.contains(old), "{old}");
        refused(&FILE.replacen(old, new, 1), "", word);
    }
    refused(FILE, "--point 3", "--point 3: there are 2");
    refused(FILE, "--html page.html", "--html: my.toml has [[checks]]");
    refused(FILE, "--archive all.farsa", "--archive: my.toml has [[checks]]");
    refused(FILE, "--test 3", "--test: my.toml has [[checks]]");
    refused("experiment = \"cart\"\n[grid]\ntrial.steps = [5, 6]\n", "--quick", "--quick: my.toml has no [[checks]]");
}

/// Sources are keys of REFERENCES.md or pages of results, and all experiments of `farsa list` have a check.
#[test]
fn the_checks_of_the_repository_have_sources() {
    let here = scratch("checks-repository");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let study = root.join("studies/all.toml");
    let references = fs::read_to_string(root.join("REFERENCES.md")).expect("the references");
    let mut known = BTreeSet::new();
    for quick in ["", "--quick"] {
        let listed = json(&ok(farsa(), &here, &format!("sweep {} --list --json {quick}", study.display())));
        for check in listed["checks"].as_array().expect("a list") {
            let source = check["source"].as_str().expect("a text");
            let is_key = references.contains(&format!("\n- **{source}** "));
            assert!(is_key || root.join(source).is_file(), "{check}");
            assert_eq!(is_key, check["published"] != "none", "{check}");
            known.insert(check["experiment"].as_str().expect("a name").to_owned());
        }
    }
    let listed = json(&ok(farsa(), &here, "list --json"));
    let names: BTreeSet<String> = listed
        .as_array()
        .expect("a list")
        .iter()
        .map(|entry| entry["name"].as_str().expect("a name").to_owned())
        .collect();
    assert_eq!(known, names);
}
