//! Free bodies whose origin is away from their center of mass, against closed forms, and their inertia with joints.

use crate::common::world;
use farsa_body::ports::{Arrange, BodyId, Kinematics as _, World as _};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, Surface};
use farsa_body::{Pose, Twist};
use farsa_num::sin_cos;
use farsa_physics::articulated::{
    Model, ModelError, Options, Scratch, World, inverse_dynamics, kinetic_energy, mass_matrix,
};

const GRAVITY: f64 = 9.81;
/// The dynamics step [s].
const STEP: f64 = 1e-3;
/// Distance of the center of mass from the origin, along the body's x axis: 3/4 of the bar [m].
const CENTRE: f64 = 0.1875;
/// Where the origin starts, turned by a third of a turn, so that the body's axes x, y, z lie along y, z, x.
const START: Pose = Pose { position: [0.5, -0.25, 1.0], rotation: [0.5; 4] };

/// Two balls on a bar without mass. The origin is the center of the lighter one.
fn dumbbell() -> Robot {
    let mut robot = Robot::new("dumbbell");
    let start = Joint::floating(Pose::identity());
    let light = robot.add_segment(Segment::new("light", None, start, MassProperties::sphere(0.1, 0.02)));
    let bar = Joint::fixed(Pose::at([0.25, 0.0, 0.0]));
    robot.add_segment(Segment::new("heavy", Some(light), bar, MassProperties::sphere(0.3, 0.02)));
    robot
}

/// A vector of the body in the world, by its quaternion.
fn turned([x, y, z, w]: [f64; 4], [a, b, c]: [f64; 3]) -> [f64; 3] {
    let t = [2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)];
    [a + w * t[0] + y * t[2] - z * t[1], b + w * t[1] + z * t[0] - x * t[2], c + w * t[2] + x * t[1] - y * t[0]]
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt()
}

/// Throws the dumbbell by the velocity of its origin. After every step `look` receives the time, the origin, the center
/// of mass on its parabola, and the quaternion.
fn throw(twist: Twist, mut look: impl FnMut(f64, [f64; 3], [f64; 3], [f64; 4])) {
    let mut world = world(&dumbbell(), STEP, GRAVITY);
    world.place_body(BodyId(0), START, twist);
    world.finish_placement();
    let ([vx, vy, vz], [wx, _, wz]) = (twist.linear.map(f64::from), twist.angular.map(f64::from));
    // The center lies along the world's y axis at first: w x (0, c, 0) = (-wz c, 0, wx c).
    let velocity = [vx - wz * CENTRE, vy, vz + wx * CENTRE];
    let centre = [0.5, -0.25 + CENTRE, 1.0];
    for n in 1..=1000 {
        world.step();
        let t = f64::from(n) * STEP;
        // Semi-implicit Euler falls by g h^2 n (n + 1) / 2, which is g t^2 / 2 and half a step more.
        let fall = 0.5 * GRAVITY * t * (t + STEP);
        let expected = [centre[0] + velocity[0] * t, centre[1] + velocity[1] * t, centre[2] + velocity[2] * t - fall];
        let s = world.state();
        look(t, [s[0], s[1], s[2]], expected, [s[3], s[4], s[5], s[6]]);
    }
}

#[test]
fn the_centre_of_mass_of_a_tumbling_body_follows_the_parabola() {
    let mut worst = 0.0_f64;
    throw(Twist { linear: [0.5, -1.0, 3.0], angular: [6.0, 3.0, -8.0] }, |_, origin, expected, q| {
        let arm = turned(q, [CENTRE, 0.0, 0.0]);
        worst = worst.max(distance([origin[0] + arm[0], origin[1] + arm[1], origin[2] + arm[2]], expected));
    });
    println!("off the parabola by {worst:.1e} m");
    assert!(worst < 1e-12);
}

#[test]
fn the_origin_of_a_spinning_body_circles_its_centre_of_mass() {
    // About the world's x axis, a principal axis of the dumbbell: the spin stays, and the arm turns from y to z.
    let spin = 8.0;
    let mut worst = 0.0_f64;
    throw(Twist { linear: [0.5, -1.0, 3.0], angular: [spin as f32, 0.0, 0.0] }, |t, origin, expected, _| {
        let (sine, cosine) = sin_cos(spin * t);
        worst = worst.max(distance(origin, [expected[0], expected[1] - CENTRE * cosine, expected[2] - CENTRE * sine]));
    });
    println!("off the circle by {worst:.1e} m");
    // A step turns by 2 atan(h w / 2): 43 urad less than w t after a second, 8 um at this radius.
    assert!(worst < 1e-5);
}

/// The columns of the inertia of a free body with two joints are the efforts of unit accelerations, less those of none.
#[test]
fn the_inertia_of_a_free_body_with_joints_is_what_inverse_dynamics_says() {
    let mut robot = Robot::new("crane");
    let start = Joint::floating(Pose::identity());
    let mut trunk = Segment::new("trunk", None, start, MassProperties::sphere(0.4, 0.1));
    trunk.centre = [0.03, -0.02, 0.05];
    let trunk = robot.add_segment(trunk);
    let arm =
        Joint::revolute("elbow", [0.6, 0.0, 0.8], Pose { position: [0.1, 0.2, -0.1], rotation: [0.5; 4] }, [-2.0, 2.0]);
    let mut arm = Segment::new("arm", Some(trunk), arm, MassProperties::sphere(0.2, 0.05));
    arm.centre = [0.0, 0.15, 0.02];
    let arm = robot.add_segment(arm);
    let slide = Joint::prismatic("slide", [0.0, 0.8, 0.6], Pose::at([0.0, 0.3, 0.0]), [-1.0, 1.0]);
    robot.add_segment(Segment::new("hand", Some(arm), slide, MassProperties::sphere(0.1, 0.03)));
    let model = Model::<f64>::new(&robot, &Options::default()).unwrap();
    let n = model.dofs();
    assert_eq!(n, 8);
    let places = [0.4, -0.3, 1.1, 0.1, -0.7, 0.5, 0.5, 0.9, -0.2];
    let velocities = [0.3, -1.2, 0.8, 2.0, -0.4, 0.1, 3.0, -0.6];
    let mut scratch = Scratch::new((), &model);
    scratch.forward_kinematics((), &model, &[&places[..], &velocities].concat());
    let mut efforts = |accelerations: &[f64]| {
        let mut tau = vec![0.0; n];
        inverse_dynamics((), model.links(), model.gravity(), accelerations, scratch.links(), &mut tau);
        tau
    };
    let at_rest = efforts(&vec![0.0; n]);
    let column = |k: usize| {
        let unit: Vec<f64> = (0..n).map(|row| f64::from(u8::from(row == k))).collect();
        efforts(&unit).into_iter().zip(&at_rest).map(|(all, rest)| all - rest).collect::<Vec<_>>()
    };
    let columns: Vec<Vec<f64>> = (0..n).map(column).collect();
    let mut matrix = vec![0.0; n * n];
    mass_matrix((), model.links(), scratch.links(), &mut matrix);
    let mut energy = 0.0;
    for row in 0..n {
        for (k, column) in columns.iter().enumerate() {
            let found = matrix[row * n + k];
            assert!((found - column[row]).abs() < 1e-12, "{row}, {k}: {found} and {}", column[row]);
            energy += 0.5 * velocities[row] * found * velocities[k];
        }
    }
    let expected = kinetic_energy((), model.links(), &velocities, scratch.links());
    assert!((energy - expected).abs() < 1e-12, "{energy} and {expected} J");
}

/// Two free balls collide off the line between their centers, with friction: each gains the momentum that the other
/// loses.
#[test]
fn free_bodies_that_strike_each_other_keep_their_momentum() {
    let surface = Surface { friction: 0.5, rolling_friction: 0.0, stiffness: 1e5, damping: 20.0 };
    let balls = [(0.2, 0.03), (0.5, 0.04)];
    let mut robot = Robot::new("balls");
    for (name, (mass, radius)) in ["light", "heavy"].into_iter().zip(balls) {
        let start = Joint::floating(Pose::identity());
        let body = robot.add_segment(Segment::new(name, None, start, MassProperties::sphere(mass, radius)));
        robot.add_collider(Collider::new(name, Some(body), Shape::Sphere { radius }, Pose::identity()));
    }
    robot.add_pair([0, 1], surface);
    let mut world = world(&robot, 1e-4, 0.0);
    world.place_body(
        BodyId(0),
        Pose::at([-0.2, 0.02, 0.01]),
        Twist { linear: [2.0, 0.0, 0.0], angular: [9.0, 3.0, -5.0] },
    );
    world.place_body(
        BodyId(1),
        Pose::at([0.0, 0.0, 0.0]),
        Twist { linear: [-0.5, 0.1, 0.0], angular: [0.0, -4.0, 6.0] },
    );
    world.finish_placement();
    // Linear momentum, and angular momentum about the world's origin, of which each ball has the inertia 2/5 m r^2.
    let momenta = |world: &World<f64>| {
        let (mut linear, mut angular) = ([0.0; 3], [0.0; 3]);
        for (i, (mass, radius)) in balls.into_iter().enumerate() {
            let twist = world.velocity_of(BodyId(i as u16));
            let place = world.pose_of(BodyId(i as u16)).position;
            for k in 0..3 {
                let [a, b] = [(k + 1) % 3, (k + 2) % 3];
                linear[k] += mass * twist.linear[k];
                angular[k] += 0.4 * mass * radius * radius * twist.angular[k]
                    + mass * (place[a] * twist.linear[b] - place[b] * twist.linear[a]);
            }
        }
        (linear, angular)
    };
    let (before, energy, free) = (momenta(&world), world.energy()[0], world.velocity_of(BodyId(1)));
    (0..2000).for_each(|_| world.step());
    let (after, left, struck) = (momenta(&world), world.energy()[0], world.velocity_of(BodyId(1)));
    assert!(distance(before.0, after.0) < 1e-9, "{before:?} {after:?}");
    assert!(distance(before.1, after.1) < 2e-3 * distance(before.1, [0.0; 3]), "{before:?} {after:?}");
    assert!(left < energy && left > 0.2 * energy, "{left} J of {energy}");
    assert!(struck.linear[0] > 0.3 && distance(struck.angular, free.angular) > 1.0, "{struck:?}");
}

/// A floating body with these principal moments, turned by a quaternion in its own frame.
fn spinning(moments: [f64; 3], turn: [f64; 4]) -> Robot {
    let mut robot = Robot::new("spinning");
    let part =
        MassProperties { mass: 1.0, centre: [0.0; 3], inertia: [moments[0], moments[1], moments[2], 0.0, 0.0, 0.0] };
    let solid = part.placed(&Pose { position: [0.0; 3], rotation: turn });
    robot.add_segment(Segment::new("body", None, Joint::floating(Pose::identity()), solid));
    robot
}

/// The rounding of an inertia in the world's axes is a share of its largest moment. Smaller moments are refused.
#[test]
fn a_body_too_thin_for_the_precision_is_refused() {
    for turn in [[0.0, 0.0, 0.0, 1.0], [0.5, 0.5, 0.5, 0.5], [0.1, 0.7, -0.5, 0.5]] {
        let n = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
        let turn = turn.map(|x| x / n);
        let thin = spinning([1e-7, 1.0, 1.0], turn);
        let error = Model::<f32>::new(&thin, &Options::default()).unwrap_err();
        let ModelError::Thin { segment, ratio, least } = &error else { panic!("{error}") };
        assert!(segment == "body" && (ratio / 1e-7 - 1.0).abs() < 1e-3, "{error}");
        assert_eq!(*least, 8.0 * f64::from(f32::EPSILON));
        assert!(error.to_string().contains("1.0e-7 of the largest, at least 9.5e-7"), "{error}");
        assert!(Model::<f64>::new(&thin, &Options::default()).is_ok());
        // The least ratio holds, in every orientation of the spin.
        let least = spinning([least * 1.001, 1.0, 1.0], turn);
        let mut world = World::new(Model::<f32>::new(&least, &Options::default()).unwrap());
        let axis = Pose { position: [0.0; 3], rotation: turn }.rotate([1.0, 0.0, 0.0]);
        for start in 0..20 {
            let angle = 0.3 * start as f32;
            let (sine, cosine) = sin_cos(angle);
            let start = Pose { position: [0.0; 3], rotation: [0.0, sine, 0.6 * cosine, 0.8 * cosine] };
            let spin = start.rotate(axis.map(|x| x as f32));
            world.place_body(BodyId(0), start, Twist { linear: [0.0; 3], angular: spin });
            world.finish_placement();
            (0..500).for_each(|_| world.step());
            let after = world.velocity(BodyId(0)).angular;
            assert!(after.iter().all(|x| x.is_finite()), "{angle}: {after:?}");
        }
    }
    let mut wheel = spinning([1e-7, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0]);
    wheel.segments[0].joint = Joint::revolute("hinge", [1.0, 0.0, 0.0], Pose::identity(), [-1.0, 1.0]);
    let error = Model::<f32>::new(&wheel, &Options::default()).unwrap_err();
    assert!(matches!(error, ModelError::Thin { .. }), "{error}");
    wheel.segments[0].joint.armature = 1e-3;
    assert!(Model::<f32>::new(&wheel, &Options::default()).is_ok());
}

/// The gyroscopic term is explicit, so a body that spins about its middle axis gains energy. docs/agreement.md has the
/// figures. MuJoCo 4.0.0 with its Euler integrator gains 0.0087 and 0.0356 from the same start.
#[test]
fn a_body_spinning_about_its_middle_axis_gains_the_documented_energy() {
    for (step, documented) in [(0.0025, 0.0087), (0.01, 0.0356)] {
        let mut world = world(&spinning([1.0, 2.0, 3.0], [0.0, 0.0, 0.0, 1.0]), step, 0.0);
        let twist = Twist { linear: [0.0; 3], angular: [0.01, 1.0, 0.01] };
        world.place_body(BodyId(0), Pose::identity(), twist);
        world.finish_placement();
        let before = world.energy()[0];
        (0..(60.0 / step) as usize).for_each(|_| world.step());
        let gain = world.energy()[0] / before - 1.0;
        assert!((gain / documented - 1.0).abs() < 0.05, "{step} s: {gain}");
    }
}
