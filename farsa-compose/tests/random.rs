//! Files put together at random: each builds, its trials end with finite numbers, and lanes and threads change no bit.

mod drawn;

use farsa_body::Recorder;
use farsa_compose::ComposedExperiment;
use farsa_lab::advanced::Lanes;
use farsa_lab::exports::NetworkExport;
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment as _, Outcome, Settings};
use farsa_nn::block::BlockNetwork;
use farsa_nn::{Controller, Ctrnn, Leak, LeakyNetwork, Perceptron};

use drawn::Draw;

fn evaluator(text: &str) -> Box<dyn Evaluator> {
    let made = ComposedExperiment::from_text("drawn.toml", text, farsa_lab::strategy::strategies());
    let made = made.unwrap_or_else(|error| panic!("{error}\n{text}"));
    let settings = Settings::new(made.settings("")).unwrap_or_else(|error| panic!("{error}\n{text}"));
    made.prepare("", &settings).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[test]
fn drawn_files_live_and_lanes_change_no_bit() {
    let (mut moved, mut networks) = (0, [0; 2]);
    for file in 0..300 {
        let mut draw = Draw::new(20_261_123, file);
        let text = draw.file();
        for (count, kind) in networks.iter_mut().zip(["wired", "blocks"]) {
            *count += usize::from(text.contains(&format!("[network]\nkind = \"{kind}\"")));
        }
        let mut alone = evaluator(&text);
        let parameters: Vec<Vec<f32>> = (0..3)
            .map(|_| {
                let of_parameter =
                    |ends: [f64; 2]| draw.stream.range_f64(ends[0].min(ends[1]), ends[0].max(ends[1])) as f32;
                alone.info().parameters.iter().map(|parameter| parameter.ends).map(of_parameter).collect()
            })
            .collect();
        let jobs: Vec<Evaluation<'_>> = (0..6)
            .map(|number| {
                let (individual, trial) = (number as u32 / 2, number as u32 % 2);
                let id = EpisodeId { seed: 5, generation: 1, individual, trial };
                Evaluation { number, ..Evaluation::new(&parameters[number / 2], id) }
            })
            .collect();
        let expected: Vec<Outcome> = jobs.iter().map(|job| alone.evaluate(*job, None)).collect();
        for outcome in &expected {
            assert!(outcome.is_finite() && (1..=100).contains(&outcome.steps), "{outcome:?}\n{text}");
        }
        moved += usize::from(expected.windows(2).any(|pair| pair[0].terms != pair[1].terms));
        // Again, backwards: nothing is left of an episode.
        for (job, outcome) in jobs.iter().zip(&expected).rev() {
            assert_eq!(alone.evaluate(*job, None), *outcome, "{text}");
        }
        let mut lanes = evaluator(&text);
        let side_by_side = lanes.in_lanes().expect("both worlds have lanes");
        side_by_side.use_lanes(Lanes::best()).expect("a batch");
        let (mut next, mut found) = (jobs.iter(), vec![None; jobs.len()]);
        side_by_side.run_in_lanes(&mut || next.next().copied(), &mut |number, outcome| found[number] = Some(outcome));
        for (found, outcome) in found.into_iter().zip(&expected) {
            assert_eq!(found.as_ref(), Some(outcome), "{text}");
        }
    }
    assert!(moved > 250, "{moved} of 300 files tell their trials apart");
    assert!(networks.iter().all(|count| *count > 20), "{networks:?} files with wires and with blocks");
}

/// Returns the sensor and motor values of the first robot in each step.
#[derive(Default)]
struct Steps {
    x: Vec<f32>,
    y: Vec<f32>,
    all: Vec<[Vec<f32>; 2]>,
}

impl Recorder for Steps {
    fn sensors(&mut self, values: &[f32]) {
        self.x = values.into();
    }
    fn outputs(&mut self, values: &[f32]) {
        self.y = values.into();
    }
    fn tick(&mut self, _: f64) {
        self.all.push([self.x.clone(), self.y.clone()]);
    }
}

/// The network that leaves.
fn network(export: &NetworkExport) -> Box<dyn Controller> {
    match export.clone() {
        NetworkExport::Leaky { layout, leak, parameters } => {
            Box::new(LeakyNetwork::new(layout, leak, parameters, vec![0.0; layout.state_len()]).expect("a network"))
        }
        NetworkExport::Perceptron { inputs, outputs, slope, parameters } => {
            Box::new(Perceptron::new(inputs, outputs, slope, parameters).expect("a layer"))
        }
        NetworkExport::Ctrnn { layout, time_step, parameters } => {
            Box::new(Ctrnn::new(layout, time_step, parameters, vec![0.0; layout.state_len()]).expect("a network"))
        }
        NetworkExport::Blocks { layout, leak, parameters } => {
            assert!([Leak::Filter, Leak::Evonet].contains(&leak));
            // For the time of the test.
            let layout = Box::leak(Box::new(layout)).layout();
            Box::new(BlockNetwork::new(layout, leak, parameters, vec![0.0; layout.state_len()]).expect("a network"))
        }
        other => panic!("{other:?}"),
    }
}

/// Exports compute the same as the experiment, and describe every channel.
#[test]
fn controllers_leave_with_their_channels() {
    let mut kinds = Vec::new();
    for file in 0..60 {
        let mut draw = Draw::new(20_261_124, file);
        // The dead drive nothing.
        let text = draw.file().replace("cost = 0.01", "cost = 0.0").replace("cost = 0.05", "cost = 0.0");
        // Wires are exported as a layer if their outputs are logistic. The layer adds them in another order.
        let text = text.replace("activation = \"clamp\"", "activation = \"logistic\"");
        let nearly = if text.contains("kind = \"wired\"") { 1e-5 } else { 0.0 };
        let mut task = evaluator(&text);
        let ends = task.info().parameters.into_iter().map(|parameter| parameter.ends);
        let parameters: Vec<f32> =
            ends.map(|[from, to]| draw.stream.range_f64(from.min(to), from.max(to)) as f32).collect();
        let export = task.exports().and_then(|exports| exports.controller(&parameters)).expect("a controller");
        assert_eq!(task.exports().and_then(|exports| exports.controller(&parameters[1..])), None);
        let schema = task.info().schema;
        assert_eq!([export.sensors.len(), export.motors.len()], [schema.sensors.len(), schema.outputs.len()], "{text}");
        assert_eq!(export.network.shape(), [export.sensors.len(), export.motors.len()], "{text}");
        assert!(!export.network.bytes(export.channels()).expect("bytes").is_empty());
        let (mut own, mut steps) = (network(&export.network), Steps::default());
        let id = EpisodeId { seed: 3, ..EpisodeId::default() };
        task.evaluate(Evaluation::new(&parameters, id), Some(&mut steps));
        let mut y = vec![0.0; export.motors.len()];
        for [sensed, done] in &steps.all {
            own.step(sensed, &mut y);
            assert!(y.iter().zip(done).all(|(a, b)| (a - b).abs() <= nearly), "{y:?} {done:?} {text}");
        }
        let kind = std::mem::discriminant(&export.network);
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    assert_eq!(kinds.len(), 4, "every kind of network was drawn");
}
