//! Stacks of boxes against their rest in MuJoCo (`tests/fixtures/boxes`), and boxes in lanes.
#![cfg(feature = "alloc")]
#![allow(missing_docs, clippy::unwrap_used)]

use std::fs;

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Kinematics as _, World as _};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, Surface};
use farsa_physics::articulated::{Model, Options, Precision, World};
use serde_json::Value;

const SURFACE: Surface = Surface { friction: 0.5, rolling_friction: 0.0, stiffness: 1e5, damping: 300.0 };

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    core::array::from_fn(|k| value[k].as_f64().unwrap())
}

fn fixture() -> Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/boxes/boxes.json");
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// The scene, and its moving bodies.
fn scene_of(boxes: &[Value]) -> (Robot, Vec<BodyId>) {
    let mut robot = Robot::new("boxes");
    let ground = robot.add_collider(Collider::new("ground", None, Shape::Plane, Pose::identity()));
    let (mut bodies, mut colliders) = (Vec::new(), Vec::new());
    for (number, value) in boxes.iter().enumerate() {
        let (half, position) = (numbers(&value["half"]), numbers(&value["position"]));
        let (sine, cosine) = farsa_num::sin_cos(0.5 * value["heading"].as_f64().unwrap());
        let pose = Pose { position, rotation: [0.0, 0.0, sine, cosine] };
        let (name, mass) = (format!("box {number}"), value["mass"].as_f64().unwrap());
        let body = (mass > 0.0).then(|| {
            let solid = MassProperties::cuboid(mass, half);
            robot.add_segment(Segment::new(&name, None, Joint::floating(pose), solid))
        });
        let place = if body.is_some() { Pose::identity() } else { pose };
        let collider = robot.add_collider(Collider::new(&name, body, Shape::Box { half }, place));
        if body.is_some() {
            robot.add_pair([collider, ground], SURFACE);
        }
        for (other, fixed) in &colliders {
            if body.is_some() || !fixed {
                robot.add_pair([*other, collider], SURFACE);
            }
        }
        bodies.extend(body);
        colliders.push((collider, body.is_none()));
    }
    (robot, bodies)
}

fn world_of<R: Precision>(robot: &Robot, options: &Options) -> World<R> {
    World::new(Model::new(robot, options).unwrap())
}

fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f32>().sqrt()
}

/// Once the sway of its compliant contacts has died out, within 10 s, no box moves by more than 1 mm in a minute. MuJoCo's
/// boxes rest at the same places, up to the sink of the contacts and MuJoCo's own creep.
#[test]
fn stacks_rest_for_a_minute_where_they_rest_in_mujoco() {
    let fixture = fixture();
    assert_eq!(fixture["friction"], SURFACE.friction);
    let seconds = fixture["seconds"].as_f64().unwrap() as usize;
    let mut failed = Vec::new();
    for scene in fixture["scenes"].as_array().unwrap() {
        let name = scene["name"].as_str().unwrap();
        let (robot, bodies) = scene_of(scene["boxes"].as_array().unwrap());
        let mut world = world_of::<f32>(&robot, &Options::default());
        let places = |world: &World<f32>| bodies.iter().map(|b| world.pose(*b).position).collect::<Vec<_>>();
        (0..1000).for_each(|_| world.step());
        let settled = places(&world);
        let (mut creep, mut off) = (0.0_f32, 0.0_f32);
        for _ in 10..10 + seconds {
            (0..100).for_each(|_| world.step());
            for (now, then) in places(&world).into_iter().zip(&settled) {
                creep = creep.max(distance(now, *then));
            }
        }
        for (at, rest) in places(&world).into_iter().zip(scene["rest"].as_array().unwrap()) {
            off = off.max(distance(at, numbers(rest).map(|x| x as f32)));
        }
        let line = format!("{name}: creep {:.3} mm, {:.2} mm from MuJoCo's rest", 1e3 * creep, 1e3 * off);
        println!("{line}");
        if creep > 1e-3 || f64::from(off) > 3e-3 + scene["creep"].as_f64().unwrap() {
            failed.push(line);
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
}

/// Two boxes at the same place are pushed apart, and so are two of which one is deep in the other.
#[test]
fn boxes_in_each_other_leave_each_other() {
    for offset in [[0.0; 3], [0.01, -0.02, 0.03], [0.0, 0.0, 0.05], [0.03, 0.03, 0.03]] {
        let boxes: Vec<Value> = [[0.0; 3], offset]
            .map(|at| serde_json::json!({ "half": [0.05, 0.05, 0.05], "position": at, "heading": 0.0, "mass": 1.0 }))
            .to_vec();
        let (mut robot, bodies) = scene_of(&boxes);
        // Without the ground.
        robot.pairs.retain(|pair| pair.colliders[1] != 0);
        let mut world = world_of::<f64>(&robot, &Options { gravity: [0.0; 3], ..Options::default() });
        (0..100).for_each(|_| world.step());
        let [a, b] = [0, 1].map(|k: usize| world.pose(bodies[k]).position);
        let apart = (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f32::max);
        assert!(apart > 0.0999, "{offset:?}: {a:?} {b:?}");
        let middle = distance(core::array::from_fn(|k| 0.5 * (a[k] + b[k])), offset.map(|x| 0.5 * x as f32));
        assert!(middle < 1e-6, "the middle moves by {middle} m");
    }
}

/// Every lane has another tower, with boxes that fall, slide, tilt and lie in each other.
#[cfg(feature = "lanes")]
#[test]
fn lanes_of_boxes_have_the_bits_of_worlds() {
    use farsa_body::ports::{Arrange as _, Snapshot as _};
    use farsa_num::{Domain, Stream};
    use farsa_physics::articulated::{Batch, LANES};

    let fixture = fixture();
    let scene = fixture["scenes"].as_array().unwrap().iter().find(|s| s["name"] == "corner").unwrap();
    let (robot, bodies) = scene_of(scene["boxes"].as_array().unwrap());
    let model = Model::<f32>::new(&robot, &Options::default()).unwrap();
    let sizes = Batch::instructions().flat_map(|level| LANES.map(|lanes| (level, lanes)));
    for (level, lanes) in sizes {
        let mut batch = Batch::new(model.clone(), lanes, level).unwrap();
        let mut worlds = vec![World::new(model.clone()); lanes];
        for (lane, world) in worlds.iter_mut().enumerate() {
            let mut stream = Stream::new(7, Domain::Start, lane as u32, 0, 0);
            let mut lane = batch.lane(lane);
            for body in &bodies {
                let position = core::array::from_fn(|_| stream.range(0.0, 0.3));
                let rotation = core::array::from_fn(|_| stream.range(-1.0, 1.0));
                let twist = farsa_body::Twist::default();
                world.place_body(*body, Pose { position, rotation }, twist);
                lane.place_body(*body, Pose { position, rotation }, twist);
            }
            world.finish_placement();
            lane.finish_placement();
        }
        let mut state = vec![0.0; model.state_len()];
        for step in 0..150 {
            batch.step();
            for (lane, world) in worlds.iter_mut().enumerate() {
                world.step();
                batch.lane(lane).save(&mut state);
                let equal = state.iter().zip(world.state()).all(|(a, b)| a.to_bits() == b.to_bits());
                assert!(equal, "lane {lane} of {lanes} differs at step {step}");
            }
        }
    }
}
