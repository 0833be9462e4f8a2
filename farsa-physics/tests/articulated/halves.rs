//! Dynamics steps that are made in halves, because a link is fast.

use crate::common::{Babble, commands, drive, first_point, model, points_of, scene, start, stream};
use farsa_body::Pose;
use farsa_body::ports::{Arrange, JointId, World as _};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, Surface};
use farsa_body::robots::ArmAndHand;
use farsa_physics::articulated::{Options, World};

/// The state with all impulses of contacts multiplied by a factor.
fn with_impulses_of(robot: &Robot, world: &World<f32>, factor: f32) -> Vec<f32> {
    let mut state = world.state().to_vec();
    let first = first_point(robot, world.model());
    let points: usize = (0..robot.pairs.len()).map(|pair| points_of(robot, pair)).sum();
    for words in state[first..first + 8 * points].chunks_exact_mut(8) {
        words[..4].iter_mut().for_each(|x| *x *= factor);
    }
    state[first + 8 * points..].iter_mut().for_each(|x| *x *= factor);
    state
}

#[test]
fn a_step_in_halves_has_the_bits_of_two_steps() {
    let robot = scene();
    let groups = ArmAndHand::default().servo_groups();
    let [whole, short] = [(2, Some(1e-9)), (4, None)]
        .map(|(substeps, path_error)| model(&robot, Options { substeps, path_error, ..Options::default() }));
    for episode in 0..6 {
        let (mut ours, mut theirs) = (World::<f32>::new(whole.clone()), World::<f32>::new(short.clone()));
        start(&robot, &mut theirs, &mut stream(41, episode), episode as usize);
        let mut babble = Babble::new(42, episode);
        for t in 0..300 {
            if t == 20 {
                // All joints move from here on.
                ours.state_mut().copy_from_slice(&with_impulses_of(&robot, &theirs, 2.0));
                ours.finish_placement();
            }
            let commands = commands(&groups, babble.next());
            drive(&mut theirs, &commands);
            theirs.step();
            if t >= 20 {
                drive(&mut ours, &commands);
                ours.step();
                let expected = with_impulses_of(&robot, &theirs, 2.0);
                let differs = ours.state().iter().zip(&expected).position(|(a, b)| a.to_bits() != b.to_bits());
                assert_eq!(differs, None, "word in episode {episode} after step {t}");
            }
        }
    }
}

/// A rod of 1 m that turns about the vertical above a plane.
fn rod() -> Robot {
    let mut robot = Robot::new("rod");
    let ground = robot.add_collider(Collider::new("ground", None, Shape::Plane, Pose::identity()));
    let joint = Joint::revolute("pivot", [0.0, 0.0, 1.0], Pose::at([0.0, 0.0, 1.0]), [-9.0, 9.0]);
    let mass = MassProperties { centre: [0.5, 0.0, 0.0], ..MassProperties::sphere(1.0, 0.1) };
    let body = robot.add_segment(Segment::new("rod", None, joint, mass));
    let ball = Shape::Sphere { radius: 0.1 };
    let collider = robot.add_collider(Collider::new("ball", Some(body), ball, Pose::at([0.5, 0.0, 0.0])));
    robot
        .add_pair([collider, ground], Surface { friction: 0.5, rolling_friction: 0.0, stiffness: 1e4, damping: 100.0 });
    robot
}

#[test]
fn halves_begin_where_the_path_leaves_its_tangent_by_the_error() {
    // The center at r = 0.5 m leaves the tangent of a step by r (h w)^2 / 2, 0.1 mm in 10 ms at 2 rad/s. Friction of the
    // joint slows the rod alike in halves and whole steps only to first order.
    let mut robot = rod();
    robot.segments[0].joint.damping = 0.3;
    let after = |speed: f32, path_error: Option<f64>| {
        let options = Options { substeps: 1, path_error, ..Options::default() };
        let mut world = World::<f64>::new(model(&robot, options));
        world.place_joint(JointId(0), 0.0, speed);
        world.finish_placement();
        world.step();
        world.positions()[0]
    };
    let [never, always] = [None, Some(1e-9)];
    for (speed, as_if) in [(1.99, never), (2.01, always), (-2.01, always)] {
        assert_eq!(after(speed, Some(1e-4)), after(speed, as_if), "{speed} rad/s");
    }
    assert_ne!(after(2.01, never), after(2.01, always));
}
