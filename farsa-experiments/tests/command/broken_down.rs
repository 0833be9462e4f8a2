//! Trials that break down are counted everywhere and averaged nowhere.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::tool::{farsa, ok, say, scratch};

/// A whip whose torques exceed every speed, so that all trials break down. A largest torque of 0 leaves it at rest.
fn whip(here: &Path) {
    let link = "<geom type=\"capsule\" size=\"0.02\" fromto=\"0 0 0 0 0 -0.2\"/>";
    let model = format!(
        "<mujoco model=\"whip\"><worldbody><body name=\"a\"><joint name=\"a\" axis=\"0 1 0\"/>{link}\
         <body name=\"b\" pos=\"0 0 -0.2\"><joint name=\"b\" axis=\"0 1 0\"/>{link}</body></body></worldbody></mujoco>"
    );
    let file = "summary = \"torques that tear every trial apart\"\n\
        world = { engine = \"articulated\", time_step = 0.01, substeps = 1, floor = false }\n\
        robot = { kind = \"model\", file = \"whip.xml\" }\n\
        sensors = [{ kind = \"constant\", value = 1.0 }]\n\
        motors = [{ kind = \"joint-torque\", largest = 1e6 }]\n\
        network = { kind = \"wired\", activation = \"clamp\", bias = [1.0, 0.0], wires = [] }\n\
        episode = { steps = 50, trials = 2 }\n\
        reward = [{ kind = \"joint-speed\", weight = -1.0 }]\n\
        success = [{ term = \"joint-speed\", above = -1.0 }]\n";
    fs::write(here.join("whip.xml"), model).expect("the model");
    fs::write(here.join("whip.toml"), file).expect("the file");
}

fn json(here: &Path, arguments: &str) -> Value {
    serde_json::from_str(&ok(farsa(), here, arguments)).expect("JSON")
}

#[test]
fn trials_that_all_break_down_have_no_value() {
    let here = scratch("broken-down");
    whip(&here);
    let run = "run whip.toml --generations 2 --population 20";
    let said = say(farsa(), &here, &format!("{run} --out o"));
    assert!(
        said.out.contains("no fitness, all evaluations of this generation failed; 40 evaluations failed\n"),
        "{said:?}"
    );
    assert!(said.err.contains("generation 1: all 20 failed; 2 of 2 generations, "), "{said:?}");

    let tested = ok(farsa(), &here, "test o --trials 3");
    let summary = "\nsuccess: no value\nbroken down: 3 of 3 (100.0 %)\nfitness of a trial: no value\nfitness of a run: mean of 2 trials\nline 0 of the test failed: ";
    assert!(tested.contains(summary), "{tested}");
    let found = json(&here, "test o --trials 3 --json");
    assert_eq!((&found["fitness"], &found["trials"], &found["broken_down"]), (&Value::Null, &3.into(), &3.into()));
    let protocol = ok(farsa(), &here, "test o --protocol noise --trials 2");
    let row = protocol.lines().find(|line| line.starts_with("0.05")).expect("a case");
    assert_eq!(row.split_whitespace().collect::<Vec<_>>()[1..6], ["2", "2", "–", "–", "–"], "{protocol}");
    let evaluated = ok(farsa(), &here, "evaluate whip.toml --trials 4 --genes 0");
    assert!(
        evaluated.contains("mean_fitness NaN\n") && evaluated.contains("success_rate NaN\nbroken_down 4\n"),
        "{evaluated}"
    );

    let table = ok(farsa(), &here, "merge o --quiet");
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let field = |name: &str| rows[1][rows[0].iter().position(|other| *other == name).expect(name)];
    assert_eq!(["failed", "test trials", "test broken down"].map(field), ["40", "3", "3"]);
    assert_eq!(["best", "mean", "highest best", "test success", "test fitness"].map(field), [""; 5]);

    ok(farsa(), &here, "report o --md o.md --html o.html");
    let page = fs::read_to_string(here.join("o.md")).expect("the page");
    assert!(
        page.contains("| run | champion of | trials | broken down | success | fitness | trial by trial |"),
        "{page}"
    );
    assert!(page.contains("| o | generation 1 | 3 | 3 | – | – | –, – |"), "{page}");

    // No trial of a replay or a page has a fitness.
    let said = say(farsa(), &here, "replay o --out o.csv --quiet");
    assert_eq!(said.code, Some(0), "{said:?}");
    let said = say(farsa(), &here, "replay o --out o2.csv").err;
    let words = [" steps, no fitness; trial 0 broke down: ", "; trial 1 broke down: "];
    assert!(words.iter().all(|word| said.contains(word)), "{said}");
    ok(farsa(), &here, "replay o --html o-replay.html");
    let page = fs::read_to_string(here.join("o-replay.html")).expect("the page");
    assert!(page.contains("trial 0: broken down: ") && page.contains("fitness of the trial"), "no failure on the page");

    let said = ok(farsa(), &here, &format!("{run} --replications 2 --out runs"));
    assert!(said.contains("champions without a fitness: 2 of 2\n"), "{said}");
    assert!(said.lines().nth(1).is_some_and(|line| line.contains("  –  ") && line.ends_with(" 40")), "{said}");
    let said = ok(farsa(), &here, &format!("{run} --replications 2 --out runs --test 3"));
    let cells: Vec<&str> = said.lines().nth(1).expect("a run").split_whitespace().collect();
    assert_eq!(cells[cells.len() - 4..], ["40", "–", "–", "3"], "{said}");
    fs::write(
        here.join("grid.toml"),
        "experiment = \"whip.toml\"\nevolution.generations = 1\nevolution.population = 20\n\
        [grid]\nepisode.steps = [50, 60]\n",
    )
    .expect("the sweep");
    let said = ok(farsa(), &here, "sweep grid.toml --out grid --test 2");
    assert!(
        said.lines().next().is_some_and(|head| head.contains("  failed  median success  broken down  without value  "))
    );
    let cells: Vec<&str> = said.lines().nth(1).expect("a point").split_whitespace().collect();
    assert_eq!(cells[..10], ["1", "1", "of", "1", "–", "–", "20", "–", "2", "1"], "{said}");
}
