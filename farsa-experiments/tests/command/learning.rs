//! Learning from a recorded trial, by files and commands only.

use std::fs;

use crate::tool::{farsa, ok, scratch};

const SCENE: &str = r#"
robot = { kind = "khepera" }
objects = [{ name = "lamp", kind = "cylinder", radius = 0.03, lamp = 1.0, at = [0.5, 0.5] }]
sensors = [{ kind = "light" }]
motors = [{ kind = "wheels" }]
episode = { steps = 100, trials = 2 }
reward = [{ kind = "approach", object = "lamp", over = "end" }]
"#;

#[test]
fn a_network_learns_from_the_replay_of_a_run() {
    let here = scratch("learning");
    let file = |name: &str, rest: &str| fs::write(here.join(name), format!("{rest}{SCENE}")).expect("a file");
    file("teacher.toml", "network = { kind = \"perceptron\" }\n");
    ok(farsa(), &here, "run teacher.toml --generations 3 --quiet");
    ok(farsa(), &here, "replay runs/teacher-1 --out demonstrations.csv --quiet");
    let head = "strategy = { name = \"learning\" }\nnetwork = { kind = \"elman\", hidden = 4 }\n\
                learning = { demonstrations = [\"demonstrations.csv\"], loss = \"cross-entropy\" }\n";
    file("pupil.toml", head);
    ok(farsa(), &here, "run pupil.toml --generations 12 --out whole --quiet");
    ok(farsa(), &here, "run pupil.toml --generations 5 --out parts --quiet");
    fs::remove_file(here.join("demonstrations.csv")).expect("the run has a copy");
    ok(farsa(), &here, "run --resume parts --generations 12 --quiet");
    for name in ["learning.csv", "fitness.csv", "champion.bin", "record.bin"] {
        let [whole, parts] = ["whole", "parts"].map(|run| fs::read(here.join(run).join(name)).expect(name));
        assert!(whole == parts, "{name}");
    }
    let text = fs::read_to_string(here.join("whole/learning.csv")).expect("a log");
    let errors: Vec<f64> = text.lines().skip(1).filter_map(|line| line.split(',').nth(2)?.parse().ok()).collect();
    assert!(errors.len() >= 11 && errors[errors.len() - 1] < 0.5 * errors[0], "{text}");
}
