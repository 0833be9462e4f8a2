//! The test protocols of experiments from files: what a case does to robots, against networks that are stepped here.

use std::path::Path;

use farsa_body::ports::BodyId;
use farsa_body::{Pose, Recorder};
use farsa_compose::ComposedExperiment;
use farsa_lab::advanced::{CaseId, Lanes, Protocol};
use farsa_lab::exports::NetworkExport;
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment as _, Outcome, Settings};
use farsa_nn::block::{Block, BlockNetwork};
use farsa_nn::{Controller, Ctrnn, LeakyNetwork, LeakyParameter, Perceptron};
use farsa_num::{Domain, Instructions, Stream};

use crate::steps::{Steps, drawn};

/// A robot that senses its motion and a constant, so that every input matters.
const REST: &str = r#"[world]
size = [1.0, 1.0]
[robot]
kind = "e-puck"
count = 2
[episode]
steps = 30
trials = 1
[[sensors]]
kind = "wheel-speed"
[[sensors]]
kind = "body-pose"
[[sensors]]
kind = "constant"
value = 0.7
[[motors]]
kind = "wheels"
[[reward]]
kind = "displacement"
over = "end"
[[reward]]
kind = "effort"
"#;

const BLOCKS: &str = r#"kind = "blocks"
weights = [-3.0, 3.0]
clusters = [
    { name = "memory", neurons = 1, activation = "tanh", leaks = true },
    { name = "hidden", neurons = 2 },
]
links = [
    { from = "hidden", to = "memory", delay = 2 },
    { from = "motors", to = "memory" },
    { from = "sensors", to = "hidden" },
    { from = "memory", to = "hidden" },
    { from = "hidden", to = "motors" },
]
"#;

/// Networks, and their neurons by the names of cases.
const NETWORKS: [(&str, &[&str]); 9] = [
    ("kind = \"perceptron\"", &["output of wheels left", "output of wheels right"]),
    ("kind = \"leaky\"\nhidden = 2", &["neuron 1", "neuron 2", "output of wheels left", "output of wheels right"]),
    (
        "kind = \"ctrnn\"\nneurons = 4\ntime_constants = [0.1, 0.5]",
        &["neuron 1", "neuron 2", "output of wheels left", "output of wheels right"],
    ),
    (
        "kind = \"feed-forward\"\nhidden = 2",
        &["neuron 11", "neuron 12", "output of wheels left", "output of wheels right"],
    ),
    ("kind = \"elman\"\nhidden = 1", &["neuron 11", "output of wheels left", "output of wheels right"]),
    ("kind = \"jordan\"\nhidden = 1", &["neuron 11", "output of wheels left", "output of wheels right"]),
    ("kind = \"fully-recurrent\"\nhidden = 1", &["neuron 11", "output of wheels left", "output of wheels right"]),
    (BLOCKS, &["memory", "hidden 1", "hidden 2", "output of wheels left", "output of wheels right"]),
    (
        "kind = \"evonet\"\nhidden = 1\nhidden_neurons = \"leaky\"\nrecurrent_outputs = true",
        &["neuron 11", "output of wheels left", "output of wheels right"],
    ),
];

const WIRED: &str = "kind = \"wired\"\nbias = [0.5, 0.5]\n\
    wires = [{ from = [\"constant\"], to = \"wheels left\", weight = 0.5 }]\n";

fn evaluator(text: &str) -> Box<dyn Evaluator> {
    let made = ComposedExperiment::from_text("own.toml", text, farsa_lab::strategy::strategies());
    let made = made.unwrap_or_else(|error| panic!("{error}\n{text}"));
    let settings = Settings::new(made.settings("")).expect("settings");
    made.prepare("", &settings).expect("an evaluator")
}

fn of(network: &str) -> Box<dyn Evaluator> {
    evaluator(&format!("{REST}[network]\n{network}"))
}

const ID: EpisodeId = EpisodeId { seed: 4, generation: 2, individual: 3, trial: 1 };

/// Returns the sensor and motor values of the first robot.
fn recorded(evaluator: &mut dyn Evaluator, case: Option<CaseId>) -> (Outcome, Vec<[Vec<f32>; 2]>) {
    let parameters = drawn(evaluator);
    let mut steps = Steps::default();
    let outcome = evaluator.evaluate(Evaluation { case, ..Evaluation::new(&parameters, ID) }, Some(&mut steps));
    (outcome, steps.all)
}

fn controller(export: NetworkExport) -> Box<dyn Controller> {
    match export {
        NetworkExport::Perceptron { inputs, outputs, slope, parameters } => {
            Box::new(Perceptron::new(inputs, outputs, slope, parameters).expect("a layer"))
        }
        NetworkExport::Leaky { layout, leak, parameters } => {
            Box::new(LeakyNetwork::new(layout, leak, parameters, vec![0.0; layout.state_len()]).expect("a network"))
        }
        NetworkExport::Ctrnn { layout, time_step, parameters } => {
            Box::new(Ctrnn::new(layout, time_step, parameters, vec![0.0; layout.state_len()]).expect("a network"))
        }
        NetworkExport::Blocks { layout, leak, parameters } => {
            // For the time of the test.
            let layout = Box::leak(Box::new(layout)).layout();
            Box::new(BlockNetwork::new(layout, leak, parameters, vec![0.0; layout.state_len()]).expect("a network"))
        }
        other => panic!("{other:?}"),
    }
}

/// Returns a network without the links from one neuron, numbered from the first after the inputs, and the output of
/// that neuron.
fn unheard(export: &NetworkExport, neuron: usize) -> (Box<dyn Controller>, Option<usize>) {
    let mut export = export.clone();
    let output = match &mut export {
        NetworkExport::Perceptron { .. } => Some(neuron),
        NetworkExport::Leaky { layout, parameters, .. } => {
            let (hidden, outputs) = (layout.hidden(), layout.outputs());
            if neuron < hidden {
                for (kind, targets) in
                    [(LeakyParameter::RecurrentWeight, hidden), (LeakyParameter::OutputWeight, outputs)]
                {
                    parameters[layout.range(kind)][neuron * targets..(neuron + 1) * targets].fill(0.0);
                }
            }
            neuron.checked_sub(hidden)
        }
        NetworkExport::Ctrnn { layout, parameters, .. } => {
            let (inputs, neurons) = (layout.inputs(), layout.neurons());
            parameters[(inputs + neuron) * neurons..(inputs + neuron + 1) * neurons].fill(0.0);
            neuron.checked_sub(neurons - layout.outputs())
        }
        NetworkExport::Blocks { layout, parameters, .. } => {
            let (mut first, neuron) = (0, neuron + layout.inputs);
            for block in &layout.blocks {
                let Block::Connect { from, to, .. } = *block else { continue };
                if let Some(row) = neuron.checked_sub(from.first).filter(|row| *row < from.count) {
                    parameters[first + row * to.count..first + (row + 1) * to.count].fill(0.0);
                }
                first += from.count * to.count;
            }
            let neurons: usize = layout.groups.iter().map(|group| group.neurons).sum();
            neuron.checked_sub(neurons - layout.outputs)
        }
        other => panic!("{other:?}"),
    };
    (controller(export), output)
}

fn names(protocol: &Protocol) -> Vec<&str> {
    protocol.cases.iter().map(|case| case.row.as_str()).collect()
}

#[test]
fn each_neuron_that_is_silent_is_heard_by_none() {
    for (network, neurons) in NETWORKS {
        let mut evaluator = of(network);
        let parameters = drawn(evaluator.as_ref());
        let export =
            evaluator.exports().and_then(|exports| exports.controller(&parameters)).expect("a network").network;
        let protocols = evaluator.info().protocols;
        Protocol::check(&protocols).expect("protocols");
        assert_eq!(protocols.iter().map(|protocol| protocol.name.as_str()).collect::<Vec<_>>(), ["lesions", "noise"]);
        let wanted = ["intact", "no wheel-speed", "no body-pose", "no constant"].map(str::to_owned).into_iter();
        let wanted: Vec<String> = wanted.chain(neurons.iter().map(|name| format!("no {name}"))).collect();
        assert_eq!(names(&protocols[0]), wanted);
        let intact = recorded(evaluator.as_mut(), None);
        assert_eq!(recorded(evaluator.as_mut(), Some(CaseId { protocol: 0, case: 0 })), intact);
        for neuron in 0..neurons.len() {
            let (mut oracle, output) = unheard(&export, neuron);
            let case = Some(CaseId { protocol: 0, case: 4 + neuron });
            let (_, steps) = recorded(evaluator.as_mut(), case);
            assert_eq!(steps.len(), 30);
            for (number, [x, y]) in steps.iter().enumerate() {
                let mut expected = [f32::NAN; 2];
                oracle.step(x, &mut expected);
                if let Some(output) = output {
                    expected[output] = 0.0;
                }
                assert_eq!(y[..], expected, "step {number}, neuron {neuron} of {network}");
            }
            assert_ne!(steps, intact.1, "neuron {neuron} of {network}");
        }
    }
}

#[test]
fn sensors_are_cut_and_disturbed() {
    for (network, _) in NETWORKS {
        let mut evaluator = of(network);
        let parameters = drawn(evaluator.as_ref());
        let export =
            evaluator.exports().and_then(|exports| exports.controller(&parameters)).expect("a network").network;
        for (number, sensor) in [0..2, 2..9, 9..10].into_iter().enumerate() {
            let mut oracle = controller(export.clone());
            let (_, steps) = recorded(evaluator.as_mut(), Some(CaseId { protocol: 0, case: 1 + number }));
            for [x, y] in steps {
                let (mut x, mut expected) = (x, [f32::NAN; 2]);
                x[sensor.clone()].fill(0.0);
                oracle.step(&x, &mut expected);
                assert_eq!(y[..], expected, "sensor {number} of {network}");
            }
        }
        for (number, level) in [0.0_f32, 0.05, 0.1, 0.2, 0.4].into_iter().enumerate() {
            let mut oracle = controller(export.clone());
            let mut noise = Stream::new(ID.seed, Domain::Network, ID.trial, ID.individual, ID.generation);
            let (outcome, steps) = recorded(evaluator.as_mut(), Some(CaseId { protocol: 1, case: number }));
            let plain = recorded(evaluator.as_mut(), None);
            assert_eq!((&outcome, &steps) == (&plain.0, &plain.1), level == 0.0, "level {level} of {network}");
            for [x, y] in steps {
                let (mut x, mut expected) = (x, [f32::NAN; 2]);
                x.iter_mut().filter(|_| level > 0.0).for_each(|x| *x += noise.range(-level, level));
                oracle.step(&x, &mut expected);
                assert_eq!(y[..], expected, "noise {level} of {network}");
            }
        }
    }
}

/// Returns the sensor and motor values of the first robot under these changes.
fn changed(evaluator: &mut dyn Evaluator, list: &str) -> Vec<[Vec<f32>; 2]> {
    let change = evaluator.info().anatomy.expect("parts").intervention(list).expect("a change");
    let (parameters, mut steps) = (drawn(evaluator), Steps::default());
    let evaluation = Evaluation { intervention: Some(&change), ..Evaluation::new(&parameters, ID) };
    evaluator.evaluate(evaluation, Some(&mut steps));
    steps.all
}

#[test]
fn parts_are_changed_by_name() {
    for (network, neurons) in NETWORKS {
        let mut evaluator = of(network);
        let schema = evaluator.info().schema;
        let (_, intact) = recorded(evaluator.as_mut(), None);
        let of_case = |evaluator: &mut dyn Evaluator, case| recorded(evaluator, Some(CaseId { protocol: 0, case })).1;
        assert!(changed(evaluator.as_mut(), "sensor:body-pose") == of_case(evaluator.as_mut(), 2), "{network}");
        let left = neurons.len() - 2;
        let silent = changed(evaluator.as_mut(), "output:wheels left");
        assert!(silent == of_case(evaluator.as_mut(), 4 + left) && silent != intact, "{network}");
        // The first neuron that is no input is called by its number in the network.
        let named: Vec<&str> = schema.neurons.iter().map(|neuron| neuron.name.as_str()).collect();
        let first = named.len().saturating_sub(neurons.len());
        if let Some(name) = named.get(first) {
            assert!(
                changed(evaluator.as_mut(), &format!("neuron:{name}")) == of_case(evaluator.as_mut(), 4),
                "{network}"
            );
        }

        let Some(links) = schema.links.first() else {
            let error = evaluator
                .info()
                .anatomy
                .expect("parts")
                .intervention("link:constant-wheels left")
                .expect_err("no links");
            assert!(error.to_string().ends_with("the schema names no links"), "{error}");
            continue;
        };
        // From the constant, the last input, to the first target.
        let target = named.first().copied().unwrap_or("wheels left");
        let parameters = drawn(evaluator.as_ref());
        let export = evaluator.exports().and_then(|exports| exports.controller(&parameters)).expect("a network");
        let mut cut = export.network;
        let weight = links.first + (links.from[1] - 1) * (links.to[1] - links.to[0]);
        match &mut cut {
            NetworkExport::Perceptron { parameters, .. }
            | NetworkExport::Leaky { parameters, .. }
            | NetworkExport::Ctrnn { parameters, .. } => {
                parameters[weight] = -0.25;
            }
            other => panic!("{other:?}"),
        }
        let mut oracle = controller(cut);
        let steps = changed(evaluator.as_mut(), &format!("link:constant-{target}=-0.25"));
        for [x, y] in &steps {
            let mut expected = [f32::NAN; 2];
            oracle.step(x, &mut expected);
            assert_eq!(y[..], expected, "{network}");
        }
        assert!(steps != intact, "{network}");
    }
    // A hand-wired network has inputs.
    let mut wired = of(WIRED);
    let (_, intact) = recorded(wired.as_mut(), None);
    assert!(changed(wired.as_mut(), "sensor:constant=0.2") != intact);
}

#[test]
fn what_is_wired_by_hand_has_noise_alone() {
    let protocols = of(WIRED).info().protocols;
    assert_eq!(protocols.len(), 1);
    assert_eq!((protocols[0].name.as_str(), names(&protocols[0])), ("noise", vec!["0", "0.05", "0.1", "0.2", "0.4"]));
}

/// Every case, each after a plain trial, alone and in lanes.
fn in_lanes_as_alone(mut evaluator: Box<dyn Evaluator>) {
    let parameters = drawn(evaluator.as_ref());
    let plain = Evaluation::new(&parameters, ID);
    let before = evaluator.evaluate(plain, None);
    let protocols = evaluator.info().protocols;
    let of_protocol =
        |(protocol, about): (usize, &Protocol)| (0..about.cases.len()).map(move |case| CaseId { protocol, case });
    let cases = protocols.iter().enumerate().flat_map(of_protocol);
    let numbered = cases.flat_map(|case| [None, Some(case)]).enumerate();
    let all: Vec<Evaluation<'_>> = numbered.map(|(number, case)| Evaluation { number, case, ..plain }).collect();
    let alone: Vec<Outcome> = all.iter().map(|evaluation| evaluator.evaluate(*evaluation, None)).collect();
    assert!(alone.iter().step_by(2).all(|outcome| *outcome == before), "a case left something behind");
    assert!(alone.iter().any(|outcome| *outcome != before), "no case changed anything");
    let lanes = evaluator.in_lanes().expect("lanes");
    lanes.use_lanes(Lanes::new(8, Instructions::detect()).expect("lanes")).expect("a batch");
    let (mut rest, mut found) = (all.iter().copied(), vec![None; all.len()]);
    lanes.run_in_lanes(&mut || rest.next(), &mut |number, outcome| found[number] = Some(outcome));
    assert!(found.into_iter().eq(alone.into_iter().map(Some)));
}

fn shown(name: &str) -> ComposedExperiment {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../experiments");
    ComposedExperiment::from_file(folder.join(name), farsa_lab::strategy::strategies()).expect("an experiment")
}

fn prepared(experiment: &ComposedExperiment) -> Box<dyn Evaluator> {
    let condition = experiment.conditions().first().copied().unwrap_or_default();
    let settings = Settings::new(experiment.settings(condition)).expect("settings");
    experiment.prepare(condition, &settings).expect("an evaluator")
}

#[test]
fn cases_in_lanes_are_those_alone_and_leave_nothing_behind() {
    NETWORKS.into_iter().map(|(network, _)| network).chain([WIRED]).for_each(|network| in_lanes_as_alone(of(network)));
    // A robot with joints.
    in_lanes_as_alone(prepared(&shown("reaching.toml")));
}

/// The pose of each body after the first step.
#[derive(Default)]
struct First {
    poses: Vec<Pose<f32>>,
    ticks: usize,
}

impl Recorder for First {
    fn pose(&mut self, _: BodyId, pose: Pose<f32>) {
        if self.ticks == 0 {
            self.poses.push(pose);
        }
    }
    fn tick(&mut self, _: f64) {
        self.ticks += 1;
    }
}

/// The case of a test with several populations applies to the tested one.
#[test]
fn opponents_are_intact() {
    let mut evaluator = prepared(&shown("chase.toml"));
    let parameters = vec![0.1; evaluator.info().parameters.len()];
    let mut disturbed = Vec::new();
    for individual in [0, 9_999] {
        let mut of_case = |case| {
            let (id, mut first) = (EpisodeId { individual, ..ID }, First::default());
            let opponents: &[&[f32]] = &[&parameters];
            let evaluation = Evaluation { case, opponents, ..Evaluation::new(&parameters, id) };
            evaluator.evaluate(evaluation, Some(&mut first));
            first.poses
        };
        let (plain, noisy) = (of_case(None), of_case(Some(CaseId { protocol: 1, case: 4 })));
        assert_eq!(plain.len(), noisy.len());
        disturbed.push((0..plain.len()).filter(|body| plain[*body] != noisy[*body]).collect::<Vec<_>>());
    }
    assert_eq!(disturbed, [[0], [1]], "the bodies that move otherwise");
}
