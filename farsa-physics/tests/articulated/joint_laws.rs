//! Springs and dry friction of joints, against MuJoCo (`fixtures/joint_laws.py`) and closed forms.

use farsa_body::Pose;
use farsa_body::actuators::{Law, Servo, Torque};
use farsa_body::ports::{Actuated as _, ActuatorId, Arrange as _, JointId, World as _};
use farsa_body::robot::{Impedance, Joint, MassProperties, Robot, Segment, Stop};
use farsa_num::{exp, sin_cos};
use farsa_physics::articulated::{Model, Options, Scratch, World, mass_matrix};
use serde::Deserialize;

use crate::agreement::{difference, read, robot};

const ENDLESS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

#[derive(Deserialize)]
struct Laws {
    time_step: f64,
    joints: Vec<[f64; 6]>,
    states: Vec<State>,
    /// One number, the inertia of the joint with limits.
    inertia: [f64; 1],
    paths: Vec<Path>,
}

/// Path of a joint with limits under a constant torque, every 10 ms.
#[derive(Deserialize)]
struct Path {
    start: f64,
    torque: f64,
    positions: Vec<f64>,
}

#[derive(Deserialize)]
struct State {
    q: Vec<f64>,
    v: Vec<f64>,
    command: Vec<f64>,
    velocity: Vec<f64>,
}

#[test]
fn a_step_of_springs_dampers_dry_friction_and_servos_agrees_with_mujoco() {
    let laws: Laws = read("joint_laws");
    let (mut robot, gravity) = robot("tree27", &read("tree27"));
    let joints: Vec<JointId> = robot.joints().collect();
    for (id, [stiffness, rest, damping, friction, kp, kv]) in joints.into_iter().zip(laws.joints) {
        let joint = &mut robot.segments[id.index()].joint;
        *joint = joint.clone().with_spring(stiffness, rest).with_damping(damping).with_friction(friction);
        let servo = Servo { stiffness: kp, damping: kv, limit: f64::INFINITY };
        robot.add_actuator(&format!("servo {}", id.0), id, Law::Servo(servo));
    }
    let options = Options { time_step: laws.time_step, substeps: 1, gravity, ..Options::default() };
    let mut world = World::new(Model::<f64>::new(&robot, &options).unwrap());
    let mut worst = 0.0_f64;
    for state in &laws.states {
        world.clear();
        let commands = state.command.iter().flat_map(|command| [*command, 0.0]);
        let words = state.q.iter().chain(&state.v).copied().chain(commands);
        world.state_mut().iter_mut().zip(words).for_each(|(word, x)| *word = x);
        world.finish_placement();
        world.step();
        worst = worst.max(difference(world.velocities(), &state.velocity));
    }
    println!("velocities after a step: {worst:.1e}");
    assert!(laws.states.len() == 20 && worst <= 1e-10, "{worst}");
}

/// Time step of the tests of single steps.
const H: f64 = 1e-3;

/// A step of a tree without contacts: what a law of its joints changes.
struct Change {
    q: Vec<f64>,
    /// Impulses of the law on each joint, from the change of the velocities by the mass matrix.
    impulses: Vec<f64>,
    /// Velocities before and after the step.
    before: Vec<f64>,
    after: Vec<f64>,
}

/// Steps a robot without a law and the same robot with it once from each state, with its velocities times `speed`.
fn changes(robots: [&Robot; 2], laws: &Laws, speed: f64, sweeps: u32) -> Vec<Change> {
    let options = Options { time_step: H, substeps: 1, sweeps, settled: 0.0, gravity: [0.0; 3], ..Options::default() };
    let mut worlds = robots.map(|robot| World::new(Model::<f64>::new(robot, &options).unwrap()));
    let n = worlds[0].model().dofs();
    let mut scratch = Scratch::new((), worlds[0].model());
    let change = |state: &State| {
        let before: Vec<f64> = state.v.iter().map(|v| speed * v).collect();
        let words = [&*state.q, &before].concat();
        let [free, bound] = worlds.each_mut().map(|world| {
            world.clear();
            world.state_mut().iter_mut().zip(&words).for_each(|(word, x)| *word = *x);
            world.finish_placement();
            world.step();
            world.velocities().to_vec()
        });
        scratch.forward_kinematics((), worlds[0].model(), &words);
        let mut mass = vec![0.0; n * n];
        mass_matrix((), worlds[0].model().links(), scratch.links(), &mut mass);
        let impulse = |row: &[f64]| row.iter().zip(bound.iter().zip(&free)).map(|(m, (a, b))| m * (a - b)).sum();
        Change { q: state.q.clone(), impulses: mass.chunks(n).map(impulse).collect(), before, after: bound }
    };
    laws.states.iter().map(change).collect()
}

/// Slow joints, of which some stick: each impulse is within its limit, and only a joint with the largest one moves, against
/// it. This determines the impulses.
#[test]
fn impulses_of_dry_friction_keep_coulombs_law() {
    let (free, _) = robot("tree27", &read("tree27"));
    let laws: Laws = read("joint_laws");
    let mut rubbing = free.clone();
    let limits: Vec<f64> = laws.joints.iter().map(|joint| 4.0 * joint[3]).collect();
    for (id, limit) in free.joints().zip(&limits) {
        rubbing.segments[id.index()].joint.friction = *limit;
    }
    let (mut sticking, mut sliding) = (0, 0);
    for Change { impulses, after, .. } in changes([&free, &rubbing], &laws, 0.002, 2000) {
        for (i, (limit, impulse)) in limits.iter().zip(impulses).enumerate() {
            let (share, speed) = (impulse / (H * limit), after[i]);
            assert!(share.abs() <= 1.0 + 1e-6, "joint {i}: {share} of its limit");
            if share.abs() < 1.0 - 1e-6 {
                assert!(speed.abs() < 1e-9, "joint {i} moves at {speed} under {share} of its limit");
                sticking += 1;
            } else {
                assert!(speed * share < 1e-9, "joint {i} moves at {speed} along its friction");
                sliding += 1;
            }
        }
    }
    println!("{sticking} joints stick, {sliding} slide");
    assert!(sticking > 100 && sliding > 100, "{sticking} {sliding}");
}

/// Speeds above and below the limit: each is within it, and only a joint at it has an impulse, against its motion. This
/// determines the impulses.
#[test]
fn impulses_at_largest_speeds_only_brake() {
    let (free, _) = robot("tree27", &read("tree27"));
    let laws: Laws = read("joint_laws");
    let mut limited = free.clone();
    let joints: Vec<JointId> = free.joints().collect();
    let limits: Vec<f64> = (0..joints.len()).map(|i| 0.2 + 0.05 * i as f64).collect();
    for (id, limit) in joints.iter().zip(&limits) {
        limited.segments[id.index()].joint.speed_limit = Some(*limit);
    }
    let (mut braked, mut idle) = (0, 0);
    for Change { impulses, after, .. } in changes([&free, &limited], &laws, 0.25, 2000) {
        for (i, (limit, impulse)) in limits.iter().zip(impulses).enumerate() {
            let speed = after[i];
            assert!(speed.abs() <= limit + 1e-9, "joint {i}: {speed} above {limit}");
            if speed.abs() < limit - 1e-9 {
                assert!(impulse.abs() < 1e-9, "joint {i}: an impulse of {impulse} at {speed}, below {limit}");
                idle += 1;
            } else {
                assert!(impulse * speed < 1e-9, "joint {i}: an impulse of {impulse} along {speed}");
                braked += 1;
            }
        }
    }
    println!("{braked} joints are braked, {idle} are not");
    assert!(braked > 100 && idle > 100, "{braked} {idle}");
}

/// MuJoCo's default limits: a time constant of 20 ms and an impedance of 0.95, which are constant here.
fn default_limits(inertia: f64) -> Stop {
    Stop { stiffness: 5e4 * inertia, damping: 2000.0 * inertia, inertia: 19.0 * inertia, impedance: None }
}

#[test]
fn soft_stops_hold_a_joint_as_limits_of_mujoco_do() {
    let Laws { inertia: [inertia], paths, .. } = read("joint_laws");
    let ball = MassProperties::sphere(1.0, 0.1);
    let mut joint = Joint::revolute("hinge", [0.0, 1.0, 0.0], Pose::identity(), [-1.0, 0.5]);
    joint.armature = inertia - ball.inertia[0];
    joint.stop = Some(default_limits(inertia));
    let mut robot = Robot::new("hinge");
    robot.add_segment(Segment::new("arm", None, joint, ball));
    robot.add_actuator("motor", JointId(0), Law::Torque(Torque { limit: 100.0 }));
    assert_eq!(paths.len(), 4);
    for (substeps, tolerance) in [(500, 1.5e-3), (4, 0.1)] {
        let options = Options { substeps, gravity: [0.0; 3], ..Options::default() };
        let mut world = World::new(Model::<f64>::new(&robot, &options).unwrap());
        for Path { start, torque, positions } in &paths {
            world.clear();
            world.state_mut()[0] = *start;
            world.finish_placement();
            world.command(ActuatorId(0), [*torque as f32, 0.0]);
            for (tick, wanted) in positions.iter().enumerate() {
                world.step();
                let q = world.positions()[0];
                assert!((q - wanted).abs() < tolerance, "{substeps} from {start}, tick {tick}: {q}, not {wanted}");
            }
        }
    }
}

/// Joints of a tree beyond their limits, of which some return by themselves: each impulse is that of the law, or 0.
#[test]
fn impulses_of_soft_stops_keep_their_law() {
    let (free, _) = robot("tree27", &read("tree27"));
    let laws: Laws = read("joint_laws");
    let mut stopped = free.clone();
    let mut stops: Vec<Stop> = laws.joints.iter().map(|joint| default_limits(joint[2])).collect();
    // The impedance of every other stop changes.
    for stop in stops.iter_mut().step_by(2) {
        stop.impedance = Some(Impedance { surface: 0.1, deep: 0.95, width: 0.3, midpoint: 0.5, power: 2 });
    }
    for (id, stop) in free.joints().zip(&stops) {
        let joint = &mut stopped.segments[id.index()].joint;
        (joint.range, joint.stop) = ([-0.4, 0.3], Some(*stop));
    }
    let (mut pushing, mut idle) = (0, 0);
    for Change { q, impulses, before, after } in changes([&free, &stopped], &laws, 5.0, 5000) {
        for (i, Stop { stiffness, damping, inertia, impedance }) in stops.iter().enumerate() {
            let (q, inward) = (q[i], if q[i] > 0.0 { -1.0 } else { 1.0 });
            let depth = (q - 0.3).max(-0.4 - q);
            let d = impedance.map_or(0.95, |law| law.at(depth));
            let factor = d * 0.05 / (0.95 * (1.0 - d));
            let [stiffness, damping, inertia] = [stiffness * factor * d / 0.95, damping * factor, inertia * factor];
            let [impulse, before, after] = [impulses[i], before[i], after[i]].map(|x| inward * x);
            let force = stiffness * (depth - H * after) - damping * after - inertia * (after - before) / H;
            let wanted = if depth > 0.0 { H * force.max(0.0) } else { 0.0 };
            let size = H * (stiffness * depth.abs() + damping * after.abs() + inertia * before.abs() / H);
            assert!((impulse - wanted).abs() < 1e-7 * size, "joint {i} at {q}: {impulse}, not {wanted}");
            pushing += usize::from(wanted > 0.0);
            idle += usize::from(depth > 0.0 && wanted == 0.0);
        }
    }
    println!("{pushing} stops push, {idle} are left");
    assert!(pushing > 150 && idle > 20, "{pushing} {idle}");
}

fn hinge(joint: impl FnOnce(Joint) -> Joint, options: &Options) -> World<f64> {
    let mut robot = Robot::new("hinge");
    let ball = MassProperties::sphere(2.0, 0.05).placed(&Pose::at([0.3, 0.0, 0.0]));
    let axis = Joint::revolute("hinge", [0.0, -1.0, 0.0], Pose::identity(), ENDLESS);
    robot.add_segment(Segment::new("arm", None, joint(axis), ball));
    World::new(Model::new(&robot, options).unwrap())
}

/// Inertia and weight's moment of [`hinge`].
const INERTIA: f64 = 2.0 * 0.09 + 0.4 * 2.0 * 0.05 * 0.05;
const MOMENT: f64 = 2.0 * 9.81 * 0.3;

#[test]
fn a_spring_swings_at_its_frequency_and_holds_a_weight() {
    let free = Options { time_step: 1e-4, substeps: 1, gravity: [0.0; 3], ..Options::default() };
    let mut world = hinge(|joint| joint.with_spring(50.0, 0.2), &free);
    let (h, square) = (1e-4, 50.0 / INERTIA);
    let total = |[kinetic, potential]: [f64; 2]| kinetic + potential;
    let before = total(world.energy());
    assert!((before - 1.0).abs() < 1e-12, "{before}");
    for step in 1..=20_000 {
        world.step();
        // An implicit spring takes energy away as if its swing were damped by h w^2 / 2.
        let time = h * f64::from(step);
        let size = 0.2 * exp(-0.5 * h * square * time);
        let wanted = 0.2 - size * sin_cos(square.sqrt() * time).1;
        assert!((world.positions()[0] - wanted).abs() < 3e-4, "step {step}: {:?}", world.positions());
        let energy = 0.5 * 50.0 * size * size;
        assert!((total(world.energy()) - energy).abs() < 2e-3 * energy, "step {step}: {:?}", world.energy());
    }

    let mut world = hinge(|joint| joint.with_spring(40.0, 0.5).with_damping(4.0), &Options::default());
    for _ in 0..1000 {
        world.step();
    }
    let q = world.positions()[0];
    assert!((40.0 * (0.5 - q) - MOMENT * sin_cos(q).1).abs() < 1e-9, "{q}");
}

#[test]
fn dry_friction_stops_a_slider_where_coulomb_says() {
    let mut robot = Robot::new("slider");
    let rail = Joint::prismatic("rail", [1.0, 0.0, 0.0], Pose::identity(), ENDLESS).with_friction(3.0);
    robot.add_segment(Segment::new("cart", None, rail, MassProperties::sphere(2.0, 0.1)));
    let mut world = World::new(Model::<f64>::new(&robot, &Options::default()).unwrap());
    world.place_joint(JointId(0), 0.0, 1.5);
    world.finish_placement();
    // 1.5 m/s are lost at 1.5 m/s2, over 0.75 m. A step is 2.5 ms, at whose end the speed counts.
    for tick in 1..=150 {
        world.step();
        let speed = (1.5 - 0.015 * f64::from(tick)).max(0.0);
        assert!((world.velocities()[0] - speed).abs() < 1e-12, "tick {tick}: {:?}", world.velocities());
    }
    assert!((world.positions()[0] - 0.75).abs() < 2e-3, "{:?}", world.positions());
}

#[test]
fn dry_friction_holds_what_is_lighter_than_its_limit() {
    let mut held = hinge(|joint| joint.with_friction(1.01 * MOMENT), &Options::default());
    for _ in 0..1000 {
        held.step();
    }
    assert!(held.positions()[0].abs() < 1e-12, "{:?}", held.positions());
    let mut falling = hinge(|joint| joint.with_friction(0.9 * MOMENT), &Options::default());
    falling.step();
    let wanted = -0.1 * MOMENT / INERTIA * 0.01;
    assert!((falling.velocities()[0] / wanted - 1.0).abs() < 1e-3, "{:?}", falling.velocities());
}

/// Two bodies in free space on one hinge: friction ends their relative motion and changes no momentum.
#[test]
fn friction_between_free_bodies_keeps_their_momentum() {
    let mut robot = Robot::new("pair");
    let ball = |at: f64| MassProperties::sphere(1.0, 0.1).placed(&Pose::at([at, 0.0, 0.0]));
    let base = robot.add_segment(Segment::new("base", None, Joint::floating(Pose::identity()), ball(-0.2)));
    let joint = Joint::revolute("joint", [0.0, 0.0, 1.0], Pose::identity(), ENDLESS).with_friction(0.2);
    let tip = robot.add_segment(Segment::new("tip", Some(base), joint, ball(0.2)));
    // Momentum has an error of the first order in the step, with or without friction.
    let options = Options { gravity: [0.0; 3], time_step: 1e-4, substeps: 1, ..Options::default() };
    let mut world = World::new(Model::<f64>::new(&robot, &options).unwrap());
    world.place_joint(JointId(tip.0), 0.4, 3.0);
    world.finish_placement();
    let (before, mut last) = (world.momentum(), 3.0_f64);
    for _ in 0..10_000 {
        world.step();
        let now = world.velocities()[6];
        assert!(now <= last.max(1e-9) && now > -1e-9, "{now} after {last}");
        last = now;
    }
    assert!(last.abs() < 1e-9, "{last}");
    for (a, b) in world.momentum().iter().zip(before) {
        assert!((a - b).abs() < 3e-4, "{a} instead of {b}");
    }
}
