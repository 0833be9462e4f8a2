//! Learning from demonstrations: networks of every kind learn what a wired one does, from the CSV of its trials.
#![allow(missing_docs)]

use farsa_compose::ComposedExperiment;
use farsa_lab::advanced::{Iteration, Recording};
use farsa_lab::strategy::strategies;
use farsa_lab::{EpisodeId, Error, Evaluation, Evaluator, Experiment as _, Settings};

/// A robot that drives to a lamp, wired by hand.
const TEACHER: &str = r#"
robot = { kind = "khepera" }
objects = [{ name = "lamp", kind = "cylinder", radius = 0.03, lamp = 1.0, at = [0.5, 0.5] }]
sensors = [{ kind = "light" }]
motors = [{ kind = "wheels" }]
episode = { steps = 150, trials = 3, ends = ["collision"] }
reward = [{ kind = "approach", object = "lamp", over = "end" }]
"#;

const WIRED: &str = r#"
[network]
kind = "wired"
bias = [0.6, 0.6]
wires = [
    { from = ["light 1", "light 2", "light 3"], to = "wheels right", weight = 0.6 },
    { from = ["light 4", "light 5", "light 6"], to = "wheels left", weight = 0.6 },
]
"#;

fn made(text: &str) -> Result<Box<dyn Evaluator>, Error> {
    let made = ComposedExperiment::from_text("learn.toml", text, strategies())?;
    made.prepare("", &Settings::new(made.settings(""))?)
}

/// Trials of the teacher as CSV, as the command writes it, and their mean fitness.
fn demonstrations() -> (String, f64) {
    let mut teacher = made(&format!("{TEACHER}{WIRED}")).expect("a teacher");
    let parameters = vec![0.0; teacher.info().parameters.len()];
    let (mut lines, mut fitness) = (Vec::new(), 0.0);
    for trial in 0..3 {
        let mut recording = Recording::new(teacher.info().schema);
        let id = EpisodeId { seed: 1, trial, ..EpisodeId::default() };
        fitness += teacher.evaluate(Evaluation::new(&parameters, id), Some(&mut recording)).terms[0] / 3.0;
        if trial == 0 {
            lines.push(format!("trial,step,{}", recording.schema().columns().join(",")));
        }
        for tick in 0..recording.times().len() {
            let row: Vec<String> = recording.row(tick).map(|value| format!("{value:?}")).collect();
            lines.push(format!("{trial},{tick},{}", row.join(",")));
        }
    }
    (lines.join("\n"), fitness)
}

/// A pupil with this network.
fn pupil(network: &str, learning: &str, csv: &str) -> String {
    format!(
        "strategy = {{ name = \"learning\" }}\n{TEACHER}\n[network]\n{network}\n[learning]\ndemonstrations = [\"a.csv\"]\n{learning}\n\
         [files]\n\"a.csv\" = '''{csv}'''\n"
    )
}

#[test]
fn every_kind_of_network_learns_what_the_teacher_does() {
    let (csv, teacher) = demonstrations();
    assert!(teacher > 0.1, "{teacher}");
    for (network, learning) in [
        ("kind = \"perceptron\"\nweights = [-20.0, 20.0]", "loss = \"cross-entropy\""),
        ("kind = \"perceptron\"\norder = \"outputs\"\nweights = [-20.0, 20.0]", "loss = \"cross-entropy\""),
        ("kind = \"leaky\"\nhidden = 6\nweights = [-20.0, 20.0]", "rate = 0.03"),
        (
            "kind = \"ctrnn\"\nneurons = 6\ntime_constants = [0.05, 1.0]\nweights = [-20.0, 20.0]",
            "loss = \"cross-entropy\"",
        ),
        ("kind = \"elman\"\nhidden = 6\nweights = [-20.0, 20.0]", "loss = \"cross-entropy\"\nbatch = 2"),
        ("kind = \"feed-forward\"\nhidden = 6\nweights = [-20.0, 20.0]", ""),
    ] {
        let mut evaluator = made(&pupil(network, learning, &csv)).unwrap_or_else(|error| panic!("{error}"));
        let learner = evaluator.learner().expect("a learner");
        let mut state = learner.initial_state(7);
        let first = learner.iterate(&mut state, 7, 0).expect("an iteration");
        let mut last = first;
        for generation in 1..60 {
            last = learner.iterate(&mut state, 7, generation).expect("an iteration");
        }
        let Iteration { after, .. } = last;
        assert!(after < 0.3 * first.before && after < 0.03, "{network}: {} to {after}", first.before);
        let learned: Vec<f32> = learner.learned(&state).into_iter().map(|value| value as f32).collect();
        let parameters = evaluator.info().parameters;
        assert_eq!(learned.len(), parameters.len(), "{network}");
        // Before the ways part, it drives as the teacher does. A network with memory begins at rest.
        let tolerance = if network.contains("ctrnn") || network.contains("elman") { 0.25 } else { 0.05 };
        let mut recording = Recording::new(evaluator.info().schema);
        let id = EpisodeId { seed: 1, trial: 0, ..EpisodeId::default() };
        let outcome = evaluator.evaluate(Evaluation::new(&learned, id), Some(&mut recording));
        let columns = recording.schema().columns();
        let head: Vec<&str> = csv.lines().next().expect("a head").split(',').skip(2).collect();
        for tick in 0..5 {
            let row: Vec<f64> = recording.row(tick).collect();
            let taught = csv.lines().nth(1 + tick).expect("a line").split(',').skip(2);
            for (name, taught) in head.iter().zip(taught).filter(|(name, _)| name.starts_with("output.")) {
                let place = columns.iter().position(|column| column == name).expect("a column");
                let taught: f64 = taught.parse().expect("a number");
                assert!(
                    (row[place] - taught).abs() < tolerance,
                    "{network}: {name} is {} instead of {taught}",
                    row[place]
                );
            }
        }
        assert!(outcome.is_finite(), "{outcome:?}");
    }
}

/// An iteration depends on state, seed and generation only.
#[test]
fn learning_continues_from_its_state() {
    let (csv, _) = demonstrations();
    let text = pupil("kind = \"elman\"\nhidden = 4", "", &csv);
    let run = |from: Option<(Vec<f64>, u32)>, to: u32| {
        let mut evaluator = made(&text).expect("an evaluator");
        let learner = evaluator.learner().expect("a learner");
        let (mut state, begin) = from.unwrap_or_else(|| (learner.initial_state(3), 0));
        for generation in begin..to {
            learner.iterate(&mut state, 3, generation).expect("an iteration");
        }
        state
    };
    let bits = |state: Vec<f64>| state.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    assert_eq!(bits(run(Some((run(None, 2), 2)), 5)), bits(run(None, 5)));
}

#[test]
fn wrong_demonstrations_are_refused_with_file_line_and_column() {
    let csv = "trial,sensor.light 1,sensor.light 2,sensor.light 3,sensor.light 4,sensor.light 5,sensor.light 6,sensor.light 7,\
               sensor.light 8,output.wheels left,output.wheels right\n0,1,1,1,1,1,1,1,1,0.5,0.5\n";
    let perceptron = "kind = \"perceptron\"";
    assert!(made(&pupil(perceptron, "", csv)).is_ok());
    for (network, learning, from, to, wanted) in [
        (perceptron, "", "sensor.light 3,", "", "a.csv: lacks the column `sensor.light 3`"),
        (perceptron, "", "0.5,0.5", "0.5,1.5", "a.csv: line 2: 1.5 of column `output.wheels right` is outside 0 to 1"),
        (perceptron, "", "0,1,1", "0,x,1", "a.csv: line 2: `x` of column `sensor.light 1` is no number"),
        (perceptron, "", "0,1,1", "0,NaN,1", "a.csv: line 2: `NaN` of column `sensor.light 1` is no number"),
        (perceptron, "", "0,1,1,1,1,1,1,1,1,0.5,0.5\n", "", "a.csv: has no lines below its head"),
        (perceptron, "", "0.5,0.5\n", "0.5\n", "found record with 10 fields"),
        (perceptron, "epochs = 0", "a", "a", "0 is outside 1 to 10000"),
        (perceptron, "loss = \"cross-entropi\"", "a", "a", "the nearest is `cross-entropy`"),
        ("kind = \"perceptron\"\nfixed = { \"bias of wheels left\" = 0.0 }", "", "a", "a", "cannot be learned"),
        (WIRED.trim_start_matches("\n[network]\n"), "", "a", "a", "needs a network of the kinds perceptron, leaky"),
    ] {
        let text = pupil(network, learning, &csv.replacen(from, to, 1));
        let error = made(&text).err().unwrap_or_else(|| panic!("nothing is wrong with\n{text}")).to_string();
        assert!(error.starts_with("learn.toml line ") && error.contains(wanted), "{error}\nwhere\n{wanted}");
    }
    let other = pupil(perceptron, "", csv).replace("strategy = { name = \"learning\" }", "");
    let error = made(&other).err().expect("an error").to_string();
    assert!(error.contains("`learning`: is for the strategy `learning`"), "{error}");
}
