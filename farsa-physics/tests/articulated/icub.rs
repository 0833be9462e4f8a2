//! The iCub in an articulated world: random targets under both controls, at rest, in parts.

use crate::common::{model, stream};
use farsa_body::Pose;
use farsa_body::actuators::Law;
use farsa_body::ports::{Actuated, ActuatorId, Arrange, Contacts, Joints, PairId, World as _};
use farsa_body::robot::Robot;
use farsa_body::robots::{Chain, Icub, JointControl, Side};
use farsa_body::sensors::Camera;
use farsa_num::Stream;
use farsa_physics::articulated::{Options, Precision, World};

fn at_start<R: Precision>(icub: &Icub, robot: &Robot) -> World<R> {
    let mut world = World::new(model::<R>(robot, Options::default()));
    for (joint, angle) in robot.joints().zip(icub.start()) {
        world.place_joint(joint, angle as f32, 0.0);
    }
    world.finish_placement();
    world
}

/// The extremes over a while of random commands.
#[derive(Debug, Default)]
struct Worst {
    /// The speeds of torso, neck and arms, and of hands [rad/s].
    speed: [f32; 2],
    /// The joints that were so fast, and when.
    fastest: [String; 2],
    /// Beyond a joint's limits [rad].
    beyond: f64,
    /// The depth of a pair's colliders [m].
    depth: f32,
    pair: String,
    touched: usize,
}

/// Steps for 2 s. New commands within the joints' limits every 0.5 s.
fn driven<R: Precision>(icub: &Icub, robot: &Robot, stream: &mut Stream) -> Worst {
    let mut world = at_start::<R>(icub, robot);
    let mut worst = Worst::default();
    for step in 0..200 {
        if step % 50 == 0 {
            for (i, actuator) in robot.actuators.iter().enumerate() {
                let [low, high] = robot.segments[actuator.joint.index()].joint.range;
                let command = match actuator.law {
                    Law::Velocity(_) => stream.range_f64(-2.0, 2.0),
                    _ => stream.range_f64(low, high),
                };
                world.command(ActuatorId(i as u16), [command as f32, 0.0]);
            }
        }
        world.step();
        assert!(world.is_finite(), "step {step}");
        for joint in robot.joints() {
            let (q, speed) = (f64::from(world.position(joint)), world.speed(joint).abs());
            let [low, high] = robot.segments[joint.index()].joint.range;
            let hand = usize::from(joint.index() >= Chain::LeftHand.bodies().start);
            if speed > worst.speed[hand] {
                worst.speed[hand] = speed;
                worst.fastest[hand] = format!("{} step {step}", robot.segments[joint.index()].joint.name);
            }
            worst.beyond = worst.beyond.max(low - q).max(q - high);
        }
        for p in 0..robot.pairs.len() {
            let contact = world.pair_contact(PairId(p as u16));
            worst.touched += usize::from(contact.points > 0);
            if contact.points > 0 && contact.depth > worst.depth {
                worst.depth = contact.depth;
                worst.pair = robot.pairs[p].colliders.map(|i| robot.colliders[i].name.as_str()).join(", ");
            }
        }
    }
    worst
}

#[test]
fn random_targets_are_followed_within_bounds() {
    for control in [JointControl::Position, JointControl::Velocity] {
        let icub = Icub { control, ..Icub::default() };
        let robot = icub.robot().unwrap();
        let (mut all, mut touched) = (Worst::default(), 0);
        for k in 0..20 {
            let worst = driven::<f32>(&icub, &robot, &mut stream(7, k));
            println!("{control:?} {k}: {worst:?}");
            touched += worst.touched;
            all.speed = [0, 1].map(|i| all.speed[i].max(worst.speed[i]));
            all.beyond = all.beyond.max(worst.beyond);
            all.depth = all.depth.max(worst.depth);
        }
        println!("{control:?}: {all:?}, touched {touched}");
        assert!(touched > 1000, "limbs meet: {touched}");
        // A wrist reaches 15 rad/s and a finger 38 where an arm hits the other hand's fingers.
        assert!(all.speed[0] < 20.0 && all.speed[1] < 50.0, "{all:?}");
        assert!(all.depth < 0.005, "{all:?}");
        assert!(all.beyond < 0.01, "{all:?}");
    }
}

/// Held at its posture it sags by little, and nothing touches.
#[test]
fn the_posture_is_held() {
    let icub = Icub::default();
    let robot = icub.robot().unwrap();
    let mut world = at_start::<f32>(&icub, &robot);
    let start = icub.start();
    for (i, angle) in start.iter().enumerate() {
        world.command(ActuatorId(i as u16), [*angle as f32, 0.0]);
    }
    for _ in 0..300 {
        world.step();
        assert!((0..robot.pairs.len()).all(|p| world.pair_contact(PairId(p as u16)).points == 0));
    }
    let sag = robot.joints().zip(&start).map(|(joint, angle)| (f64::from(world.position(joint)) - angle).abs());
    let sag = sag.fold(0.0, f64::max);
    let speed = robot.joints().map(|joint| world.speed(joint).abs()).fold(0.0, f32::max);
    println!("sag {:.2} deg, speed {speed} rad/s", sag.to_degrees());
    assert!(sag < 3.0_f64.to_radians() && speed < 1e-3, "{sag} rad, {speed} rad/s");
}

/// Every set of chains steps in a world. Joints of rigid chains do not exist there.
#[test]
fn every_set_of_chains_steps() {
    for bits in 0..64 {
        let actuated = Chain::ALL.into_iter().filter(|chain| bits >> *chain as usize & 1 == 1).collect();
        let icub = Icub { actuated, ..Icub::default() };
        let robot = icub.robot().unwrap();
        let mut world = at_start::<f32>(&icub, &robot);
        let heights = |world: &World<f32>| Side::ALL.map(|side| world.pose_of(Icub::palm(side)).position[2]);
        let before = heights(&world);
        for (i, angle) in icub.start().iter().enumerate() {
            world.command(ActuatorId(i as u16), [*angle as f32, 0.0]);
        }
        for _ in 0..20 {
            world.step();
        }
        assert!(world.is_finite(), "{:?}", icub.actuated);
        for (a, b) in before.into_iter().zip(heights(&world)) {
            assert!((a - b).abs() < 0.01, "{:?}: palm from {a} m to {b} m", icub.actuated);
        }
    }
}

#[test]
fn what_is_drawn_changes_no_bit() {
    let icub = Icub::default();
    let mut robot = icub.robot().unwrap();
    robot.colliders.iter_mut().for_each(|collider| collider.color = Some([0.5, 0.4, 0.3]));
    let bare = Robot { visuals: Vec::new(), ..robot.clone() };
    assert!(robot.visuals.len() > 50);
    let seen = [&robot, &bare].map(|robot| {
        let mut stream = stream(7, 0);
        let mut world = at_start::<f32>(&icub, robot);
        let mut bits = Vec::new();
        for step in 0..100 {
            if step % 25 == 0 {
                for (i, actuator) in robot.actuators.iter().enumerate() {
                    let [low, high] = robot.segments[actuator.joint.index()].joint.range;
                    world.command(ActuatorId(i as u16), [stream.range_f64(low, high) as f32, 0.0]);
                }
            }
            world.step();
            bits.extend(robot.joints().flat_map(|joint| [world.position(joint), world.speed(joint)].map(f32::to_bits)));
        }
        // From before the robot, towards it.
        let placement = Pose { position: [0.5, 0.0, 0.1], rotation: [0.0, 0.0, 1.0, 0.0] };
        let mut camera = Camera::new(Icub::CHEST, placement, [32, 24], 1.2, 3.0).unwrap();
        let image: Vec<_> = camera.look(&world).to_vec();
        (bits, image)
    });
    assert!(seen[0] == seen[1]);
    assert!(seen[0].1.iter().flatten().count() > 20, "the camera sees the robot");
}
