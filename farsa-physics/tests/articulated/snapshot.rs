//! A world is its state: a snapshot in the middle of a grasp continues with the same bits, and there is no other
//! memory.

use crate::common::{
    Babble, CLOSED, Wrist, close, commands, drive, hand_and_sphere, model, put_in_the_palm, scene, start, stream,
    touching,
};
use farsa_body::actuators::Law;
use farsa_body::ports::{Arrange, Snapshot, World as _};
use farsa_body::robots::ArmAndHand;
use farsa_physics::articulated::{Model, Options, World};

fn bits(world: &World<f32>) -> Vec<u32> {
    world.state().iter().map(|x| x.to_bits()).collect()
}

/// A hand that has closed on the sphere, from a model with gravity.
fn grasp() -> World<f32> {
    let arm = ArmAndHand::default();
    let robot = hand_and_sphere(Wrist::Fixed, arm.surface, Some(Law::Servo(arm.servo)));
    let options = Options { gravity: [0.0, 0.0, 2.0], ..Options::default() };
    let mut world = World::new(Model::new(&robot, &options).unwrap());
    put_in_the_palm(&mut world, 0.0005);
    world.finish_placement();
    close(&mut world, &CLOSED);
    for _ in 0..60 {
        world.step();
    }
    assert!(touching(&world) >= 4);
    world
}

#[test]
fn a_grasp_restored_goes_on_with_the_same_bits() {
    let mut world = grasp();
    let mut saved = vec![f32::NAN; world.snapshot_len()];
    world.save(&mut saved);
    // Saved in the middle of a squeeze, not at rest.
    let squeeze = CLOSED.map(|x| (x + 0.1).min(1.0));
    let go_on = |world: &mut World<f32>| {
        close(world, &squeeze);
        (0..200)
            .map(|t| {
                if t == 100 {
                    close(world, &[0.3; 9]);
                }
                world.step();
                bits(world)
            })
            .collect::<Vec<_>>()
    };
    let truth = go_on(&mut world);
    world.restore(&saved);
    assert!(go_on(&mut world) == truth, "the same world");
    // Another world of the same model with another past.
    let mut other = World::new(world.model().clone());
    close(&mut other, &[0.9; 9]);
    for _ in 0..37 {
        other.step();
    }
    other.restore(&saved);
    assert!(go_on(&mut other) == truth, "another world");
}

#[test]
fn clear_forgets_everything() {
    let robot = scene();
    let groups = ArmAndHand::default().servo_groups();
    let model = model::<f32>(&robot, Options::default());
    let mut fresh = World::new(model.clone());
    let mut used = World::new(model);
    let mut touched = 0;
    for episode in 0..6 {
        start(&robot, &mut used, &mut stream(9, episode), episode as usize);
        let mut babble = Babble::new(9, episode);
        for _ in 0..200 {
            drive(&mut used, &commands(&groups, babble.next()));
            used.step();
            touched = touched.max(touching(&used));
        }
        used.clear();
        assert_eq!(bits(&used), bits(&fresh), "the state of a new world");
        // And its episode is that of a new world.
        for world in [&mut used, &mut fresh] {
            start(&robot, world, &mut stream(8, episode), episode as usize);
            let mut babble = Babble::new(8, episode);
            for _ in 0..100 {
                drive(world, &commands(&groups, babble.next()));
                world.step();
            }
        }
        assert_eq!(bits(&used), bits(&fresh));
        // A world in NaN is cured, too.
        used.state_mut().fill(f32::NAN);
        used.finish_placement();
        used.step();
        used.clear();
        fresh.clear();
        assert_eq!(bits(&used), bits(&fresh));
        used.step();
        fresh.step();
        assert_eq!(bits(&used), bits(&fresh));
        fresh.clear();
    }
    assert!(touched >= 3, "there was something to forget");
}
