//! One step of the network, from borrowed parameters, by its size and at each instruction set that the machine runs.
//!
//! `cargo bench --bench network` measures times, and `./ci callgrind` counts instructions. The continuous networks are
//! compared with a naive version in Rust and, where `python3` (or the program in `PYTHON`) has it, with numpy.
#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use farsa::nn::{
    Controller, Ctrnn, CtrnnLayout, CtrnnParameter, Integrator, Leak, LeakyLayout, LeakyNetwork, LeakyParameter,
};
use farsa::num::{Domain, Instructions, Stream};

/// Different inputs, one a step, so that nothing is learnt from repetition.
const INPUTS: usize = 64;

fn steps(c: &mut Criterion) {
    let mut group = c.benchmark_group("network");
    let layouts = [(29, 12, 23), (29, 10, 23), (29, 30, 23), (29, 100, 23), (29, 300, 23), (29, 1000, 23)];
    for (sensors, hidden, outputs) in layouts {
        let layout = LeakyLayout::new(sensors, hidden, outputs);
        let mut stream = Stream::new(1, Domain::InitialGenome, 0, 0, 0);
        let leaks = |kind| kind == LeakyParameter::Leak;
        let draw = |kind| if leaks(kind) { stream.uniform() } else { stream.range(-6.0, 6.0) };
        let parameters: Vec<f32> = layout.kinds().map(draw).collect();
        let inputs: Vec<f32> = (0..INPUTS * sensors).map(|_| stream.range(-1.0, 1.0)).collect();
        let (mut state, mut y) = (vec![0.0; layout.state_len()], vec![0.0; outputs]);
        group.throughput(Throughput::Elements(layout.parameter_count() as u64));
        for instructions in Instructions::available() {
            let network = LeakyNetwork::new(layout, Leak::Filter, &parameters[..], &mut state[..]);
            let mut network = network.expect("finite parameters").with_instructions(instructions);
            let name = instructions.to_string();
            let size = format!("{sensors}-{hidden}-{outputs}");
            group.bench_function(BenchmarkId::new(name, size), |b| {
                let mut x = inputs.chunks_exact(sensors).cycle();
                b.iter(|| network.step(black_box(x.next().unwrap_or_default()), black_box(&mut y)));
            });
        }
    }
    group.finish();
}

/// The obvious version: neuron by neuron, a row of weights each, in single precision.
struct Naive {
    time_step: f32,
    states: Vec<f32>,
    outputs: Vec<f32>,
    /// From neuron `j` to `i` at `[i][j]`.
    weights: Vec<Vec<f32>>,
    biases: Vec<f32>,
    gains: Vec<f32>,
    time_constants: Vec<f32>,
}

impl Naive {
    fn new(layout: CtrnnLayout, time_step: f32, parameters: &[f32]) -> Self {
        let (n, parts) = (layout.neurons(), layout.split(parameters));
        Self {
            time_step,
            states: vec![0.0; n],
            outputs: vec![0.0; n],
            weights: (0..n).map(|i| parts.weights.iter().skip(i).step_by(n).copied().collect()).collect(),
            biases: parts.biases.to_vec(),
            gains: parts.gains.to_vec(),
            time_constants: parts.time_constants.to_vec(),
        }
    }

    #[allow(clippy::disallowed_methods, reason = "naive")]
    fn step(&mut self, x: &[f32]) {
        for i in 0..self.states.len() {
            self.outputs[i] = 1.0 / (1.0 + (-self.gains[i] * (self.states[i] + self.biases[i])).exp());
        }
        for i in 0..self.states.len() {
            let mut net = x[i];
            for j in 0..self.outputs.len() {
                net += self.weights[i][j] * self.outputs[j];
            }
            self.states[i] += self.time_step * (net - self.states[i]) / self.time_constants[i];
        }
    }
}

/// Fully recurrent continuous networks, an external input for each neuron.
fn continuous(c: &mut Criterion) {
    let mut group = c.benchmark_group("ctrnn");
    for neurons in [14, 64, 256, 1000] {
        let layout = CtrnnLayout::new(neurons, neurons, neurons).with_direct_inputs(0);
        let mut stream = Stream::new(1, Domain::InitialGenome, 0, 0, 0);
        let draw = |kind| match kind {
            CtrnnParameter::TimeConstant => stream.range(1.0, 2.0),
            CtrnnParameter::Gain => 1.0,
            _ => stream.range(-1.0, 1.0),
        };
        let parameters: Vec<f32> = layout.kinds().map(draw).collect();
        let inputs: Vec<f32> = (0..INPUTS * neurons).map(|_| stream.range(-1.0, 1.0)).collect();
        let mut y = vec![0.0; neurons];
        group.throughput(Throughput::Elements(layout.parameter_count() as u64));
        for (instructions, integrator) in
            Instructions::available().flat_map(|instructions| Integrator::ALL.map(|one| (instructions, one)))
        {
            let layout = layout.with_integrator(integrator);
            let network = Ctrnn::new(layout, 0.01, &parameters[..], vec![0.0; layout.state_len()]);
            let mut network = network.expect("finite parameters").with_instructions(instructions);
            let name = instructions.to_string();
            group.bench_function(BenchmarkId::new(format!("{integrator} {name}"), neurons), |b| {
                let mut x = inputs.chunks_exact(neurons).cycle();
                b.iter(|| network.step(black_box(x.next().unwrap_or_default()), black_box(&mut y)));
            });
        }
        let mut naive = Naive::new(layout, 0.01, &parameters);
        group.bench_function(BenchmarkId::new("euler naive", neurons), |b| {
            let mut x = inputs.chunks_exact(neurons).cycle();
            b.iter(|| naive.step(black_box(x.next().unwrap_or_default())));
        });
    }
    group.finish();
    // The version in numpy, in this run, except where benches are only tried.
    if !std::env::args().any(|argument| argument == "--test") {
        let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/ctrnn_numpy.py");
        match std::process::Command::new(&python).arg(script).status() {
            Ok(status) if status.success() => {}
            other => println!("{python} with numpy could not be run ({other:?}): nothing to stand beside"),
        }
    }
}

criterion_group!(benches, steps, continuous);
criterion_main!(benches);
