//! Configurations of the original FARSA: written as experiment files, which the command checks and runs.

use std::fs;

use crate::tool::{content, farsa, ok, say, scratch};

const STAY: &str = include_str!("../../../farsa-original/tests/fixtures/stay.ini");
const TEAM: &str = include_str!("../../../farsa-original/tests/fixtures/team.ini");

#[test]
fn configurations_become_files_that_are_checked_and_run() {
    let here = scratch("configurations");
    fs::write(here.join("Stay Near.INI"), STAY).expect("a file");
    fs::write(here.join("team.conf"), TEAM).expect("a file");
    // By its content, too.
    fs::write(here.join("plain"), STAY).expect("a file");
    for (from, to) in [("team.conf", "team.toml"), ("plain", "plain.toml")] {
        let said = say(farsa(), &here, &format!("import {from}"));
        assert_eq!(said.code, Some(0), "{said:?}");
        assert!(said.out.starts_with(&format!("{to}: from {from}\n")), "{said:?}");
        assert!(said.err.lines().all(|line| line.starts_with("line ") || line.starts_with("by default: ")), "{said:?}");
        // The file begins with the same.
        let text = fs::read_to_string(here.join(to)).expect("the file");
        for line in said.err.lines() {
            assert!(text.contains(&format!("# - {line}\n")), "{line}: {text}");
        }
        let checked = ok(farsa(), &here, &format!("check {to}"));
        assert!(checked.contains("inputs") || checked.contains("sensors"), "{checked}");
        ok(farsa(), &here, &format!("run {to} --generations 1 --set episode.trials=1 --out r-{to}"));
    }
    // Its runs are those of the built-in experiment.
    ok(farsa(), &here, "run plain.toml --seed 7 --generations 3 --out file");
    ok(farsa(), &here, "run discrimination --seed 7 --generations 3 --out built-in");
    let log = |run: &str| fs::read_to_string(here.join(run).join("fitness.csv")).expect("the log");
    let numbers = |run: &str| {
        log(run).lines().skip(1).map(|line| line.split(',').take(4).collect::<Vec<_>>().join(",")).collect::<Vec<_>>()
    };
    assert_eq!(numbers("file"), numbers("built-in"));
    let genes = "--genes 12,250,3,77,140,91,200,33,180,64,5,129,240,48 --trials 20";
    let evaluated = |experiment: &str| {
        let text = ok(farsa(), &here, &format!("evaluate {experiment} {genes}"));
        text.lines().next().map(str::to_owned)
    };
    assert_eq!(evaluated("plain.toml"), evaluated("discrimination"));
    let json = ok(farsa(), &here, "import plain --out other.toml --json");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!((&json["file"], &json["left"][0]["line"]), (&"other.toml".into(), &54.into()));
}

#[test]
fn what_cannot_be_imported_is_refused_and_nothing_is_written() {
    let here = scratch("configurations-refused");
    fs::write(here.join("stay.ini"), STAY).expect("a file");
    fs::write(here.join("none.ini"), "x").expect("a file");
    fs::write(here.join("arm.ini"), STAY.replace("= Khepera\n", "= iCub\n")).expect("a file");
    fs::write(here.join("large.ini"), "#".repeat(1_000_001)).expect("a file");
    fs::write(here.join("there.toml"), "x").expect("a file");
    fs::write(here.join("a.gen"), "DYNAMICAL NN\n1\nEND\n").expect("a file");
    let before = content(&here);
    for (arguments, code, words) in [
        ("import stay.ini --strict", 2, &["stay.ini: 1 of its lines", "line 54: ", "nothing is written"][..]),
        ("import none.ini", 2, &["none.ini: no `[GROUP]`"]),
        ("import arm.ini", 2, &["arm.ini line 42: unknown wheeled robot `iCub`"]),
        ("import large.ini", 2, &["large.ini: "]),
        ("import missing.ini", 2, &["cannot read missing.ini"]),
        ("import stay.ini --out there.toml", 2, &["there.toml: there is one already"]),
        ("import stay.ini --out stay.json", 2, &["ends with .toml"]),
        ("import stay.ini --out Stay.toml", 2, &["`Stay` is the name of the experiment"]),
        ("import stay.ini --seed 3", 2, &["for genotypes"]),
        ("import stay.ini --set evolution.generations=3", 2, &["for genotypes"]),
        ("import stay.ini none.ini", 2, &["stands alone"]),
        ("import stay.ini --experiment discrimination --out r", 2, &["stands alone"]),
        ("import a.gen", 2, &["--experiment"]),
        ("import a.gen --experiment discrimination", 2, &["--out"]),
        ("import a.gen --experiment discrimination --out r --strict", 2, &["--strict is for configurations"]),
    ] {
        let said = say(farsa(), &here, arguments);
        assert_eq!(said.code, Some(code), "{arguments}: {said:?}");
        for word in words {
            assert!(said.err.contains(word), "{arguments}: no {word:?} in {said:?}");
        }
        assert!(said.out.is_empty() && content(&here) == before, "{arguments}: {said:?}");
    }
}
