//! One step of the network, from borrowed parameters, by its size and at each instruction set that the machine runs.
//!
//! `cargo bench --bench network` measures; instructions are counted by `./ci callgrind`.
#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use farsa::nn::{Controller, Layout, Leak, Network, ParameterKind};
use farsa::num::fearless_simd::Level;
use farsa::num::{Domain, Stream, levels};

/// Different inputs, one a step, so that nothing is learnt from repetition.
const INPUTS: usize = 64;

fn steps(c: &mut Criterion) {
    let mut group = c.benchmark_group("network");
    let layouts = [(29, 12, 23), (29, 10, 23), (29, 30, 23), (29, 100, 23), (29, 300, 23), (29, 1000, 23)];
    for (sensors, hidden, outputs) in layouts {
        let layout = Layout::new(sensors, hidden, outputs);
        let mut stream = Stream::new(1, Domain::InitialGenome, 0, 0, 0);
        let leaks = |kind| kind == ParameterKind::Leak;
        let draw = |kind| if leaks(kind) { stream.uniform() } else { stream.range(-6.0, 6.0) };
        let parameters: Vec<f32> = layout.kinds().map(draw).collect();
        let inputs: Vec<f32> = (0..INPUTS * sensors).map(|_| stream.range(-1.0, 1.0)).collect();
        let (mut state, mut y) = (vec![0.0; layout.state_len()], vec![0.0; outputs]);
        group.throughput(Throughput::Elements(layout.parameter_count() as u64));
        for level in levels(Level::new()) {
            let network = Network::new(layout, Leak::Filter, &parameters[..], &mut state[..]);
            let mut network = network.expect("finite parameters").with_level(level);
            let name = format!("{level:?}").split('(').next().unwrap_or_default().to_lowercase();
            let size = format!("{sensors}-{hidden}-{outputs}");
            group.bench_function(BenchmarkId::new(name, size), |b| {
                let mut x = inputs.chunks_exact(sensors).cycle();
                b.iter(|| network.step(black_box(x.next().unwrap_or_default()), black_box(&mut y)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, steps);
criterion_main!(benches);
