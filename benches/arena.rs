//! Control steps of planar worlds: a Khepera through sensors and ports, many Kheperas in lanes, and ten thousand in one arena.
//!
//! `cargo bench --bench arena` measures, elements are robot steps.
#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use farsa::body::motors::WheelVelocity;
use farsa::body::ports::{Actuated, Arrange, BodyId, Kinematics, Motor as _, Planar, Sensor as _, World as _};
use farsa::body::robots::{MobileParts, MobileRobot};
use farsa::body::sensors::infrared::{InfraredFormula, InfraredModel};
use farsa::body::{Pose, Twist};
use farsa::nn::{Controller, Perceptron, PerceptronLanes};
use farsa::num::{Domain, Stream};
use farsa::physics::arena::{Arena, ArenaError, Batch, Cylinder, World};

/// Four walls and a small cylinder, 50 ms.
fn arena() -> Arena {
    let mut arena = Arena::walled(0.4, 0.4);
    arena.add_cylinder(Cylinder::new([0.28, 0.24], 0.0125));
    arena.add_robot(MobileRobot::khepera(), [0.12, 0.2], 0.0);
    arena
}

/// Weights of a robot that turns away from near surfaces: it drives around, and touches walls and the cylinder.
fn parameters() -> Vec<f32> {
    // Left to right in front, six sensors to the left and the right wheel. Then the biases.
    let weights = [[4.0, -4.0], [4.0, -5.0], [3.0, -6.0], [-5.0, 2.0], [-5.0, 3.0], [-4.0, 4.0]];
    weights.into_iter().flatten().chain([2.0, 1.6]).collect()
}

const MOST: f32 = 1.1 * std::f32::consts::TAU;

fn one_through_ports(c: &mut Criterion) -> Result<(), ArenaError> {
    let mut group = c.benchmark_group("arena");
    group.throughput(Throughput::Elements(1));
    let mut world = World::new(&arena())?;
    let parts = world.parts(0);
    let mut network = Perceptron::new(6, 2, 1.0, parameters()).expect("finite");
    let (mut x, mut y) = ([0.0; 8], [0.0; 2]);
    let mut infrared = InfraredFormula::for_robot(&MobileRobot::khepera(), parts.body).expect("a Khepera's ring");
    let mut wheels = WheelVelocity::new(parts.motors, MOST).expect("a Khepera's wheels");
    group.bench_function("world/sensor and motor", |b| {
        b.iter(|| {
            infrared.read(&world, &mut x);
            network.step(black_box(&x[..6]), &mut y);
            wheels.drive(&y, &mut world);
            world.step();
        });
    });
    group.bench_function("world/infrared", |b| {
        b.iter(|| {
            world.infrared(0, &mut x);
            network.step(black_box(&x[..6]), &mut y);
            drive(&mut world, &parts, y);
            world.step();
        });
    });
    group.bench_function("world/step", |b| b.iter(|| world.step()));
    group.finish();
    Ok(())
}

fn axes() -> Vec<[f32; 2]> {
    let directions = MobileRobot::khepera().infrared.angles.into_iter().map(farsa::num::sin_cos::<f64>);
    directions.map(|(sine, cosine)| [cosine as f32, sine as f32]).collect()
}

fn drive(world: &mut World, parts: &MobileParts, y: [f32; 2]) {
    for (motor, y) in parts.motors.into_iter().zip(y) {
        world.command(motor, [(2.0 * y - 1.0) * MOST, 0.0]);
    }
}

/// Reads the ring through a world's port.
fn ring<W>(world: &W, robot: BodyId, radius: f32, axes: &[[f32; 2]], out: &mut [f32])
where
    W: Planar<Body = BodyId> + Kinematics,
{
    let pose = world.pose(robot);
    let at = [pose.position[0], pose.position[1]];
    let [axis_x, axis_y, _] = pose.rotate([1.0, 0.0, 0.0]);
    out.fill(0.0);
    world.query_near(at, radius + 0.033, &mut |near| {
        if near.body == Some(robot) {
            return;
        }
        let model = InfraredModel::for_radius(near.radius);
        let distance = near.distance - radius;
        if distance >= model.range() {
            return;
        }
        let way = [near.point[0] - at[0], near.point[1] - at[1]];
        let per = 1.0 / near.distance;
        let ahead = (way[0] * axis_x + way[1] * axis_y) * per;
        let left = (way[1] * axis_x - way[0] * axis_y) * per;
        let strength = model.distance_term(distance);
        for (sum, [x, y]) in out.iter_mut().zip(axes) {
            *sum += strength * model.angle_term(ahead * x + left * y);
        }
    });
    for sum in out {
        *sum = InfraredModel::reading(*sum);
    }
}

/// As many worlds as lanes, each with its own network: ring, network, wheels, step.
fn lanes(c: &mut Criterion) -> Result<(), ArenaError> {
    let mut group = c.benchmark_group("arena");
    for (instructions, lanes) in
        Batch::instructions().flat_map(|instructions| [8, 16].map(|lanes| (instructions, lanes)))
    {
        let mut batch = Batch::new(&arena(), lanes, instructions)?;
        let genome = parameters();
        let mut network = PerceptronLanes::new(6, 2, 1.0, lanes, vec![0.0; genome.len() * lanes]).expect("finite");
        let mut stream = Stream::new(1, Domain::Start, 0, 0, 0);
        for lane in 0..lanes {
            let own: Vec<f32> = genome.iter().map(|w| w * stream.range(0.8, 1.2)).collect();
            network.set_lane(lane, &own).expect("as many");
            let at = [stream.range(0.06, 0.2), stream.range(0.06, 0.34)];
            batch.lane(lane).place_body(BodyId(0), Pose::planar(at, stream.range(-3.0, 3.0)), Twist::default());
            batch.lane(lane).finish_placement();
        }
        let network = network.with_instructions(instructions);
        let parts = batch.parts(0);
        let (mut x, mut y) = (vec![0.0; 8 * lanes], vec![0.0; 2 * lanes]);
        let set = format!("{instructions:?}");
        group.throughput(Throughput::Elements(lanes as u64));
        group.bench_function(format!("{lanes} lanes/{set}"), |b| {
            b.iter(|| {
                batch.infrared(0, &mut x);
                network.step(black_box(&x), &mut y);
                for (motor, y) in parts.motors.into_iter().zip(y.chunks_exact_mut(lanes)) {
                    for y in &mut *y {
                        *y = (2.0 * *y - 1.0) * MOST;
                    }
                    batch.command(motor, y);
                }
                batch.step();
            });
        });
        group.bench_function(format!("{lanes} lanes/{set}/infrared"), |b| b.iter(|| batch.infrared(0, &mut x)));
        group.bench_function(format!("{lanes} lanes/{set}/step"), |b| b.iter(|| batch.step()));
    }
    group.finish();
    Ok(())
}

/// Kheperas on a lattice, 10 Hz.
fn many(c: &mut Criterion) -> Result<(), ArenaError> {
    const SIDE: usize = 100;
    let mut arena = Arena { time_step: 0.1, ..Arena::walled(20.0, 20.0) };
    let mut stream = Stream::new(1, Domain::Start, 0, 0, 0);
    for i in 0..SIDE * SIDE {
        let at = [0.1 + 0.2 * (i % SIDE) as f64, 0.1 + 0.2 * (i / SIDE) as f64];
        arena.add_robot(MobileRobot::khepera(), at, stream.range_f64(-3.0, 3.0));
    }
    let mut world = World::new(&arena)?;
    let robots = world.robots();
    let axes = axes();
    let mut network = Perceptron::new(6, 2, 1.0, parameters()).expect("finite");
    let parts: Vec<MobileParts> = (0..robots).map(|robot| world.parts(robot)).collect();
    let mut x = vec![0.0; 8 * robots];
    let mut group = c.benchmark_group("arena");
    group.throughput(Throughput::Elements(robots as u64));
    group.sample_size(20);
    group.bench_function("10000 robots/near, network, step", |b| {
        b.iter(|| {
            for (parts, x) in parts.iter().zip(x.chunks_exact_mut(8)) {
                ring(&world, parts.body, 0.035, &axes, x);
            }
            let mut y = [0.0; 2];
            for (parts, x) in parts.iter().zip(x.chunks_exact(8)) {
                network.step(&x[..6], &mut y);
                drive(&mut world, parts, y);
            }
            world.step();
        });
    });
    group.bench_function("10000 robots/near", |b| {
        b.iter(|| {
            for (parts, x) in parts.iter().zip(x.chunks_exact_mut(8)) {
                ring(&world, parts.body, 0.035, &axes, x);
            }
        });
    });
    group.bench_function("10000 robots/infrared", |b| {
        b.iter(|| x.chunks_exact_mut(8).enumerate().for_each(|(robot, x)| world.infrared(robot, x)));
    });
    group.bench_function("10000 robots/step", |b| b.iter(|| world.step()));
    group.finish();
    Ok(())
}

fn arenas(c: &mut Criterion) {
    one_through_ports(c).expect("a valid arena");
    lanes(c).expect("a valid arena");
    many(c).expect("a valid arena");
}

criterion_group!(benches, arenas);
criterion_main!(benches);
