//! The bits themselves. A change here is a change of every recorded run: CHANGELOG.md lists it under *Values*.
#![cfg(feature = "alloc")]
#![allow(missing_docs)]

use farsa_body::actuators::{Law, MusclePair, Servo};
use farsa_body::kinematics::{Goal, InverseKinematics, KinematicTree, Orientation};
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_num::{Digest, Real};

fn efforts<R: Real>(digest: &mut Digest) {
    let range = [R::from_f64(-1.9), R::from_f64(1.6)];
    let laws = [
        Law::MusclePair(MusclePair::thesis(R::from_f64(3000.0), R::from_f64(0.01), range)),
        Law::MusclePair(MusclePair::original(R::from_f64(300.0), R::from_f64(0.01), range, R::from_f64(0.7))),
        Law::Servo(Servo { stiffness: R::from_f64(1.0), damping: R::from_f64(0.04), limit: R::from_f64(0.3) }),
    ];
    for law in laws {
        for i in 0..2000 {
            let x = f64::from(i) * 0.001;
            let of = |x: f64| R::from_f64(x);
            let effort = law.effort(of(2.0 * x - 2.0), of(3.0 - 4.0 * x), [of(0.5 * x), of(1.0 - 0.3 * x)]);
            for part in [effort.torque, effort.stiffness, effort.damping] {
                digest.add_f64(part.to_f64());
            }
        }
    }
}

#[test]
fn actuators_keep_their_bits() {
    let mut digest = Digest::new();
    efforts::<f32>(&mut digest);
    efforts::<f64>(&mut digest);
    assert_eq!(digest.finish(), 0x99d4_ed4e_2832_80b2, "{:#018x}", digest.finish());
}

#[test]
fn descriptions_and_kinematics_keep_their_bits() {
    let arm = ArmAndHand::default();
    let robot = Tabletop::default().scene(&arm).expect("a valid scene");
    let tree = KinematicTree::new(&robot).expect("a valid scene");
    let mut digest = Digest::new();
    for segment in &robot.segments {
        digest.add_f64s(&segment.inertia);
        digest.add_f64s(&segment.centre);
        digest.add_f64s(&segment.joint.range);
        digest.add_f64(segment.joint.damping);
    }
    for collider in &robot.colliders {
        digest.add_f64s(&collider.placement.rotation);
        digest.add_f64s(&collider.placement.position);
    }
    let goal = Goal {
        body: ArmAndHand::PALM,
        point: arm.palm_centre,
        position: [0.18, -0.26, 0.075],
        orientation: Orientation::Direction { own: ArmAndHand::PALM_NORMAL, wanted: [0.0, 0.0, -1.0] },
    };
    let found = InverseKinematics::default().solve(&tree, &goal, &tree.zero()).expect("within reach");
    digest.add_f64s(&found.joints);
    let poses = tree.poses(&found.joints);
    for pose in &poses {
        digest.add_f64s(&pose.position);
        digest.add_f64s(&pose.rotation);
    }
    digest.add_f64s(&tree.gravity_torques(&poses, [0.0, 0.0, -9.81]));
    assert_eq!(digest.finish(), 0xbf1e_9b79_8213_9729, "{:#018x}", digest.finish());
}
