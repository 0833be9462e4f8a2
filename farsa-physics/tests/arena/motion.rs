//! Motion of a planar robot by its wheels.

use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, JointId, Joints, Kinematics, PairId, Sight, Snapshot, World as _,
};
use farsa_body::robots::MobileRobot;
use farsa_body::{Pose, Twist};
use farsa_num::{Domain, Stream};
use farsa_physics::arena::{Arena, CollisionRule, Cylinder, Wall, World};
use proptest::prelude::*;

fn plane(robot: MobileRobot, at: [f64; 2], heading: f64) -> World {
    let mut arena = Arena::new();
    arena.add_robot(robot, at, heading);
    World::new(&arena).unwrap()
}

fn drive(world: &mut World, speeds: [f32; 2]) {
    for (motor, speed) in world.parts(0).motors.into_iter().zip(speeds) {
        world.command(motor, [speed, 0.0]);
    }
}

/// Position and heading.
fn state(world: &World, robot: u16) -> [f32; 3] {
    let pose = world.pose(BodyId(robot));
    [pose.position[0], pose.position[1], pose.heading()]
}

fn angle(x: f64) -> f64 {
    farsa_num::atan2(farsa_num::sin_cos(x).0, farsa_num::sin_cos(x).1)
}

#[test]
fn equal_wheels_go_straight() {
    let mut world = plane(MobileRobot::khepera(), [0.0, 0.0], 0.5);
    drive(&mut world, [3.0, 3.0]);
    for _ in 0..1000 {
        world.step();
    }
    let [x, y, heading] = state(&world, 0);
    let way = 1000.0 * 0.05 * 3.0 * 0.015;
    let (sine, cosine) = farsa_num::sin_cos(0.5);
    assert!((f64::from(x) - way * cosine).abs() < 1e-4 && (f64::from(y) - way * sine).abs() < 1e-4, "{x} {y}");
    assert!((heading - 0.5).abs() < 1e-6);
    let mut opposite = plane(MobileRobot::khepera(), [0.25, -0.5], 0.5);
    drive(&mut opposite, [-2.0, 2.0]);
    opposite.step();
    assert_eq!(state(&opposite, 0)[..2], [0.25, -0.5]);
}

proptest! {
    #[test]
    fn a_step_is_the_arc_that_fine_steps_come_to(
        left in -20.0_f64..20.0, right in -20.0_f64..20.0, nearly in any::<bool>(), heading in -3.0_f64..3.0,
    ) {
        // Nearly straight, where a formula that divides by the turn loses its digits.
        let right = if nearly { left + right * 1e-6 } else { right };
        let robot = MobileRobot { max_wheel_speed: 20.0, ..MobileRobot::khepera() };
        let (wheel, track) = (robot.wheel_radius, robot.track);
        let mut world = plane(robot, [0.1, 0.2], heading);
        drive(&mut world, [left as f32, right as f32]);
        world.step();
        let (left, right) = (f64::from(left as f32), f64::from(right as f32));
        let steps = 20_000;
        let dt = 0.05 / f64::from(steps);
        let (mut x, mut y, mut turn) = (0.1, 0.2, heading);
        for _ in 0..steps {
            let (sine, cosine) = farsa_num::sin_cos(turn + 0.5 * dt * (right - left) * wheel / track);
            x += dt * 0.5 * (left + right) * wheel * cosine;
            y += dt * 0.5 * (left + right) * wheel * sine;
            turn += dt * (right - left) * wheel / track;
        }
        let [a, b, c] = state(&world, 0).map(f64::from);
        prop_assert!((a - x).abs() < 1e-7 && (b - y).abs() < 1e-7 && angle(c - turn).abs() < 1e-6, "{a} {b} {c}: {x} {y} {turn}");
        let end = world.velocity(BodyId(0));
        let speed = 0.5 * (left + right) * wheel;
        prop_assert!((f64::from(end.linear[0]) - speed * farsa_num::sin_cos(turn).1).abs() < 1e-6);
        prop_assert!((f64::from(end.angular[2]) - (right - left) * wheel / track).abs() < 1e-5);
    }
}

#[test]
fn a_mirrored_arena_gives_the_mirrored_life() {
    // About the x axis: exact in floating-point numbers, so the episodes are mirrored bit for bit.
    let mut touches = [0; 2];
    for episode in 0..40 {
        for (rule, touches) in [CollisionRule::Revert, CollisionRule::Circles].into_iter().zip(&mut touches) {
            let make = |sign: f64| {
                let mut stream = Stream::new(3, Domain::Start, episode, 0, 0);
                let mut arena = Arena { collisions: rule, ..Arena::new() };
                for i in 0..3 {
                    let at = [0.1 * f64::from(i) + stream.range_f64(0.0, 0.02), sign * stream.range_f64(0.0, 0.02)];
                    arena.add_robot(MobileRobot::khepera(), at, sign * stream.range_f64(-3.0, 3.0));
                }
                arena.add_cylinder(Cylinder::new([0.1, sign * 0.12], 0.02));
                arena.add_wall(Wall::cuboid([0.15, sign * -0.1], [0.3, 0.02], sign * 0.2));
                World::new(&arena).unwrap()
            };
            let [mut plain, mut mirrored] = [1.0, -1.0].map(make);
            let mut stream = Stream::new(3, Domain::Motor, episode, 0, 0);
            for t in 0..200 {
                for robot in 0..3 {
                    if t % 9 == 0 {
                        let [left, right] = [stream.range(-3.0, 6.0), stream.range(-3.0, 6.0)];
                        let [l, r] = plain.parts(robot).motors;
                        plain.command(l, [left, 0.0]);
                        plain.command(r, [right, 0.0]);
                        mirrored.command(l, [right, 0.0]);
                        mirrored.command(r, [left, 0.0]);
                    }
                }
                plain.step();
                mirrored.step();
                for robot in 0..3 {
                    let [x, y, heading] = state(&plain, robot);
                    assert_eq!([x, -y, -heading], state(&mirrored, robot), "episode {episode}, step {t}, {rule:?}");
                    *touches += usize::from(plain.touches(PairId(robot)));
                    assert_eq!(plain.touches(PairId(robot)), mirrored.touches(PairId(robot)));
                }
            }
        }
    }
    assert!(touches.iter().all(|touches| *touches > 1000), "{touches:?}");
}

#[test]
fn wheels_turn_as_told_within_their_limits() {
    let robot = MobileRobot::khepera();
    let most = robot.max_wheel_speed as f32;
    let mut world = plane(robot, [0.0; 2], 0.0);
    drive(&mut world, [100.0, f32::NEG_INFINITY]);
    world.step();
    assert_eq!([world.speed(JointId(0)), world.speed(JointId(1))], [most, -most]);
    drive(&mut world, [f32::NAN, 1.0]);
    world.step();
    assert_eq!([world.speed(JointId(0)), world.speed(JointId(1))], [0.0, 1.0]);
    assert!((world.position(JointId(0)) - 0.05 * most).abs() < 1e-6);
    // Commands hold. A long way on, positions are still exact to a fraction of a degree.
    for _ in 0..100_000 {
        world.step();
    }
    let turned = angle(f64::from(world.position(JointId(1))) - (100_001.0 * 0.05 - 0.05 * f64::from(most)));
    assert!(world.position(JointId(1)).abs() < 101.0 && turned.abs() < 0.1, "{turned}");
    assert!(state(&world, 0).iter().all(|x| x.is_finite()));
}

#[test]
fn leds_and_signals_are_in_the_snapshot_and_act_from_the_next_step() {
    let mut world = plane(MobileRobot::e_puck(), [0.0; 2], 0.0);
    let parts = world.parts(0);
    let seen = |world: &World| {
        let mut all = Vec::new();
        world.query_near([0.1, 0.0], 0.2, &mut |near| all.push((near.color, near.signal)));
        all
    };
    let hull = MobileRobot::e_puck().color.map(|x| x as f32);
    assert_eq!(seen(&world), [(hull, Some(0.0))]);
    let [red, green, blue] = parts.leds.unwrap();
    for (actuator, value) in [(red, 0.5), (green, f32::NAN), (blue, 7.0), (parts.signal.unwrap(), 0.25)] {
        world.command(actuator, [value, 0.0]);
    }
    assert_eq!(seen(&world), [(hull, Some(0.0))]);
    world.step();
    assert_eq!(seen(&world), [([0.5, 0.0, 1.0], Some(0.25))]);
    let mut words = vec![0.0; world.snapshot_len()];
    world.save(&mut words);
    let mut other = plane(MobileRobot::e_puck(), [0.0; 2], 0.0);
    other.restore(&words);
    assert_eq!(seen(&other), seen(&world));
    world.clear();
    assert_eq!(seen(&world), [(hull, Some(0.0))]);
}

#[test]
fn what_does_not_exist_is_zero_and_ignored() {
    let mut world = plane(MobileRobot::khepera(), [0.0; 2], 0.0);
    let before = world.clone();
    world.command(ActuatorId(2), [1.0, 0.0]);
    world.place_joint(JointId(2), 1.0, 1.0);
    world.place_body(BodyId(1), Pose::planar([1.0, 1.0], 0.0), Twist::default());
    assert_eq!(format!("{world:?}"), format!("{before:?}"));
    assert_eq!((world.position(JointId(2)), world.speed(JointId(7))), (0.0, 0.0));
    assert_eq!((world.pose(BodyId(1)), world.velocity(BodyId(1))), (Pose::identity(), Twist::default()));
}
