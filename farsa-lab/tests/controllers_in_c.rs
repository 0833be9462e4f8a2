//! Networks of every kind in C: the compiler of this machine and `tests/firmware/c/run` compare their bits with Rust.
#![cfg(all(unix, feature = "command"))]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use farsa_lab::exports::{
    CFiles, ControllerExport, MotorDrive, MotorExport, NetworkExport, SensorExport, SensorReading,
};
use farsa_nn::block::{Block, BlockLayoutBuf, BlockNetwork, Group, Span};
use farsa_nn::quantized::{QuantizedNetwork, QuantizedScale};
use farsa_nn::{
    Activation, Controller, Ctrnn, CtrnnLayout, CtrnnParameter, Integrator, Leak, LeakyLayout, LeakyNetwork,
    LeakyParameter, Perceptron,
};
use farsa_num::{Domain, Stream};

const STEPS: usize = 100_000;

/// Random parameters in \[-4, 4), or leaks in \[0, 1).
fn parameters(count: usize, is_leak: impl Fn(usize) -> bool) -> Vec<f32> {
    let mut stream = Stream::new(7, Domain::Network, count as u32, 0, 0);
    (0..count).map(|i| if is_leak(i) { stream.range(0.0, 1.0) } else { stream.range(-4.0, 4.0) }).collect()
}

fn leaky(sensors: usize, hidden: usize, outputs: usize, leak: Leak) -> NetworkExport {
    let layout = LeakyLayout::new(sensors, hidden, outputs);
    let leaks = layout.range(LeakyParameter::Leak);
    let parameters = parameters(layout.parameter_count(), |i| leaks.contains(&i));
    NetworkExport::Leaky { layout, leak, parameters }
}

fn ctrnn(layout: CtrnnLayout) -> NetworkExport {
    let mut parameters = parameters(layout.parameter_count(), |_| false);
    // Above and below the time step, so that the exponential integrator uses both of its forms.
    let constants = layout.range(CtrnnParameter::TimeConstant);
    parameters[constants].iter_mut().enumerate().for_each(|(i, tau)| *tau = if i == 0 { 0.06 } else { 0.3 * i as f32 });
    NetworkExport::Ctrnn { layout, time_step: 0.1, parameters }
}

/// Delays, gains, modulated gains, leaks, updates across groups, and every activation function.
fn blocks(leak: Leak) -> NetworkExport {
    let groups = vec![
        Group::new(2, Activation::Linear).with_leaks(),
        Group::new(2, Activation::Tanh).with_slope(0.5).with_biases().with_leaks(),
        Group::new(1, Activation::Rectified).with_biases().with_gains(),
        Group::new(1, Activation::Step),
        Group::new(1, Activation::Logistic).with_slope(0.7).with_biases(),
        Group::new(1, Activation::Linear).with_slope(0.25).with_gains(),
    ];
    let [x, h, across, o] = [Span::new(0, 2), Span::new(2, 2), Span::new(3, 3), Span::new(6, 2)];
    let blocks = vec![
        Block::Update(x),
        Block::connect(x, h),
        Block::connect(o, h).delayed(3),
        Block::Update(Span::new(2, 1)),
        Block::ModulatedGain { neurons: x, by: 2 },
        Block::connect(Span::new(0, 3), across),
        Block::Update(across),
        Block::Gain(Span::new(4, 2)),
        Block::connect(Span::new(2, 4), o),
        Block::connect(x, Span::new(7, 1)).delayed(1),
        Block::Update(o),
    ];
    let layout = BlockLayoutBuf { inputs: 2, outputs: 2, groups, blocks };
    let leaks = layout.layout().range(farsa_nn::block::BlockParameter::Leak);
    let parameters = parameters(layout.layout().parameter_count(), |i| leaks.contains(&i));
    NetworkExport::Blocks { layout, leak, parameters }
}

/// The networks by name. `true` marks those that are small enough for an AVR.
fn networks() -> Vec<(&'static str, bool, NetworkExport)> {
    let perceptron = |inputs, outputs, slope| {
        let parameters = parameters(Perceptron::parameter_count(inputs, outputs), |_| false);
        NetworkExport::Perceptron { inputs, outputs, slope, parameters }
    };
    let with = |layout: CtrnnLayout, integrator, activation| {
        ctrnn(layout.with_integrator(integrator).with_activation(activation))
    };
    let (weighted, direct) = (CtrnnLayout::new(2, 2, 1), CtrnnLayout::new(2, 7, 2).with_direct_inputs(1));
    vec![
        ("leaky", true, leaky(3, 2, 1, Leak::Filter)),
        ("leaky_two_tap", false, leaky(5, 9, 4, Leak::TwoTap)),
        ("leaky_evonet", false, leaky(29, 12, 23, Leak::Evonet)),
        // A name whose macros begin with TEST.
        ("test", false, perceptron(3, 2, 1.0)),
        // Arguments up to hundreds: the ends of the exponential and subnormal outputs.
        ("perceptron_steep", true, perceptron(3, 2, 12.0)),
        // The name in the guide.
        ("epuck", false, perceptron(8, 2, 1.0)),
        ("ctrnn", true, with(weighted, Integrator::ExponentialEuler, Activation::Logistic)),
        ("ctrnn_euler", false, with(direct, Integrator::Euler, Activation::Tanh)),
        ("ctrnn_runge_kutta", false, with(direct.with_outputs_from(0), Integrator::RungeKutta4, Activation::Logistic)),
        ("ctrnn_rectified", false, with(weighted, Integrator::RungeKutta4, Activation::Rectified)),
        ("blocks", true, blocks(Leak::Filter)),
        ("blocks_two_tap", false, blocks(Leak::TwoTap)),
        ("blocks_evonet", false, blocks(Leak::Evonet)),
    ]
}

fn export(network: NetworkExport) -> ControllerExport {
    let [inputs, outputs] = network.shape();
    let sensor =
        |i: usize| SensorExport { name: format!("sensor {i} */"), reads: SensorReading::Channel { channel: i } };
    let motor = |i: usize| MotorExport { name: format!("motor {i}\n"), drives: MotorDrive::Channel { channel: i } };
    let (sensors, motors) = ((0..inputs).map(sensor).collect(), (0..outputs).map(motor).collect());
    ControllerExport::new(network, sensors, motors, 0.1, 100)
}

/// The inputs and the hash of `tests/firmware/c/steps.c`.
struct Steps {
    seed: u32,
    hash: u32,
}

impl Steps {
    fn draw(&mut self) -> u32 {
        self.seed = self.seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        self.seed
    }

    fn add(&mut self, bits: u32) {
        self.hash = (self.hash ^ bits).rotate_left(5).wrapping_mul(0x9E37_79B1);
    }
}

fn hash(mut network: impl Controller) -> u32 {
    let mut steps = Steps { seed: 1, hash: 0 };
    let (mut x, mut y) = (vec![0.0; network.inputs()], vec![0.0; network.outputs()]);
    for _ in 0..STEPS {
        x.fill_with(|| (steps.draw() >> 8) as f32 / 4_194_304.0 - 2.0);
        network.step(&x, &mut y);
        for y in &y {
            steps.add(y.to_bits());
        }
    }
    steps.hash
}

fn hash_of(network: &NetworkExport) -> u32 {
    let valid = "a valid network";
    match network {
        NetworkExport::Leaky { layout, leak, parameters } => {
            hash(LeakyNetwork::new(*layout, *leak, parameters, vec![0.0; layout.state_len()]).expect(valid))
        }
        NetworkExport::Perceptron { inputs, outputs, slope, parameters } => {
            hash(Perceptron::new(*inputs, *outputs, *slope, parameters).expect(valid))
        }
        NetworkExport::Ctrnn { layout, time_step, parameters } => {
            hash(Ctrnn::new(*layout, *time_step, parameters, vec![0.0; layout.state_len()]).expect(valid))
        }
        NetworkExport::Blocks { layout, leak, parameters } => {
            let layout = layout.layout();
            hash(BlockNetwork::new(layout, *leak, parameters, vec![0.0; layout.state_len()]).expect(valid))
        }
        _ => panic!("another kind"),
    }
}

fn integer_hash(network: &NetworkExport) -> u32 {
    let NetworkExport::Leaky { layout, leak, parameters } = network else { panic!("a leaky network") };
    let mut integers = vec![0; parameters.len()];
    let scale = QuantizedScale::quantize(layout, 9, parameters, &mut integers).expect("weights that fit");
    let mut network =
        QuantizedNetwork::new(*layout, *leak, scale, integers, vec![0; layout.state_len()]).expect("a valid network");
    let mut steps = Steps { seed: 1, hash: 0 };
    let (mut x, mut y) = (vec![0; layout.sensors()], vec![0; layout.outputs()]);
    for _ in 0..STEPS {
        x.fill_with(|| ((steps.draw() >> 16) as u16).cast_signed());
        network.step_quantized(&x, &mut y);
        for y in &y {
            steps.add(u32::from(y.cast_unsigned()));
        }
    }
    steps.hash
}

/// Writes both files and compares 100 000 steps of the compiled program with the hash.
fn compare(folder: &Path, name: &str, files: &CFiles, hash: u32) {
    fs::write(folder.join(format!("{name}.h")), &files.header).expect("written");
    fs::write(folder.join(format!("{name}.c")), &files.source).expect("written");
    let program = folder.join(format!("{name}.host"));
    let large = name.to_uppercase();
    let mut compiler = Command::new("cc");
    compiler.args(["-std=c99", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I"]).arg(folder);
    compiler.args([
        format!("-DNETWORK={name}"),
        format!("-DHEADER=\"{name}.h\""),
        format!("-DINPUTS={large}_INPUTS"),
        format!("-DOUTPUTS={large}_OUTPUTS"),
    ]);
    if name.starts_with("integers") {
        compiler.arg("-DINTEGERS");
    }
    compiler.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/firmware/c/steps.c"));
    let compiled =
        compiler.arg(folder.join(format!("{name}.c"))).arg("-o").arg(&program).output().expect("a C compiler");
    assert!(compiled.status.success(), "{name}: {}", String::from_utf8_lossy(&compiled.stderr));
    let output = Command::new(&program).output().expect("the program");
    assert_eq!(String::from_utf8_lossy(&output.stdout), format!("{hash:08x} a\n"), "{name}");
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a scratch directory");
    folder
}

#[test]
fn every_kind_has_the_bits_of_rust() {
    // The boards read their own copies while other tests run.
    let folder = folder(&std::env::var("FARSA_C_FOLDER").unwrap_or_else(|_| "controllers-in-c".into()));
    let mut list = Vec::new();
    let mut finish = |name: &str, small: bool, files: CFiles, hash: u32| {
        compare(&folder, name, &files, hash);
        list.push(format!("{name} {hash:08x} {}\n", if small { "all" } else { "large" }));
    };
    for (name, small, network) in networks() {
        let hash = hash_of(&network);
        finish(name, small, export(network).c(name, "A test").expect("files"), hash);
    }
    let integers = [
        ("integers", true, leaky(3, 2, 1, Leak::Filter)),
        ("integers_two_tap", false, leaky(5, 9, 4, Leak::TwoTap)),
        ("integers_evonet", false, leaky(29, 12, 23, Leak::Evonet)),
    ];
    for (name, small, network) in integers {
        let hash = integer_hash(&network);
        finish(name, small, export(network).c_integers(name, "A test").expect("files"), hash);
    }
    fs::write(folder.join("networks.txt"), list.concat()).expect("written");
}

#[test]
fn names_are_plain_and_bounded_in_comments() {
    let mut controller = export(leaky(2, 1, 1, Leak::Filter));
    controller.sensors[0].name = "a\u{202e}b\\\n*/".into();
    controller.sensors[1] = SensorExport {
        name: "n".repeat(1000),
        reads: SensorReading::JointPosition { joint: "j".repeat(1000), from: 0.0, to: 1.0 },
    };
    controller.motors[0].drives = MotorDrive::Muscle { actuator: "m".repeat(1000), muscle: 0 };
    let CFiles { header, .. } = controller.c("plain", "A\u{2066} test").expect("files");
    let line = |text: &str| header.lines().any(|line| line == text);
    assert!(line("/* A  test.") && line(" *   0 a b  * /"), "{header}");
    let [name, joint, muscle] = ["n", "j", "m"].map(|letter| letter.repeat(200) + "...");
    assert!(line(&format!(" *   1 {name}: position of joint {joint} [rad], 0 at 0, 1 at 1")), "{header}");
    assert!(line(&format!(" *   0 motor 0 : muscle of {muscle} that pulls towards the lower limit")), "{header}");
}

#[test]
fn channels_from_outputs_to_inputs_are_described() {
    let mut controller = export(leaky(2, 1, 2, Leak::Filter));
    controller.sensors[1].reads = SensorReading::PreviousOutput { channel: 1, scale: 50.0 };
    controller.motors[1].drives = MotorDrive::NextInput { channel: 1 };
    let CFiles { header, .. } = controller.c("loop", "A test").expect("files");
    for part in [": output 1 of the previous step, times 50, 0 in the first step\n", ": input 1 of the next step\n"] {
        assert!(header.contains(part), "no {part} in {header}");
    }
}

/// A linear neuron whose weight on itself is 1e20: its activation is x in step 1, about 1e20 in 2, and infinite in 3.
#[test]
fn outputs_without_a_literal_are_refused() {
    let neuron = Span::new(1, 1);
    let groups = vec![Group::new(1, Activation::Linear), Group::new(1, Activation::Linear)];
    let connections = [Block::connect(Span::new(0, 1), neuron), Block::connect(neuron, neuron)];
    let blocks = [vec![Block::Update(Span::new(0, 1))], connections.to_vec(), vec![Block::Update(neuron)]].concat();
    let layout = BlockLayoutBuf { inputs: 1, outputs: 1, groups, blocks };
    let network =
        |weight| NetworkExport::Blocks { layout: layout.clone(), leak: Leak::Filter, parameters: vec![1.0, weight] };
    assert!(export(network(1.0)).c("bounded", "").is_ok());
    let error = export(network(1e20)).c("unbounded", "").expect_err("no files");
    assert!(matches!(error, farsa_lab::Error::Usage(_)), "{error:?}");
    assert!(error.to_string().contains("output 0 of the network is inf in step 3 "), "{error}");
}

#[test]
fn the_self_test_counts_rows_that_differ() {
    let folder = folder("controllers-in-c-changed");
    let network = leaky(3, 2, 1, Leak::Filter);
    let files = export(network).c("changed", "A test").expect("files");
    let start = files.source.find("ROWS_OUT").expect("rows");
    let (before, rows) = files.source.split_at(start);
    // One output of the 16 rows.
    let source = format!("{before}{}", rows.replacen("    0.", "    1.", 1));
    fs::write(folder.join("changed.h"), &files.header).expect("written");
    fs::write(folder.join("changed.c"), source).expect("written");
    fs::write(
        folder.join("main.c"),
        "#include \"changed.h\"\nint main(void) { return changed_selftest() == 1 ? 0 : 1; }\n",
    )
    .expect("written");
    let program = folder.join("main");
    let mut compiler = Command::new("cc");
    compiler.arg("-std=c99").arg("-o").arg(&program).args(["changed.c", "main.c"]).current_dir(&folder);
    assert!(compiler.status().expect("a C compiler").success());
    assert!(Command::new(&program).status().expect("the program").success());
}

#[test]
fn json_lists_every_parameter_with_its_row_and_column() {
    for (name, _, network) in networks() {
        let json = serde_json::to_value(&network).expect("JSON");
        let mut offsets = BTreeMap::new();
        for entry in json["parameters"].as_array().expect("a list") {
            let shape: Vec<usize> = serde_json::from_value(entry["shape"].clone()).expect("a shape");
            let (first, count) = (entry["first"].as_u64().expect("a number") as usize, shape.iter().product::<usize>());
            // Weights of blocks are parts of one table.
            let key = entry["name"].as_str().expect("a name");
            let offset = offsets.entry(key.to_owned()).or_insert(0);
            let table: Vec<f32> = serde_json::from_value(json[key].clone()).expect("a table");
            assert_eq!(network.parameters()[first..first + count], table[*offset..*offset + count], "{name}: {entry}");
            *offset += count;
            let meaning = entry["meaning"].as_str().expect("a text");
            assert_eq!(shape.len() == 2, meaning.contains("row j, column i"), "{name}: {entry}");
        }
        assert_eq!(offsets.values().sum::<usize>(), network.parameters().len(), "{name}");
    }
    // Two connections of a network of blocks, by their neurons.
    let json = serde_json::to_value(blocks(Leak::Filter)).expect("JSON");
    let [first, second] = [&json["parameters"][0], &json["parameters"][1]];
    assert_eq!((&first["shape"], &second["shape"]), (&serde_json::json!([2, 2]), &serde_json::json!([2, 2])));
    assert_eq!(first["meaning"], "blocks[1]: row j, column i from neuron 0 + j to neuron 2 + i");
    assert_eq!(
        (&second["first"], &second["meaning"]),
        (&4.into(), &"blocks[2]: row j, column i from neuron 6 + j to neuron 2 + i".into())
    );
}

#[test]
fn names_and_kinds_without_a_form_in_c_are_errors() {
    let error = |result: Result<CFiles, farsa_lab::Error>| result.expect_err("no files").to_string();
    let network = export(leaky(1, 1, 1, Leak::Filter));
    for (name, nearest) in [("my-robot", "my_robot"), ("3rd", "controller_3rd"), ("", "controller_")] {
        let message = error(network.c(name, ""));
        assert!(message.ends_with(&format!("for example {nearest}")), "{message}");
    }
    let message = error(export(blocks(Leak::Filter)).c_integers("blocks", ""));
    assert!(message.contains("only a leaky network") && message.contains("--format c"), "{message}");
    let mut unnamed = network;
    unnamed.sensors.clear();
    assert!(error(unnamed.c("unnamed", "")).contains("0 sensors and 1 motors"));
}
