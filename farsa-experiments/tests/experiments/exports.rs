//! Controllers as bytes: of every experiment that has a network, what leaves computes what the experiment computes.

use std::fs;
use std::path::Path;
use std::process::Command;

use farsa_body::Recorder;
use farsa_compose::ComposedExperiment;
use farsa_experiments::all;
use farsa_lab::advanced::Value;
use farsa_lab::exports::{ControllerExport, MotorDrive, NetworkExport, SensorReading};
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment, Settings};
use farsa_nn::block::BlockNetwork;
use farsa_nn::bytes::{BlockNetworkBytes, CtrnnBytes, LeakyNetworkBytes, PerceptronBytes, channel_hash};
use farsa_nn::{Controller, Ctrnn, LeakyNetwork, Perceptron};
use farsa_num::{Domain, Stream};

/// Without a network of ours: wired by hand, or without a controller.
const WITHOUT: [(&str, &str); 6] = [
    ("braitenberg", "2a"),
    ("braitenberg", "2b"),
    ("braitenberg", "3a"),
    ("braitenberg", "3b"),
    ("passive-walker", ""),
    ("body-evolution", "passive"),
];

/// Steps that are compared.
const STEPS: usize = 60;

/// Inputs and outputs of each step.
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
        if self.all.len() < STEPS {
            self.all.push([self.x.clone(), self.y.clone()]);
        }
    }
}

/// Inputs of all steps of a trial.
#[derive(Default)]
struct Trial {
    all: Vec<Vec<f32>>,
}

impl Recorder for Trial {
    fn sensors(&mut self, values: &[f32]) {
        self.all.push(values.into());
    }
    fn tick(&mut self, _: f64) {}
}

/// Every experiment that can be prepared in this build, under each of its conditions.
fn prepared() -> Vec<(&'static str, &'static str, Box<dyn Evaluator>)> {
    let mut found = Vec::new();
    for experiment in all() {
        let conditions = experiment.conditions();
        let conditions = if conditions.is_empty() { &[""][..] } else { conditions };
        for condition in conditions {
            found.extend(prepare(experiment, condition).map(|evaluator| (experiment.name(), *condition, evaluator)));
        }
    }
    found
}

fn prepare(experiment: &dyn Experiment, condition: &str) -> Option<Box<dyn Evaluator>> {
    let mut settings = Settings::new(experiment.settings(condition)).expect("settings");
    // Some have no such setting, or need more.
    let _ = settings.set("", "trial.steps", Value::Whole(60));
    match experiment.prepare(condition, &settings) {
        Err(_) if experiment.name() == "push-box" && !cfg!(feature = "rapier") => None,
        prepared => Some(prepared.expect("an experiment")),
    }
}

/// Parameters drawn from their ranges.
fn random(evaluator: &dyn Evaluator, seed: u64) -> Vec<f32> {
    let mut stream = Stream::new(seed, Domain::InitialGenome, 0, 0, 0);
    let drawn = |ends: [f64; 2]| {
        let [low, high] = ends.map(|end| end as f32);
        low + (high - low) * stream.uniform()
    };
    evaluator.info().parameters.into_iter().map(|parameter| parameter.ends).map(drawn).collect()
}

/// The network of bytes, by the bytes alone.
fn network(bytes: &[u8]) -> Box<dyn Controller> {
    let parameters = |copy: &dyn Fn(&mut [f32]), count: usize| {
        let mut parameters = vec![0.0; count];
        copy(&mut parameters);
        parameters
    };
    match bytes[12] {
        1 => {
            let read = LeakyNetworkBytes::read(bytes).expect("a leaky network");
            let own = parameters(&|to| read.copy_parameters(to).expect("all"), read.layout().parameter_count());
            let state = vec![0.0; read.layout().state_len()];
            Box::new(LeakyNetwork::new(read.layout(), read.leak(), own, state).expect("a network"))
        }
        3 => {
            let read = CtrnnBytes::read(bytes).expect("a continuous-time network");
            let own = parameters(&|to| read.copy_parameters(to).expect("all"), read.layout().parameter_count());
            let state = vec![0.0; read.layout().state_len()];
            Box::new(Ctrnn::new(read.layout(), read.time_step(), own, state).expect("a network"))
        }
        4 => {
            let read = PerceptronBytes::read(bytes).expect("a layer");
            let (inputs, outputs) = (read.inputs(), read.outputs());
            let count = Perceptron::parameter_count(inputs, outputs);
            let own = parameters(&|to| read.copy_parameters(to).expect("all"), count);
            Box::new(Perceptron::new(inputs, outputs, read.slope(), own).expect("a layer"))
        }
        5 => {
            let read = BlockNetworkBytes::read(bytes).expect("a network of blocks");
            // For the time of the test.
            let layout = Box::leak(Box::new(read.layout())).layout();
            let own = parameters(&|to| read.copy_parameters(to).expect("all"), layout.parameter_count());
            let state = vec![0.0; layout.state_len()];
            Box::new(BlockNetwork::new(layout, read.leak(), own, state).expect("a network"))
        }
        other => panic!("kind {other}"),
    }
}

fn exported(evaluator: &dyn Evaluator, parameters: &[f32]) -> Option<ControllerExport> {
    evaluator.exports()?.controller(parameters)
}

#[test]
fn bytes_of_every_experiment_compute_what_it_computes() {
    let mut kinds = [0; 6];
    for (name, condition, mut evaluator) in prepared() {
        let who = format!("{name} {condition}");
        let without = WITHOUT.contains(&(name, condition));
        for seed in 1..=2 {
            let parameters = random(evaluator.as_ref(), seed);
            let Some(controller) = exported(evaluator.as_ref(), &parameters) else {
                assert!(without, "{who}: no controller");
                continue;
            };
            assert!(!without, "{who}: a controller of no network");
            let bytes = controller.network.bytes(controller.channels()).expect("bytes");
            kinds[usize::from(bytes[12])] += 1;
            let mut network = network(&bytes);
            assert_eq!([network.inputs(), network.outputs()], controller.network.shape(), "{who}");
            let mut steps = Steps::default();
            let id = EpisodeId { seed, ..EpisodeId::default() };
            let outcome = evaluator.evaluate(Evaluation::new(&parameters, id), Some(&mut steps));
            // A walker that falls at once was driven at least once.
            assert!(outcome.failure.is_none() && !steps.all.is_empty(), "{who}: {outcome:?}");
            for (step, [x, y]) in steps.all.iter().enumerate() {
                let mut own = vec![f32::NAN; y.len()];
                network.step(x, &mut own);
                let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(&own), bits(y), "{who}, step {step}: {own:?} {y:?}");
            }
        }
    }
    // Leaky, continuous-time, perceptron, blocks.
    assert!([1, 3, 4, 5].iter().all(|&kind: &usize| kinds[kind] >= 2), "{kinds:?}");
}

#[test]
fn every_channel_has_a_name_and_says_what_it_is() {
    for (name, condition, evaluator) in prepared() {
        let parameters = random(evaluator.as_ref(), 3);
        let Some(controller) = exported(evaluator.as_ref(), &parameters) else { continue };
        let who = format!("{name} {condition}");
        let [inputs, outputs] = controller.network.shape();
        assert_eq!([controller.sensors.len(), controller.motors.len()], [inputs, outputs], "{who}");
        // The names of a recording. Names of the arm have units there.
        let schema = evaluator.info().schema;
        let names = |channels: &[farsa_view::Channel]| channels.iter().map(|one| one.name.clone()).collect::<Vec<_>>();
        let hash = channel_hash(names(&schema.sensors), names(&schema.outputs));
        assert!(controller.channels() == hash || name.contains("grasp"), "{who}");
        for sensor in &controller.sensors {
            match &sensor.reads {
                SensorReading::Quantity { quantity, unit, zero, one, .. } => {
                    assert!(!quantity.is_empty() && !unit.is_empty() && zero != one, "{who}: {sensor:?}");
                    assert!(zero.is_finite() && one.is_finite(), "{who}: {sensor:?}");
                }
                reads => assert!(!matches!(reads, SensorReading::Channel { .. }), "{who}: {sensor:?}"),
            }
        }
        for motor in &controller.motors {
            match &motor.drives {
                MotorDrive::Quantity { quantity, unit, zero, one } => {
                    assert!(!quantity.is_empty() && !unit.is_empty() && zero != one, "{who}: {motor:?}");
                    assert!(zero.is_finite() && one.is_finite(), "{who}: {motor:?}");
                }
                drives => assert!(!matches!(drives, MotorDrive::Channel { .. }), "{who}: {motor:?}"),
            }
        }
        // Other numbers of parameters are no controller.
        assert!(exported(evaluator.as_ref(), &parameters[1..]).is_none() || name.contains("grasp"), "{who}");
    }
}

#[test]
fn json_holds_the_parameters_of_every_kind() {
    for (name, condition, evaluator) in prepared() {
        let parameters = random(evaluator.as_ref(), 4);
        let Some(controller) = exported(evaluator.as_ref(), &parameters) else { continue };
        let told = serde_json::to_value(&controller).expect("JSON");
        let told = told["network"].as_object().expect("an object");
        let kind = told.get("kind").and_then(|kind| kind.as_str());
        let (expected, tables): (_, &[&str]) = match controller.network {
            NetworkExport::Leaky { .. } => {
                (None, &["sensor_weights", "recurrent_weights", "output_weights", "biases", "leaks"])
            }
            NetworkExport::Perceptron { .. } => (Some("perceptron"), &["weights", "biases"]),
            NetworkExport::Ctrnn { .. } => {
                (Some("ctrnn"), &["input_weights", "weights", "biases", "gains", "time_constants"])
            }
            NetworkExport::Blocks { .. } => (Some("blocks"), &["weights", "biases", "gains", "leaks"]),
            _ => panic!("another kind"),
        };
        assert_eq!(kind, expected, "{name} {condition}");
        let numbers = |table: &&str| serde_json::from_value::<Vec<f32>>(told[*table].clone()).expect("numbers");
        let all: Vec<f32> = tables.iter().flat_map(numbers).collect();
        assert_eq!(all, controller.network.parameters(), "{name} {condition}");
    }
}

/// The contents of `firmware/e-puck`: the champion of its file's run, and its counted sensor values in a trial. New ones are put
/// next to the tests' other files, for an intended change.
#[test]
fn the_board_of_the_e_puck_has_what_this_program_makes() {
    const RECORDED: usize = 300;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../firmware/e-puck");
    let file = ComposedExperiment::from_file(folder.join("e-puck.toml"), farsa_lab::strategy::strategies());
    let experiment = file.unwrap_or_else(|error| panic!("{error}"));
    let settings = Settings::new(experiment.settings("")).expect("its settings");
    let mut evaluator = experiment.prepare("", &settings).unwrap_or_else(|error| panic!("{error}"));

    // The guide's run and export, and `farsa replay` of trial 0 of its last generation.
    let here = Path::new(env!("CARGO_TARGET_TMPDIR")).join("board");
    let _ = fs::remove_dir_all(&here);
    fs::create_dir_all(&here).expect("a scratch directory");
    let farsa = |arguments: &str| {
        let said = Command::new(env!("CARGO_BIN_EXE_farsa")).args(arguments.split(' ')).current_dir(&here).output();
        let said = said.expect("the command");
        assert!(said.status.success(), "{arguments}: {}", String::from_utf8_lossy(&said.stderr));
        said.stdout
    };
    let toml = folder.join("e-puck.toml");
    farsa(&format!("run {} --seed 16 --quiet --out run", toml.display()));
    let champion = farsa("export controller run --format bytes");
    let read = PerceptronBytes::read(&champion).expect("a layer");
    let mut parameters = vec![0.0; Perceptron::parameter_count(8, 2)];
    read.copy_parameters(&mut parameters).expect("all");

    let mut steps = Trial::default();
    let replayed = farsa("replay run --trial 0 --json --out trial.csv");
    let replayed: serde_json::Value = serde_json::from_slice(&replayed).expect("JSON");
    let number = |key: &str| replayed[key].as_u64().unwrap_or_else(|| panic!("no {key}: {replayed}")) as u32;
    let id = EpisodeId { seed: 16, generation: number("generation"), individual: number("individual"), trial: 0 };
    evaluator.evaluate(Evaluation::new(&parameters, id), Some(&mut steps));
    let count = |x: &f32| (4095.0 * x).round() as u16;
    let recorded = steps.all.iter().take(RECORDED);
    let readings: Vec<u8> = recorded.clone().flatten().map(count).flat_map(u16::to_le_bytes).collect();
    assert_eq!(readings.len(), 16 * RECORDED);
    // The cost of counting: motor values are as far from those here as the guide reports.
    let mut layer = Perceptron::new(8, 2, read.slope(), parameters).expect("a layer");
    let mut furthest = 0.0_f32;
    for x in recorded {
        let (mut exact, mut counted) = ([0.0; 2], [0.0; 2]);
        layer.step(x, &mut exact);
        layer.step(&x.iter().map(|x| f32::from(count(x)) / 4095.0).collect::<Vec<_>>(), &mut counted);
        furthest = exact.iter().zip(counted).map(|(a, b)| (a - b).abs()).fold(furthest, f32::max);
    }
    println!("motor values by counts are at most {furthest} from those of the simulation");
    assert!(furthest < 1.4e-4, "{furthest}");

    let mut others = Vec::new();
    for (name, made) in [("champion.farsa", champion), ("readings.bin", readings)] {
        if fs::read(folder.join(name)).unwrap_or_default() != made {
            fs::write(here.join(name), made).expect("a file");
            others.push(here.join(name));
        }
    }
    assert!(others.is_empty(), "these are the new ones: {others:?}");
}
