//! One 10 ms control step of the whole loop, one world on one core, and the kernels below it.
//!
//! `cargo bench` measures; instructions are counted by `./ci callgrind`.
#![allow(missing_docs)]

mod scene;

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use scene::{Aba, Loop};

fn whole_loop(c: &mut Criterion) {
    let mut group = c.benchmark_group("control_step");
    for (name, made) in [("free", Loop::free()), ("grasp", Loop::grasp())] {
        let mut whole = made.expect("the default scene");
        let [[p0, p1], [n0, n1]] = whole.contacts();
        println!("control_step/{name}: {p0} to {p1} pairs touch at {n0} to {n1} points");
        group.bench_function(name, |b| b.iter(|| whole.control_step()));
    }
    group.finish();
}

fn kernels(c: &mut Criterion) {
    for joints in [7, 27] {
        let mut aba = Aba::new(joints).expect("the default arm");
        c.bench_function(&format!("aba/{joints}"), |b| b.iter(|| black_box(aba.accelerations())));
    }
    let pair = scene::muscles().expect("the default arm");
    let at = || (black_box(0.3_f32), black_box(-0.2_f32), black_box([0.4, 0.1]));
    c.bench_function("muscle_pair", |b| {
        b.iter(|| {
            let (q, speed, command) = at();
            pair.effort(q, speed, command)
        });
    });
}

criterion_group!(benches, whole_loop, kernels);
criterion_main!(benches);
