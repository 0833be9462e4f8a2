//! The bits themselves. A change here is a change of every recorded run: CHANGELOG.md lists it under *Values*.
#![cfg(feature = "alloc")]
#![allow(missing_docs, clippy::unwrap_used)]

mod common;

use common::{Babble, CLOSED, Wrist, close, commands, drive, hand_and_sphere, model, put_in_the_palm, scene};
use farsa_body::actuators::Law;
use farsa_body::ports::{Arrange, BodyId, Contacts, Kinematics, PairId, Rays, World as _};
use farsa_body::robot::{Robot, Surface};
use farsa_body::robots::ArmAndHand;
use farsa_num::{Digest, Domain, Stream};
use farsa_physics::articulated::{Options, Precision, World};

/// Control steps between two states that enter a digest.
const EVERY: usize = 5;

fn add<R: Precision>(digest: &mut Digest, world: &World<R>) {
    for word in world.state() {
        digest.add_f64(word.to_f64());
    }
}

/// Adds the readings of the ports: poses and velocities of the bodies, contacts of the pairs, a fan of rays.
fn add_ports<R: Precision>(digest: &mut Digest, world: &World<R>, robot: &Robot) {
    for body in 0..robot.segments.len() {
        let (pose, twist) = (world.pose(BodyId(body as u16)), world.velocity(BodyId(body as u16)));
        digest.add_f32s(&pose.position);
        digest.add_f32s(&pose.rotation);
        digest.add_f32s(&twist.linear);
        digest.add_f32s(&twist.angular);
    }
    for pair in 0..world.pairs() {
        let contact = world.pair_contact(PairId(pair as u16));
        digest.add_f32s(&contact.force);
        digest.add_f32s(&contact.point);
        digest.add_f32s(&[contact.normal_force, contact.depth]);
    }
    for k in 0..64 {
        let (x, y) = ((k % 8) as f32 * 0.1 - 0.4, (k / 8) as f32 * 0.1 - 0.4);
        let length = (x * x + y * y + 1.0).sqrt();
        if let Some(hit) = world.cast([0.1, -0.1, 0.6], [x, y, -1.0].map(|c| c / length), 2.0) {
            digest.add_f32(hit.distance);
            digest.add_f32s(&hit.normal);
        }
    }
}

/// Pairs that touch, and the sum of their normal forces [N].
fn load<R: Precision>(world: &World<R>) -> (usize, f64) {
    let pairs = (0..world.pairs()).map(|p| world.pair_contact(PairId(p as u16)));
    pairs.filter(|c| c.points > 0).fold((0, 0.0), |(n, sum), c| (n + 1, sum + f64::from(c.normal_force)))
}

/// Arm, hand, sphere and table under random commands, from each of the four starts and in each manner.
fn babbling<R: Precision>() -> u64 {
    let robot = scene();
    // As in `reach-grasp-lift`: steps that are halved where links are fast.
    let options = Options { substeps: 2, path_error: Some(1e-4), ..Options::default() };
    let mut world = World::new(model::<R>(&robot, options));
    let groups = ArmAndHand::default().servo_groups();
    let (mut digest, mut touching) = (Digest::new(), 0);
    for episode in 0..2 * Babble::MANNERS {
        common::start(&robot, &mut world, &mut Stream::new(2010, Domain::Start, episode, 0, 0), episode as usize);
        let mut babble = Babble::new(2010, episode);
        for t in 0..300 {
            drive(&mut world, &commands(&groups, babble.next()));
            world.step();
            touching += usize::from(load(&world).0 > 1);
            if t % EVERY == 0 {
                add(&mut digest, &world);
            }
        }
        add_ports(&mut digest, &world, &robot);
    }
    assert!(touching > 200, "more than the sphere on the table: {touching} steps");
    digest.finish()
}

/// The hand closes on the sphere, holds it when gravity sets in, and squeezes it at random. With rolling friction.
fn squeezing<R: Precision>() -> u64 {
    let arm = ArmAndHand::default();
    let surface = Surface { rolling_friction: 0.002, ..arm.surface };
    let mut digest = Digest::new();
    for wrist in [Wrist::Fixed, Wrist::Limp] {
        let robot = hand_and_sphere(wrist, surface, Some(Law::Servo(arm.servo)));
        let mut world = World::new(model::<R>(&robot, Options { gravity: [0.0; 3], ..Options::default() }));
        put_in_the_palm(&mut world, 0.0005);
        world.finish_placement();
        close(&mut world, &CLOSED);
        for _ in 0..60 {
            world.step();
        }
        let mut heavy = World::new(model::<R>(&robot, Options::default()));
        heavy.state_mut().copy_from_slice(world.state());
        heavy.finish_placement();
        let mut stream = common::stream(2010, 1);
        let (mut least, mut most) = (usize::MAX, 0.0_f64);
        for t in 0..300 {
            if t % 20 == 0 {
                close(&mut heavy, &CLOSED.map(|x| (x + 0.3 * (stream.uniform() - 0.2)).clamp(0.0, 1.0)));
            }
            heavy.step();
            let (pairs, force) = load(&heavy);
            (least, most) = (least.min(pairs), most.max(force));
            if t % EVERY == 0 {
                add(&mut digest, &heavy);
            }
        }
        add_ports(&mut digest, &heavy, &robot);
        assert!(least >= 4 && most > 50.0, "at least {least} pairs, at most {most:.1} N");
    }
    digest.finish()
}

#[test]
fn random_commands_keep_their_bits() {
    let digests = [babbling::<f32>(), babbling::<f64>()];
    assert_eq!(digests, [0x5253_2ec6_a526_8d8f, 0xbbff_1840_904f_f61f], "{digests:#018x?}");
}

#[test]
fn contacts_under_load_keep_their_bits() {
    let digests = [squeezing::<f32>(), squeezing::<f64>()];
    assert_eq!(digests, [0x091f_ae5a_3dde_ccff, 0xbb18_0274_4926_2cc4], "{digests:#018x?}");
}
