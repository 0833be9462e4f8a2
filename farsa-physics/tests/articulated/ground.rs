//! Bodies that slide on the ground: closed forms, a naive integrator, and what must not happen.

use crate::sliding::{FRICTION, GRAVITY, MASS, arm};
use farsa_body::Pose;
use farsa_body::actuators::{Law, Torque};
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, ExternalForces as _, JointId, Joints, Kinematics as _, World as _,
};
use farsa_body::robot::{Ground, JointKind, MassProperties, Robot};
use farsa_num::{Domain, Stream, sin_cos};
use farsa_physics::articulated::{Model, Options, Precision, World};

/// A disc on the ground that two motors push, one along each axis, and one turns.
fn puck(radius: f64) -> Robot {
    let mut robot = Robot::new("puck");
    let properties = MassProperties::cylinder(MASS, 0.06, 0.05);
    let body = robot.add_sliding_body("puck", Pose::at([0.2, 0.1, 0.05]), properties, radius > 0.0);
    robot.add_ground(Ground { body, friction: FRICTION, load: MASS * GRAVITY, radius });
    for joint in robot.joints().collect::<Vec<_>>() {
        robot.add_actuator(&format!("push {}", joint.0), joint, Law::Torque(Torque { limit: 100.0 }));
    }
    robot
}

fn world<R: Precision>(robot: &Robot, h: f64) -> World<R> {
    World::new(Model::new(robot, &Options { time_step: h, substeps: 1, ..Options::default() }).unwrap())
}

#[test]
fn a_puck_slides_as_far_as_coulomb_lets_it_and_then_rests() {
    for direction in 0..16 {
        let (sine, cosine) = sin_cos(f64::from(direction) * core::f64::consts::FRAC_PI_8);
        let (h, speed) = (0.001, 1.2);
        let mut world = world::<f64>(&puck(0.0), h);
        world.place_joint(JointId(0), 0.0, (speed * cosine) as f32);
        world.place_joint(JointId(1), 0.0, (speed * sine) as f32);
        world.finish_placement();
        let deceleration = FRICTION * GRAVITY;
        let (time, way) = (speed / deceleration, speed * speed / (2.0 * deceleration));
        let mut steps = 0;
        while world.speed(JointId(0)) != 0.0 || world.speed(JointId(1)) != 0.0 {
            world.step();
            steps += 1;
            assert!(steps < 1000);
        }
        // Semi-implicit: a step late at most, and half a step's way short.
        assert!((f64::from(steps) * h - time).abs() <= h, "{steps} steps where {time} s are due");
        let place = [0, 1].map(|joint| f64::from(world.position(JointId(joint))));
        let gone = (place[0] * place[0] + place[1] * place[1]).sqrt();
        assert!((gone - way).abs() < speed * h, "{gone} m where {way} are due");
        assert!((place[0] * sine - place[1] * cosine).abs() < 1e-6, "straight ahead: {place:?}");
        let still = world.state().to_vec();
        (0..100).for_each(|_| world.step());
        assert_eq!(world.state(), still, "a puck at rest stays there, to the bit");
    }
}

#[test]
fn a_puck_that_turns_comes_to_rest_by_its_radius() {
    let (h, spin, radius) = (0.0005, 9.0, 0.04);
    let robot = puck(radius);
    let mut world = world::<f64>(&robot, h);
    world.place_joint(JointId(2), 0.0, spin as f32);
    world.finish_placement();
    let inertia = MassProperties::cylinder(MASS, 0.06, 0.05).inertia[2];
    let time = spin * inertia / (FRICTION * MASS * GRAVITY * radius);
    let mut steps = 0;
    while world.speed(JointId(2)) != 0.0 {
        world.step();
        steps += 1;
        assert!(steps < 10_000);
    }
    assert!((f64::from(steps) * h - time).abs() < 2e-3 * time + h, "{steps} steps where {time} s are due");
    assert_eq!([0, 1].map(|joint| world.position(JointId(joint))), [0.0; 2]);
}

/// A push below the limit moves nothing, one beyond it accelerates by what is left over: of the puck's motors, and of a hand.
#[test]
fn a_push_moves_what_it_overcomes() {
    let limit = FRICTION * MASS * GRAVITY;
    let robot = puck(0.04);
    let body = BodyId(robot.segments.len() as u16 - 1);
    for (part, moves) in [(0.8, false), (0.999, false), (1.001, true), (1.5, true), (3.0, true)] {
        for (direction, by_hand) in [0.0, 0.5, 0.79, 2.0, 4.0].into_iter().flat_map(|x| [(x, false), (x, true)]) {
            let (sine, cosine) = sin_cos(direction);
            let mut world = world::<f32>(&robot, 0.01);
            let push = part * limit;
            let force = [cosine, sine].map(|way| (push * way) as f32);
            for _ in 0..500 {
                if by_hand {
                    world.apply_force(body, world.origin(body), [force[0], force[1], 0.0]);
                } else {
                    (0..2).for_each(|motor| world.command(ActuatorId(motor), [force[usize::from(motor)], 0.0]));
                }
                world.step();
            }
            let speeds = [0, 1].map(|joint| f64::from(world.speed(JointId(joint))));
            let speed = speeds[0] * cosine + speeds[1] * sine;
            if moves {
                let expected = 5.0 * (push - limit) / MASS;
                assert!((speed - expected).abs() < 1e-3 * expected + 2e-3, "{speed} m/s where {expected} are due");
            } else {
                assert_eq!([0, 1].map(|joint| world.position(JointId(joint))), [0.0; 2], "{part} of the limit");
            }
        }
    }
}

/// Random pushes, compared with an integrator of tiny steps by Newton's and Coulomb's laws alone.
#[test]
fn random_pushes_move_it_as_newton_and_coulomb_say() {
    let limit = FRICTION * MASS * GRAVITY;
    let mut stream = Stream::new(3, Domain::General, 0, 0, 0);
    for _ in 0..10 {
        let h = 0.0005;
        let mut world = world::<f64>(&puck(0.0), h);
        let (mut place, mut velocity) = ([0.0_f64; 2], [0.0_f64; 2]);
        for _ in 0..20 {
            let push = [0, 1].map(|_| stream.range_f64(-2.5, 2.5) as f32);
            for (motor, push) in push.into_iter().enumerate() {
                world.command(ActuatorId(motor as u16), [push, 0.0]);
            }
            (0..100).for_each(|_| world.step());
            let tiny = h / 20.0;
            for _ in 0..2000 {
                let free = [0, 1].map(|k| velocity[k] + tiny * f64::from(push[k]) / MASS);
                let size = (free[0] * free[0] + free[1] * free[1]).sqrt();
                let brake = tiny * limit / MASS;
                velocity = free.map(|v| if size <= brake { 0.0 } else { v * (1.0 - brake / size) });
                for k in 0..2 {
                    place[k] += tiny * velocity[k];
                }
            }
        }
        for k in 0..2 {
            let found = f64::from(world.position(JointId(k as u16)));
            assert!((found - place[k]).abs() < 2e-3, "{found} m where {} are due", place[k]);
        }
    }
}

/// A puck whose center of mass is off its axis of rotation: a force that brakes its sliding turns it, and the reverse.
#[test]
fn a_lopsided_puck_moves_as_newton_euler_and_coulomb_say() {
    let (limit, radius, beside) = (FRICTION * MASS * GRAVITY, 0.04, [0.03, -0.015]);
    let mut robot = puck(radius);
    let disc = MassProperties::cylinder(MASS, 0.06, 0.05);
    robot.segments.last_mut().unwrap().centre = [beside[0], beside[1], 0.0];
    let (inertia, limit_of_turning) = (disc.inertia[2], limit * radius);
    let mut stream = Stream::new(5, Domain::General, 0, 0, 0);
    let (mut gone, mut turned) = (0.0_f64, 0.0_f64);
    for _ in 0..10 {
        let h = 0.0005;
        let mut world = world::<f64>(&robot, h);
        let (mut place, mut velocity) = ([0.0_f64; 3], [0.0_f64; 3]);
        for _ in 0..10 {
            let push = [6.0, 6.0, 0.3].map(|most| f64::from(stream.range_f64(-most, most) as f32));
            for (motor, push) in push.into_iter().enumerate() {
                world.command(ActuatorId(motor as u16), [push as f32, 0.0]);
            }
            (0..100).for_each(|_| world.step());
            let tiny = h / 20.0;
            for _ in 0..2000 {
                let (sine, cosine) = sin_cos(place[2]);
                let [x, y] = [cosine * beside[0] - sine * beside[1], sine * beside[0] + cosine * beside[1]];
                let [vx, vy, turning] = velocity;
                // Coulomb's law without its corner at rest.
                let brake = limit / (vx * vx + vy * vy + 1e-6).sqrt();
                let brake_of_turning = limit_of_turning / (turning * turning + 1e-4).sqrt();
                let force = [
                    push[0] - brake * vx + MASS * turning * turning * x,
                    push[1] - brake * vy + MASS * turning * turning * y,
                    push[2] - brake_of_turning * turning,
                ];
                // m (a + alpha k x s) = f and (I + m s^2) alpha + m s x a = t, solved for alpha first.
                let acceleration = (force[2] - x * force[1] + y * force[0]) / inertia;
                let change = [force[0] / MASS + y * acceleration, force[1] / MASS - x * acceleration, acceleration];
                for k in 0..3 {
                    velocity[k] += tiny * change[k];
                    place[k] += tiny * velocity[k];
                }
            }
        }
        let found = [0, 1, 2].map(|joint| f64::from(world.position(JointId(joint))));
        for (k, room) in [5e-3, 5e-3, 5e-2].into_iter().enumerate() {
            assert!((found[k] - place[k]).abs() < room, "{found:?} where {place:?} are due");
        }
        gone = gone.max(found[0].abs()).max(found[1].abs());
        turned = turned.max(found[2].abs());
    }
    assert!(gone > 0.3 && turned > 3.0, "{gone} m and {turned} rad at most");
}

/// Returns the puck where the ground holds it: it turns about the point that does not slide, and the ground bears what
/// that takes.
#[test]
fn a_lopsided_puck_that_is_held_turns_about_the_held_point() {
    let (limit, radius, beside) = (FRICTION * MASS * GRAVITY, 0.04, [0.03, -0.015]);
    let mut robot = puck(radius);
    robot.segments.last_mut().unwrap().centre = [beside[0], beside[1], 0.0];
    let about =
        MassProperties::cylinder(MASS, 0.06, 0.05).inertia[2] + MASS * (beside[0] * beside[0] + beside[1] * beside[1]);
    for direction in [0.3, 1.9, 4.4] {
        let (sine, cosine) = sin_cos(direction);
        let (h, steps, more) = (0.001, 400, 0.01);
        let mut world = world::<f64>(&robot, h);
        for (motor, push) in [0.5 * limit * cosine, 0.5 * limit * sine, limit * radius + more].into_iter().enumerate() {
            world.command(ActuatorId(motor as u16), [push as f32, 0.0]);
        }
        (0..steps).for_each(|_| world.step());
        let time = f64::from(steps) * h;
        let expected = 0.5 * more / about * time * (time + h);
        let turned = f64::from(world.position(JointId(2)));
        assert!((turned - expected).abs() < 2e-3 * expected, "{turned} rad where {expected} are due");
        assert_eq!([0, 1].map(|joint| world.position(JointId(joint))), [0.0; 2]);
    }
}

/// At any command no ball passes through the arm or another ball, and none is launched.
#[test]
fn balls_never_pass_through_the_arm_or_each_other() {
    let steps = if std::env::var_os("FARSA_LONG").is_some() { 1_000_000 } else { 100_000 };
    for turns in [false, true] {
        let robot = arm(turns);
        let options = Options { time_step: 0.1, substeps: 5, ..Options::default() };
        let mut world = World::<f32>::new(Model::new(&robot, &options).unwrap());
        let mut stream = Stream::new(11, Domain::General, 0, 0, 0);
        let sliding = |joint: &JointId| robot.segments[joint.index()].joint.kind == JointKind::Prismatic;
        let slides: Vec<JointId> = robot.joints().filter(sliding).collect();
        let (mut deepest, mut fastest, mut touches) = (0.0_f32, 0.0_f32, 0_u32);
        for step in 0..steps / 2 {
            if step % 60 == 0 {
                world.clear();
                for joint in 0..2 {
                    world.place_joint(JointId(joint), 0.0, 0.0);
                }
                world.place_joint(JointId(0), stream.range(-1.3, 1.3), 0.0);
                world.place_joint(JointId(1), if stream.below(2) == 0 { 2.0 } else { -2.0 }, 0.0);
                world.finish_placement();
            }
            if step % 12 == 0 {
                for motor in 0..2 {
                    // Mostly as fast as can be, so that the arm gets somewhere.
                    let speed = stream.range(-4.0, 4.0).clamp(-1.0, 1.0);
                    world.command(ActuatorId(motor), [speed, 0.0]);
                }
            }
            world.step();
            for pair in 0..world.pairs() {
                let contact = world.pair_contact(farsa_body::ports::PairId(pair as u16));
                deepest = deepest.max(contact.depth);
                touches += u32::from(contact.points > 0);
            }
            let slide = slides.iter().map(|joint| world.speed(*joint).abs()).fold(0.0, f32::max);
            fastest = fastest.max(slide);
            assert!(slide.is_finite());
        }
        println!("turns {turns}: {deepest} m deep, {fastest} m/s, {touches} touches");
        assert!(touches > 1000);
        // Half a radius is far from through. Two segments in a vice press hardest.
        assert!(deepest < 0.02, "{deepest} m deep");
        assert!(fastest < 12.0, "{fastest} m/s");
    }
}

/// Balls that collide keep their momentum, and neither contacts nor the ground add energy.
#[test]
fn collisions_keep_momentum_and_nothing_adds_energy() {
    let mut stream = Stream::new(12, Domain::General, 0, 0, 0);
    let mut met = 0;
    for trial in 0..60 {
        let mut robot = arm(trial % 2 == 0);
        // Motors that exert nothing. Every third time there is no ground to rub on either.
        for actuator in &mut robot.actuators {
            actuator.law = Law::Torque(Torque { limit: 0.0 });
        }
        let rubs = trial % 3 != 0;
        if !rubs {
            robot.grounds.clear();
        }
        let options = Options { time_step: 0.005, substeps: 1, gravity: [0.0; 3], ..Options::default() };
        let mut world = World::<f64>::new(Model::new(&robot, &options).unwrap());
        let slides: Vec<JointId> =
            robot.joints().filter(|joint| robot.segments[joint.index()].joint.kind == JointKind::Prismatic).collect();
        // The arm lies away. The first ball is shot at the second.
        world.place_joint(JointId(0), 2.9, 0.0);
        world.place_joint(slides[0], 0.5, stream.range(0.8, 1.2));
        world.place_joint(slides[1], -1.03 + stream.range(-0.03, 0.03), stream.range(-1.0, -0.7));
        world.finish_placement();
        let momentum = |world: &World<f64>| {
            [0, 1]
                .map(|axis| slides.iter().skip(axis).step_by(2).map(|j| MASS * f64::from(world.speed(*j))).sum::<f64>())
        };
        let before = momentum(&world);
        let first = world.energy()[0];
        let (mut energy, mut touching, mut touched) = (first, false, false);
        for _ in 0..400 {
            world.step();
            let now = world.energy()[0];
            let still = (0..world.pairs()).any(|p| world.pair_contact(farsa_body::ports::PairId(p as u16)).points > 0);
            // A contact stores some and gives it back. No quantity increases.
            let most = if touching || still { first } else { energy };
            assert!(now <= most * (1.0 + 1e-9), "trial {trial}: {now} J after {most} J");
            (energy, touching, touched) = (now, still, touched || still);
            if !rubs {
                let now = momentum(&world);
                assert!((0..2).all(|k| (now[k] - before[k]).abs() < 1e-7), "trial {trial}: {now:?}, {before:?}");
            }
        }
        met += u32::from(touched);
    }
    assert!(met > 20, "{met} collisions");
}

#[test]
fn ground_belongs_below_what_slides() {
    let mut robot = puck(0.0);
    robot.add_ground(Ground { body: BodyId(0), friction: 0.1, load: 1.0, radius: 0.0 });
    assert!(robot.validate().unwrap_err().to_string().contains("no body that slides in a plane"));
    for (friction, load, radius) in [(-1.0, 1.0, 0.0), (1.0, f64::NAN, 0.0), (1.0, 1.0, f64::INFINITY)] {
        let mut robot = puck(0.0);
        robot.grounds[0] = Ground { body: BodyId(1), friction, load, radius };
        assert!(robot.validate().is_err());
    }
    let mut both = puck(0.0);
    both.add_ground(Ground { body: BodyId(1), friction: 0.1, load: 1.0, radius: 0.0 });
    assert!(both.validate().is_err());
    let mut pair = puck(0.04).prefixed("left ");
    let offsets = pair.merge(&puck(0.04).prefixed("right "));
    assert_eq!(pair.grounds[1].body, offsets.body(BodyId(2)));
    assert_eq!(pair.validate(), Ok(()));
    assert_eq!(pair.sliders(BodyId(2)), Some(([JointId(0), JointId(1)], Some(JointId(2)))));
}
