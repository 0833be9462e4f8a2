//! One 10 ms control step of the whole loop, one world on one core, and the kernels below it.
//!
//! `cargo bench` measures times, and `./ci callgrind` counts instructions.
#![allow(missing_docs)]

mod scene;

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use farsa::body::Pose;
use farsa::body::ports::{BodyId, Channels, Sensor};
use farsa::body::robots::{ArmAndHand, Tabletop};
use farsa::body::sensors::{Camera, CameraImage};
use farsa::physics::articulated::{Batch, LANES, Model, Options, World};
use scene::{Aba, Lanes, Loop, Step};

fn whole_loop(c: &mut Criterion) {
    let mut group = c.benchmark_group("control_step");
    for (name, made) in [("free", Loop::free()), ("grasp", Loop::grasp())] {
        let mut whole = made.expect("the default scene");
        println!("control_step/{name}: {}", whole.contacts());
        group.throughput(Throughput::Elements(1));
        group.bench_function(name, |b| b.iter(|| whole.control_step()));
        let made = if name == "free" { Loop::free } else { Loop::grasp };
        for (instructions, lanes) in
            Batch::instructions().flat_map(|instructions| LANES.map(|lanes| (instructions, lanes)))
        {
            let set = format!("{instructions:?}");
            let mut together = Lanes::new(made, lanes, instructions).expect("the default scene");
            // The elements are worlds: thousands of them a second.
            group.throughput(Throughput::Elements(lanes as u64));
            group.bench_function(format!("{name}/{lanes} lanes/{set}"), |b| b.iter(|| together.control_step()));
        }
    }
    group.finish();
}

/// The world's step from one state, with the scene's pairs and without: the difference is the contacts' part.
fn contacts(c: &mut Criterion) {
    let mut group = c.benchmark_group("contacts");
    for (name, made) in [("free", Loop::free()), ("grasp", Loop::grasp())] {
        let mut whole = made.expect("the default scene");
        for (pairs, name) in [(false, format!("{name}/without pairs")), (true, name.into())] {
            let mut alone = Step::new(&mut whole, pairs).expect("the default scene");
            println!("contacts/{name}: {}", alone.contacts());
            group.bench_function(name, |b| b.iter(|| alone.step()));
        }
    }
    group.finish();
}

fn kernels(c: &mut Criterion) {
    for joints in [7, 27, 100] {
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

/// The image of a camera above the shoulder that looks at the table, 768 rays against the scene's colliders.
fn image(c: &mut Criterion) {
    let robot = Tabletop::default().scene(&ArmAndHand::default()).expect("the default scene");
    let world = World::new(Model::<f32>::new(&robot, &Options::default()).expect("the default scene"));
    // Turned by 50 degrees about y: downwards.
    let placement = Pose { position: [0.0, 0.1, 0.3], rotation: [0.0, 0.422_618_27, 0.0, 0.906_307_76] };
    let camera = Camera::new(BodyId(0), placement, [32, 24], 1.2, 2.0).expect("a camera");
    let mut image = CameraImage::new(camera.clone());
    let mut pixels = vec![0.0; image.channels()];
    let mut group = c.benchmark_group("image");
    group.throughput(Throughput::Elements(768));
    let mut eye = camera;
    let met = eye.look(&world).iter().flatten().count();
    println!("image: {met} of 768 rays meet one of {} colliders", robot.colliders.len());
    group.bench_function("32 x 24", |b| b.iter(|| image.read(&world, black_box(&mut pixels))));
    group.finish();
}

criterion_group!(benches, whole_loop, contacts, kernels, image);
criterion_main!(benches);
