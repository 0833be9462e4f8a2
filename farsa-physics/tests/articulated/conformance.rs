//! The articulated world keeps the promises of `farsa_body::testing`.

use crate::channels::channels_conform;
use crate::common::{CLOSED, POSES, Wrist, hand_and_sphere, model, pose_hand, put_in_the_palm, scene, start, stream};
use farsa_body::actuators::Law;
use farsa_body::ports::{Arrange, JointId, World as _};
use farsa_body::robots::ArmAndHand;
use farsa_body::testing::{Probe, check_arrange, check_rays, check_world};
use farsa_physics::articulated::{Model, Options, Precision, World};

#[test]
fn the_whole_scene_conforms() {
    let robot = scene();
    let model = model::<f32>(&robot, Options::default());
    let probe = Probe::for_robot(&robot);
    for pose in POSES {
        let make = || {
            let mut world = World::new(model.clone());
            for (j, degrees) in pose.into_iter().enumerate() {
                world.place_joint(JointId(j as u16), degrees.to_radians() as f32, 0.0);
            }
            world.finish_placement();
            world
        };
        assert_eq!(check_world(make, &probe), Ok(()));
        assert_eq!(check_rays(&make(), &probe.bodies, &[[0.1, -0.3, 0.3], [0.3, 0.0, 0.1]], 1.0), Ok(()));
    }
    assert_eq!(check_arrange(|| World::new(model.clone()), &probe), Ok(()));
}

#[test]
fn a_hand_around_a_sphere_conforms() {
    let arm = ArmAndHand::default();
    let robot = hand_and_sphere(Wrist::Fixed, arm.surface, Some(Law::Servo(arm.servo)));
    let model = model::<f32>(&robot, Options::default());
    let make = || {
        let mut world = World::new(model.clone());
        put_in_the_palm(&mut world, 0.001);
        pose_hand(&mut world, &CLOSED.map(|x| 0.5 * x));
        world.finish_placement();
        world
    };
    assert_eq!(check_world(make, &Probe::for_robot(&robot)), Ok(()));
}

#[test]
fn it_conforms_in_double_precision_but_for_its_snapshot() {
    // A snapshot is in single precision, so a world in f64 continues from the rounded state. The other promises hold.
    let robot = scene();
    let model = model::<f64>(&robot, Options::default());
    assert_eq!(check_arrange(|| World::new(model.clone()), &Probe::for_robot(&robot)), Ok(()));
}

/// The arm at its first start, a while after the sphere was put on the table.
fn resting<R: Precision>(model: &Model<R>) -> World<R> {
    let mut world = World::new(model.clone());
    start(&scene(), &mut world, &mut stream(1, 0), 0);
    for _ in 0..10 {
        world.step();
    }
    world
}

#[test]
fn sensors_and_motors_conform_in_both_precisions() {
    let robot = scene();
    let (single, double) = (model::<f32>(&robot, Options::default()), model::<f64>(&robot, Options::default()));
    channels_conform(&robot, || resting(&single));
    channels_conform(&robot, || resting(&double));
}
