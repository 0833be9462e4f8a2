//! Energy and momentum of free motion: the errors of an integrator of first order, and no others.

use crate::common::world;
use farsa_body::ports::{Arrange, BodyId, JointId, World as _};
use farsa_body::robot::{Joint, MassProperties, Robot, Segment};
use farsa_body::{Pose, Twist};
use farsa_physics::articulated::World;

const ENDLESS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// A chain of rods that hang down, each 0.3 m long and 0.2 kg, on horizontal axes.
fn pendulum(rods: usize) -> Robot {
    let mut robot = Robot::new("pendulum");
    let mut parent = None;
    for i in 0..rods {
        let at = Pose::at([0.0, 0.0, if i == 0 { 1.0 } else { -0.3 }]);
        let joint = Joint::revolute(&format!("J{i}"), [0.0, 1.0, 0.0], at, ENDLESS);
        let i1 = 0.2 * 0.09 / 12.0;
        let rod = MassProperties { mass: 0.2, centre: [0.0, 0.0, -0.15], inertia: [i1, i1, 1e-5, 0.0, 0.0, 0.0] };
        parent = Some(robot.add_segment(Segment::new(&format!("rod{i}"), parent, joint, rod)));
    }
    robot
}

/// The largest |E(t) - E(0)| over 10 s [J].
fn drift(robot: &Robot, angles: &[f32], h: f64) -> f64 {
    let mut w = world(robot, h, 9.81);
    for (j, q) in angles.iter().enumerate() {
        w.place_joint(JointId(j as u16), *q, 0.0);
    }
    w.finish_placement();
    let total = |e: [f64; 2]| e[0] + e[1];
    let start = total(w.energy());
    let mut worst = 0.0_f64;
    for _ in 0..(10.0 / h).round() as usize {
        w.step();
        worst = worst.max((total(w.energy()) - start).abs());
    }
    worst
}

#[test]
fn halving_the_step_halves_the_drift_of_energy() {
    for (name, rods, angles) in [
        ("pendulum, 29 deg", 1, &[0.5_f32][..]),
        ("pendulum, 115 deg", 1, &[2.0][..]),
        ("double pendulum, 20 deg", 2, &[0.35, 0.0][..]),
        ("double pendulum, 8 and -12 deg", 2, &[0.14, -0.21][..]),
    ] {
        let robot = pendulum(rods);
        let drifts = [4e-3, 2e-3, 1e-3, 5e-4].map(|h| drift(&robot, angles, h));
        let ratios = [0, 1, 2].map(|i: usize| drifts[i] / drifts[i + 1]);
        println!("{name}: drift {drifts:.6?} J at 4, 2, 1, 0.5 ms; ratios {ratios:.3?}");
        // 4 ms is for the table only.
        assert!(ratios[1..].iter().all(|r| (1.8..=2.2).contains(r)), "{name}: {ratios:?}");
    }
}

#[test]
fn efforts_against_gravity_are_the_slope_of_the_potential_energy() {
    let mut w = world(&pendulum(3), 1e-3, 9.81);
    let (angles, speeds, h) = ([0.7, -1.9, 2.6], [3.0, -5.0, 8.0], 1e-5);
    let place = |w: &mut World<f64>, angles: [f64; 3]| {
        w.state_mut()[..3].copy_from_slice(&angles);
        w.state_mut()[3..6].copy_from_slice(&speeds);
        w.finish_placement();
    };
    let slope = |w: &mut World<f64>, joint: usize| {
        let [above, below] = [h, -h].map(|by| {
            let mut moved = angles;
            moved[joint] += by;
            place(w, moved);
            w.energy()[1]
        });
        (above - below) / (2.0 * h)
    };
    let slopes = [0, 1, 2].map(|joint| slope(&mut w, joint));
    place(&mut w, angles);
    let before = (w.state().to_vec(), w.energy(), w.momentum());
    let mut efforts = [f64::NAN; 3];
    w.gravity_efforts(&mut efforts);
    // Speeds have no part in it, and are as before.
    for (effort, slope) in efforts.iter().zip(slopes) {
        assert!((effort - slope).abs() < 1e-8 && slope.abs() > 0.05, "{efforts:?} and {slopes:?} N m");
    }
    assert_eq!((w.state().to_vec(), w.energy(), w.momentum()), before);
}

#[test]
fn a_free_body_keeps_its_momentum() {
    let inertia = [2e-4, 5e-4, 6e-4, 3e-5, -2e-5, 1e-5];
    let body = MassProperties { mass: 0.4, centre: [0.02, -0.01, 0.03], inertia };
    let mut robot = Robot::new("free");
    robot.add_segment(Segment::new("body", None, Joint::floating(Pose::identity()), body));
    // Angular momentum about the center of mass [N m s], from the pose and the state's own angular velocity.
    let angular = |w: &World<f64>| {
        let pose = w.pose_of(BodyId(0));
        let v = w.velocities();
        let l = pose.rotate_back([v[0], v[1], v[2]]);
        let [xx, yy, zz, xy, xz, yz] = inertia;
        pose.rotate([
            xx * l[0] + xy * l[1] + xz * l[2],
            xy * l[0] + yy * l[1] + yz * l[2],
            xz * l[0] + yz * l[1] + zz * l[2],
        ])
    };
    let distance = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt();
    let run = |h: f64| {
        let mut w = world(&robot, h, 0.0);
        let twist = Twist { linear: [0.3, -0.2, 0.5], angular: [4.0, 7.0, -3.0] };
        w.place_body(BodyId(0), Pose::at([0.1, 0.2, 0.3]), twist);
        w.finish_placement();
        let (p, l, e) = (w.momentum(), angular(&w), w.energy()[0]);
        let (mut linear, mut turning, mut energy) = (0.0_f64, 0.0_f64, 0.0_f64);
        for _ in 0..(2.0 / h).round() as usize {
            w.step();
            linear = linear.max(distance(w.momentum(), p));
            turning = turning.max(distance(angular(&w), l));
            energy = energy.max((w.energy()[0] - e).abs());
        }
        (linear / distance(p, [0.0; 3]), turning / distance(l, [0.0; 3]), energy / e)
    };
    let runs = [2e-3, 1e-3, 5e-4, 2.5e-4].map(run);
    for (h, (linear, turning, energy)) in [2e-3, 1e-3, 5e-4, 2.5e-4].into_iter().zip(runs) {
        println!("h {h}: momentum {linear:.1e}, angular momentum {turning:.3e}, energy {energy:.3e}");
        assert!(linear <= 1e-12);
    }
    for pair in runs.windows(2) {
        assert!((1.8..=2.2).contains(&(pair[0].1 / pair[1].1)), "angular momentum: of first order");
    }
}

#[test]
fn a_free_chain_keeps_its_momentum_to_first_order() {
    // A floating body with two arms that swing: the momentum of the whole.
    let mut robot = Robot::new("floating chain");
    let body = robot.add_segment(Segment::new(
        "body",
        None,
        Joint::floating(Pose::identity()),
        MassProperties::sphere(0.3, 0.05),
    ));
    for (i, axis) in [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]].into_iter().enumerate() {
        let at = Pose::at([0.05, 0.03 * i as f64, 0.0]);
        let arm = MassProperties::sphere(0.1, 0.02).placed(&Pose::at([0.1, 0.0, 0.05]));
        robot.add_segment(Segment::new(
            &format!("arm{i}"),
            Some(body),
            Joint::revolute(&format!("J{i}"), axis, at, ENDLESS),
            arm,
        ));
    }
    let run = |h: f64| {
        let mut w = world(&robot, h, 0.0);
        w.place_body(BodyId(0), Pose::identity(), Twist { linear: [0.1, 0.0, -0.2], angular: [0.5, 1.0, -0.5] });
        w.place_joint(JointId(1), 0.3, 4.0);
        w.place_joint(JointId(2), -0.2, -3.0);
        w.finish_placement();
        let p = w.momentum();
        let mut worst = 0.0_f64;
        for _ in 0..(2.0 / h).round() as usize {
            w.step();
            let now = w.momentum();
            worst = worst.max((0..3).map(|k| (now[k] - p[k]).abs()).fold(0.0, f64::max));
        }
        worst / p.iter().fold(0.0_f64, |m, x| m.max(x.abs()))
    };
    let drifts = [2e-3, 1e-3, 5e-4].map(run);
    println!("momentum of a floating chain: {drifts:.5?} of it at 2, 1, 0.5 ms");
    for pair in drifts.windows(2) {
        assert!((1.7..=2.3).contains(&(pair[0] / pair[1])));
    }
}
