//! The world of rapier keeps the promises of `farsa_body::testing`.

use crate::channels::channels_conform;
use crate::common::{CLOSED, POSES, WRIST, Wrist, hand_and_sphere, scene};
use farsa_body::actuators::Law;
use farsa_body::ports::{Arrange, BodyId, JointId, World as _};
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_body::testing::{Probe, check_arrange, check_external_forces, check_rays, check_vision, check_world};
use farsa_body::{Pose, Twist};
use farsa_physics::rapier::{Options, World};

#[test]
fn the_whole_scene_conforms() {
    let robot = scene();
    let fresh = World::new(&robot, &Options::default()).unwrap();
    let probe = Probe { steps: 64, ..Probe::for_robot(&robot) };
    for pose in POSES {
        let make = || {
            let mut world = fresh.clone();
            for (j, degrees) in pose.into_iter().enumerate() {
                world.place_joint(JointId(j as u16), degrees.to_radians() as f32, 0.0);
            }
            world.finish_placement();
            world
        };
        assert_eq!(check_world(make, &probe), Ok(()));
        assert_eq!(check_rays(&make(), &probe.bodies, &[[0.1, -0.3, 0.3], [0.3, 0.0, 0.1]], 1.0), Ok(()));
        assert_eq!(check_vision(&make(), &probe.bodies, &[[0.1, -0.3, 0.3], [0.3, 0.0, 0.1]], 1.0), Ok(()));
    }
    assert_eq!(check_arrange(|| fresh.clone(), &probe), Ok(()));
    assert_eq!(check_external_forces(|| fresh.clone(), &probe, &[Tabletop::SPHERE], BodyId(9000)), Ok(()));
}

#[test]
fn a_hand_around_a_sphere_conforms() {
    let arm = ArmAndHand::default();
    let robot = hand_and_sphere(Wrist::Fixed, arm.surface, Some(Law::Servo(arm.servo)));
    let fresh = World::new(&robot, &Options::default()).unwrap();
    let make = || {
        let mut world = fresh.clone();
        let at = [WRIST[0] + 0.0625 + 0.015, WRIST[1], WRIST[2] - 0.010 - 0.025 - 0.001];
        world.place_body(Tabletop::SPHERE, Pose::at(at.map(|x| x as f32)), Twist::default());
        for (group, y) in ArmAndHand::default().servo_groups().iter().zip(CLOSED) {
            for s in group {
                world.place_joint(JointId(s.servo.0), s.from + (s.to - s.from) * 0.5 * y, 0.0);
            }
        }
        world.finish_placement();
        world
    };
    assert_eq!(check_world(make, &Probe { steps: 96, ..Probe::for_robot(&robot) }), Ok(()));
}

/// The effect of a motor appears in the bytes of a snapshot, packed into integers, so whether commands are finite does
/// not.
#[test]
fn sensors_and_motors_conform() {
    let robot = scene();
    let mut resting = World::new(&robot, &Options::default()).unwrap();
    for (j, degrees) in POSES[0].into_iter().enumerate() {
        resting.place_joint(JointId(j as u16), degrees.to_radians() as f32, 0.0);
    }
    resting.finish_placement();
    for _ in 0..10 {
        resting.step();
    }
    channels_conform(&robot, || resting.clone());
}
