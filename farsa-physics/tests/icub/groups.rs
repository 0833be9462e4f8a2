//! Pairs in groups move the robot as the same pairs alone do.

use farsa_body::ports::{Contacts as _, Joints as _, PairId, World as _};
use farsa_body::robot::Robot;
use farsa_body::robots::Icub;
use farsa_physics::articulated::{Options, World};

use crate::common::model;
use crate::random::{Babble, SPEED, start};

const EPISODES: u32 = 24;
const STEPS: usize = 150;

#[test]
fn groups_change_no_motion() {
    let icub = Icub::default();
    let robot = icub.robot().unwrap();
    let mut alone = robot.clone();
    alone.pairs.iter_mut().for_each(|pair| pair.group = None);
    let grouped = robot.pairs.iter().filter(|pair| pair.group.is_some()).count();
    // Limbs, then fingers with what is not of their hand nor arm, then fingers of both hands.
    assert_eq!(grouped, 2 * 7 + 8 + 2 * 15 * 6 + 15 * 15);
    let worlds = |robot: &Robot| World::new(model::<f32>(robot, Options::default()));
    let (mut here, mut there) = (worlds(&robot), worlds(&alone));
    let [mut touching, mut far, mut near] = [0; 3];
    for episode in 0..EPISODES {
        start(&icub, &robot, &mut here, episode, 0.1);
        start(&icub, &alone, &mut there, episode, 0.1);
        let mut babbles = [Babble::new(&robot, 5, episode, SPEED), Babble::new(&alone, 5, episode, SPEED)];
        for step in 0..STEPS {
            babbles[0].drive(&mut here);
            babbles[1].drive(&mut there);
            here.step();
            there.step();
            for joint in robot.joints() {
                let speeds = [here.speed(joint), there.speed(joint)].map(f32::to_bits);
                assert!(speeds[0] == speeds[1], "episode {episode} step {step}: {joint:?}");
            }
            for (p, pair) in robot.pairs.iter().enumerate() {
                let [a, b] = [here.pair_contact(PairId(p as u16)), there.pair_contact(PairId(p as u16))];
                assert_eq!((a.force, a.points), (b.force, b.points));
                if a.depth == f32::NEG_INFINITY {
                    // No pair that is far in a group is near.
                    assert!(pair.group.is_some() && b.depth < 0.0, "{pair:?} {b:?}");
                    far += 1;
                } else {
                    assert_eq!(a.depth, b.depth);
                    near += usize::from(pair.group.is_some());
                }
                touching += usize::from(pair.group.is_some() && a.points > 0);
            }
        }
    }
    println!("of groups {touching} pairs touched, {near} were looked at, {far} not");
    assert!(touching > 100 && near > 10 * touching && far > near);
}
