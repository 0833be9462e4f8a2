//! Forces from outside, against closed forms and against gravity.

use crate::common::{POSES, ghost, model, scene, stream, world};
use farsa_body::ports::{Arrange, BodyId, ExternalForces as _, JointId, Kinematics as _, World as _};
use farsa_body::robot::{Joint, MassProperties, Robot, Segment};
use farsa_body::robots::Tabletop;
use farsa_body::testing::{Probe, check_external_forces};
use farsa_body::{Pose, Twist};
use farsa_physics::articulated::{Options, World};

/// The dynamics step [s].
const STEP: f64 = 1e-3;

#[test]
fn a_pushed_world_keeps_the_kit_s_promises() {
    let robot = scene();
    let model = model::<f32>(&robot, Options::default());
    let probe = Probe::for_robot(&robot);
    // The sphere, and segments of the arm and the hand.
    let pushed = [Tabletop::SPHERE, BodyId(3), BodyId(6), BodyId(14)];
    assert_eq!(check_external_forces(|| World::new(model.clone()), &probe, &pushed, BodyId(9000)), Ok(()));
}

/// A force off the center of mass of a free bar: momentum and angular momentum follow Newton and Euler.
#[test]
fn a_free_body_takes_force_and_moment() {
    let mut bar = Robot::new("bar");
    let half = [0.2, 0.02, 0.01];
    bar.add_segment(Segment::new("bar", None, Joint::floating(Pose::identity()), MassProperties::cuboid(0.5, half)));
    let mut world = world(&bar, STEP, 0.0);
    world.place_body(BodyId(0), Pose::at([1.0, 2.0, 3.0]), Twist::default());
    world.finish_placement();
    let (point, force) = ([1.2, 2.02, 3.0], [0.0, 0.5, 0.25]);
    world.apply_force(BodyId(0), point, force);
    world.step();
    let twist = world.velocity_of(BodyId(0));
    // Moment r x F with r = (0.2, 0.02, 0). Inertias m (a^2 + b^2) / 3 about the three axes.
    let force = force.map(f64::from);
    let moment = [0.02 * force[2], -0.2 * force[2], 0.2 * force[1]];
    for k in 0..3 {
        let [a, b] = [half[(k + 1) % 3], half[(k + 2) % 3]];
        let inertia = 0.5 * (a * a + b * b) / 3.0;
        let [linear, angular] = [force[k] / 0.5 * STEP, moment[k] / inertia * STEP];
        assert!((twist.linear[k] - linear).abs() < 1e-9, "{k}: {} and {linear}", twist.linear[k]);
        assert!((twist.angular[k] - angular).abs() < 1e-6 * (1.0 + angular.abs()), "{k}: {twist:?}, {angular}");
    }
    // It is gone.
    let before = world.momentum();
    world.step();
    let after = world.momentum();
    assert!(before.iter().zip(after).all(|(a, b)| (a - b).abs() < 1e-15), "{before:?} {after:?}");
}

/// Every link pushed down at its center of mass by its weight moves as under that much more gravity.
#[test]
fn weights_as_forces_are_gravity() {
    let robot = ghost(&scene());
    let mut starts = stream(21, 0);
    for pose in POSES {
        let [mut heavy, mut pushed] = [9.81 + 2.5, 9.81].map(|gravity| world(&robot, STEP, gravity));
        for (j, segment) in robot.segments.iter().enumerate().take(27) {
            let [low, high] = segment.joint.range;
            let at = pose.get(j).map_or_else(|| low + (high - low) * f64::from(starts.uniform()), |x| x.to_radians());
            for world in [&mut heavy, &mut pushed] {
                world.place_joint(JointId(j as u16), at as f32, 0.0);
            }
        }
        for world in [&mut heavy, &mut pushed] {
            world.finish_placement();
        }
        let start = pushed.velocities().to_vec();
        for (i, segment) in robot.segments.iter().enumerate() {
            let body = BodyId(i as u16);
            let centre = pushed.pose(body).transform(segment.centre.map(|x| x as f32));
            pushed.apply_force(body, centre, [0.0, 0.0, (-2.5 * segment.mass) as f32]);
        }
        for world in [&mut heavy, &mut pushed] {
            world.step();
        }
        let largest = heavy.velocities().iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        assert!(start.iter().all(|v| *v == 0.0) && largest > 0.01, "{largest}");
        // Forces and places are single numbers, and velocities change the bias of the step by their squares.
        for (at, (a, b)) in heavy.velocities().iter().zip(pushed.velocities()).enumerate() {
            assert!((a - b).abs() < 2e-4 * largest, "velocity {at}: {a} and {b} of {largest}");
        }
    }
}
